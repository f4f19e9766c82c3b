//! The world file's `[[preference]]`.

use super::polygon::{Ring, simple_polygon};
use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use cplan_geometry::SimplePolygon;
use cplan_model::{Preference, Region};
use cplan_robot::{Diagnostic, Number, Numbers, Spanned, toml_table};

toml_table! {
    /// A region of tip positions or of joint space that field planners prefer or avoid. Where regions overlap, the last
    /// one counts.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "preference", extend("oneOf" = [{ "required": ["configurations"] }, { "required": ["polygon"] }])))]
    pub(super) struct PreferenceTable {
        /// Name in messages and pictures.
        name: Option<String>,
        /// Strength per grid cell. The fields `bvp` and `bvp2` avoid a region if its strength is above 0, and seek it
        /// if its strength is below 0.
        epsilon: Number,
        /// Direction in joint space for the field `local`. Its length does not matter.
        #[cfg_attr(test, schemars(with = "Option<NumberPair>"))]
        direction: Option<Numbers>,
        /// Corners of a region in joint space, rad or m.
        #[cfg_attr(test, schemars(with = "Option<Corners>"))]
        configurations: Option<Ring>,
        /// Corners of a region of tip positions, m.
        #[cfg_attr(test, schemars(with = "Option<Corners>"))]
        polygon: Option<Ring>,
    }
}

/// Largest extent of a region of configurations, in radians or metres. On circles, the region has a copy for each whole turn, so
/// their number must be bounded.
const MAX_REGION_WIDTH: f64 = 100.0;

const CORNER_ORDER_HINT: &str = "list the corners in order round the region, each once";

impl PreferenceTable {
    /// Reads the preference with this index in the world file.
    ///
    /// # Errors
    /// Values that are not finite, a direction of length 0, other than exactly one region, and a region that is not a simple
    /// polygon.
    pub fn read(reader: &Reader, index: usize, table: &Spanned<Self>) -> Result<Preference, Diagnostic> {
        let given = table.get_ref();
        let name = given.name.clone().unwrap_or_else(|| format!("preference {}", index + 1));
        let what = format!("preference \"{name}\"");
        let epsilon = reader.source.finite(&given.epsilon, &format!("{what}, epsilon"))?;
        let direction = given.direction.as_ref().map(|d| direction(reader, d, &what)).transpose()?;
        let region = match (&given.configurations, &given.polygon) {
            (Some(corners), None) => Region::Configurations(configurations(reader, corners, &what)?),
            (None, Some(corners)) => Region::Tip(simple_polygon(reader, corners, &what, CORNER_ORDER_HINT)?),
            (configurations, _) => {
                let found = if configurations.is_some() { "both" } else { "neither" };
                let message = format!("{what} needs either `configurations` or `polygon`, but has {found}");
                let help = "configurations = [[q1, q2], ...] in joint values, or polygon = [[x, y], ...] for the tip";
                return Err(reader.source.diagnostic_at(table.span(), message).help(help));
            }
        };
        Ok(Preference { name, region, epsilon, direction })
    }
}

fn direction(reader: &Reader, numbers: &Numbers, what: &str) -> Result<[f64; 2], Diagnostic> {
    let vector = reader.number_pair(numbers, &format!("{what}, direction"))?;
    let length = vector[0].hypot(vector[1]);
    // The square of a shorter length is subnormal, so the direction would lose digits.
    if length < 1e-150 {
        let diagnostic = reader.source.diagnostic_at(numbers.span(), format!("{what}: the direction is zero"));
        return Err(diagnostic.help("direction = [q1, q2], such as [1, 0]; leave the key out for no direction"));
    }
    Ok(vector.map(|x| x / length))
}

fn configurations(reader: &Reader, corners: &Ring, what: &str) -> Result<SimplePolygon, Diagnostic> {
    let polygon = simple_polygon(reader, corners, what, CORNER_ORDER_HINT)?;
    let is_wide = |k: usize| {
        let values = || polygon.corners().iter().map(|corner| corner[k]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min) > MAX_REGION_WIDTH
    };
    if is_wide(0) || is_wide(1) {
        let message = format!("{what} is too wide (at most {MAX_REGION_WIDTH} in joint values)");
        return Err(reader
            .source
            .diagnostic_at(corners.span(), message)
            .help("write angles in radians; continuous joints repeat after a whole turn"));
    }
    Ok(polygon)
}
