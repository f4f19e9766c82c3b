//! The world file's `[[pallet]]`: places in rows and columns.

use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use cplan_geometry::{Point, Pose};
use cplan_robot::{Diagnostic, Length, Lengths, Spanned, Written, quoted, toml_table};
use std::collections::BTreeMap;

toml_table! {
    /// Places for objects, in rows and columns. They are named "NAME 1,1", "NAME 1,2", and so on: row and column,
    /// counted from 1.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "pallet"))]
    pub(super) struct PalletTable {
        /// Unique name among pallets.
        name: Spanned<String>,
        /// Number of rows.
        #[cfg_attr(test, schemars(range(min = 1)))]
        rows: Spanned<i64>,
        /// Number of places per row.
        #[cfg_attr(test, schemars(range(min = 1)))]
        columns: Spanned<i64>,
        /// Distances between columns, along the pallet's x, and between rows, along its y, m; may be negative.
        #[cfg_attr(test, schemars(with = "LengthPair"))]
        pitch: Lengths,
        /// Position of the place in row 1 and column 1, m.
        #[cfg_attr(test, schemars(with = "LengthPair"))]
        at: Lengths,
        /// Angle of the pallet about its place in row 1 and column 1, rad; by default 0. Objects on the pallet turn
        /// with it.
        angle: Option<Written>,
        /// Height of its places along the plane's normal, m: the bottom of a placed object is at this height. By
        /// default, objects are placed at the height at which they were picked.
        height: Option<Length>,
    }
}

/// Largest number of places of a pallet. No machine has more.
const MAX_PLACES: usize = 10_000;

/// Sums of coordinates are rounded to this number of significant digits of the largest summand. Without rounding errors, places
/// have the decimals that people would write.
const PLACE_DIGITS: i32 = 15;

#[derive(Debug, Clone)]
pub(super) struct Pallet {
    rows: usize,
    columns: usize,
    /// Pose of the place in row 1 and column 1.
    origin: Pose,
    /// Distances between columns and between rows, in metres.
    pitch: [f64; 2],
    /// Height of its places, metres.
    pub height: Option<f64>,
}

impl Pallet {
    pub fn count(&self) -> usize {
        self.rows * self.columns
    }

    /// Iterates over all places, row by row. Each item has the row and the column, as in the place's name, and the pose.
    pub fn places(&self) -> impl Iterator<Item = (String, Pose)> + '_ {
        (0..self.rows).flat_map(move |row| {
            (0..self.columns).map(move |column| {
                let offset = Point::new(column as f64 * self.pitch[0], row as f64 * self.pitch[1]);
                let largest = self.origin.translation.amax().max(offset.amax());
                let at = self.origin.point(offset).map(|x| rounded(x, largest));
                let pose = Pose { translation: at, ..self.origin };
                (format!("{},{}", row + 1, column + 1), pose)
            })
        })
    }
}

/// Rounds off the errors of a sum whose summands are at most `largest`.
fn rounded(sum: f64, largest: f64) -> f64 {
    let before = largest.log10().ceil().clamp(-300.0, 300.0) as i32;
    let decimals = usize::try_from(PLACE_DIGITS - before).unwrap_or(0);
    format!("{sum:.decimals$}").parse().unwrap_or(sum) + 0.0
}

/// All pallets by name.
#[derive(Default)]
pub(super) struct Pallets<'a> {
    by_name: BTreeMap<&'a str, Pallet>,
    /// Positions of places by name, and their heights.
    places: BTreeMap<String, (Point, Option<f64>)>,
}

impl<'a> Pallets<'a> {
    /// Reads all pallets.
    ///
    /// # Errors
    /// Two pallets with the same name, pallets with no or too many places, and places that coincide.
    pub fn read(reader: &Reader, tables: &'a [Spanned<PalletTable>]) -> Result<Self, Diagnostic> {
        let mut pallets = Self::default();
        for table in tables.iter().map(Spanned::get_ref) {
            let name = table.name.get_ref().as_str();
            let pallet = table.pallet(reader)?;
            let at = |pose: Pose| (pose.translation, pallet.height);
            let places = pallet.places().map(|(place, pose)| (format!("{name} {place}"), at(pose)));
            pallets.places.extend(places);
            if pallets.by_name.insert(name, pallet).is_some() {
                let diagnostic =
                    reader.source.diagnostic_at(table.name.span(), format!("a second pallet is named \"{name}\""));
                return Err(diagnostic.help("objects and steps refer to pallets by name: give each a unique name"));
            }
        }
        Ok(pallets)
    }

    /// Returns the pallet with this name.
    ///
    /// # Errors
    /// An unknown name.
    pub fn named(&self, reader: &Reader, name: &Spanned<String>) -> Result<&Pallet, Diagnostic> {
        let wanted = name.get_ref().as_str();
        self.by_name.get(wanted).ok_or_else(|| {
            let diagnostic = reader.source.diagnostic_at(name.span(), format!("there is no pallet \"{wanted}\""));
            diagnostic.help(self.names())
        })
    }

    /// Returns the position of the place with this name, such as `tray 2,3`, and its height in metres.
    ///
    /// # Errors
    /// An unknown name.
    pub fn place(&self, reader: &Reader, name: &Spanned<String>) -> Result<(Point, Option<f64>), Diagnostic> {
        let wanted = name.get_ref().as_str();
        if let Some(place) = self.places.get(wanted) {
            return Ok(*place);
        }
        let of = |name: &str| wanted.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with(' '));
        let help = match self.by_name.iter().find(|(name, _)| of(name)) {
            Some((name, Pallet { rows, columns, .. })) => format!(
                "pallet \"{name}\" has rows 1 to {rows} and columns 1 to {columns}: \"{name} 1,1\" to \"{name} {rows},{columns}\""
            ),
            None => self.names(),
        };
        let message = format!("there is no place \"{wanted}\" on a pallet");
        Err(reader.source.diagnostic_at(name.span(), message).help(help))
    }

    fn names(&self) -> String {
        match self.by_name.is_empty() {
            true => "give the world a [[pallet]] of this name".into(),
            false => format!("the pallets are {}", quoted(self.by_name.keys().copied())),
        }
    }
}

impl PalletTable {
    fn pallet(&self, reader: &Reader) -> Result<Pallet, Diagnostic> {
        let what = format!("pallet \"{}\"", self.name.get_ref());
        let counted = |number: &Spanned<i64>, of: &str| {
            usize::try_from(*number.get_ref()).ok().filter(|count| *count > 0).ok_or_else(|| {
                let message = format!("{what}: {of} must be 1 or more, is {}", number.get_ref());
                reader.source.diagnostic_at(number.span(), message).help("write 1 for a single row or column")
            })
        };
        let (rows, columns) = (counted(&self.rows, "rows")?, counted(&self.columns, "columns")?);
        if rows.saturating_mul(columns) > MAX_PLACES {
            let message = format!("{what} has {} places (at most {MAX_PLACES})", rows.saturating_mul(columns));
            return Err(reader.source.diagnostic_at(self.rows.span(), message).help("give it fewer rows or columns"));
        }
        let pitch = reader.number_pair(&self.pitch, &format!("{what}, pitch"))?;
        for (pitch, count, along) in [(pitch[0], columns, "column"), (pitch[1], rows, "row")] {
            if count > 1 && pitch == 0.0 {
                let message =
                    format!("{what}, pitch: the distance from one {along} to the next is 0, so places would coincide");
                return Err(reader
                    .source
                    .diagnostic_at(self.pitch.span(), message)
                    .help("pitch = [by column, by row], m"));
            }
        }
        let at = reader.point(&self.at, &format!("{what}, at"))?;
        let angle =
            self.angle.as_ref().map(|a| reader.quantity(a, &format!("{what}, angle"))).transpose()?.unwrap_or(0.0);
        let height = self.height.as_ref().map(|h| reader.source.finite(h, &format!("{what}, height"))).transpose()?;
        Ok(Pallet { rows, columns, origin: Pose::new(at, angle), pitch, height })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the last place of a pallet with two rows and two columns.
    fn last(at: [f64; 2], pitch: [f64; 2], angle: f64) -> Point {
        let pallet = Pallet { rows: 2, columns: 2, origin: Pose::new(Point::from(at), angle), pitch, height: None };
        pallet.places().last().unwrap().1.translation
    }

    #[test]
    fn places_are_decimals_that_people_write() {
        let quarter = std::f64::consts::FRAC_PI_2;
        assert_eq!(last([0.1, 0.7], [0.2, 0.1], 0.0), Point::new(0.3, 0.8));
        assert_eq!(last([0.3, -0.3], [0.3, 0.3], quarter), Point::new(0.0, 0.0));
        // The same holds for tiny and huge pallets.
        assert_eq!(last([1.2345678901e-5, 0.0], [1e-6, 0.0], 0.0), Point::new(1.3345678901e-5, 0.0));
        assert_eq!(last([1234.5678901234, 0.0], [0.1, 0.0], 0.0), Point::new(1234.6678901234, 0.0));
    }
}
