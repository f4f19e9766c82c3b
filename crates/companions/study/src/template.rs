//! A text with numbers that differ from layout to layout.

use super::address::{FoundNumber, Step, all_in_urdf, all_in_world, in_urdf, in_world, nearest, steps, written_out};
use cplan_robot::Source;
use std::fmt::Write;
use std::ops::Range;

/// A text with placeholders for the numbers that parameters set.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Template {
    source: Source,
    /// The numbers that parameters set, in the order of the text.
    holes: Vec<Placeholder>,
}

/// A placeholder for a number that is computed from a parameter.
#[derive(Debug, Clone, PartialEq)]
struct Placeholder {
    at: Range<usize>,
    is_whole: bool,
    setting: Setting,
}

/// The parameter that sets a number. The number is `factor * value + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Setting {
    pub parameter: usize,
    pub factor: f64,
    pub offset: f64,
}

/// The file to which an address refers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    World,
    Urdf,
}

impl Place {
    /// Returns the address in this text that is closest to a wrong address.
    pub fn nearest(self, text: &str, address: &str) -> Option<String> {
        let (name, known) = match self {
            Self::World => ("world.", all_in_world(text)),
            Self::Urdf => ("urdf.", all_in_urdf(text)),
        };
        nearest(address.strip_prefix(name)?, known).map(|near| format!("{name}{near}"))
    }
}

/// Parses an address, which begins with `world.` or `urdf.`.
///
/// # Errors
/// The syntax error.
pub(super) fn place(address: &str) -> Result<(Place, Vec<Step>), String> {
    let steps = steps(address)?;
    match steps.split_first() {
        Some((Step::Name(file), rest)) if file == "world" && !rest.is_empty() => Ok((Place::World, rest.to_vec())),
        Some((Step::Name(file), rest)) if file == "urdf" && !rest.is_empty() => Ok((Place::Urdf, rest.to_vec())),
        _ => Err(format!("{address}: an address must begin with world. or urdf.")),
    }
}

impl Template {
    /// Creates the template of a file in which `settings` set numbers.
    ///
    /// # Errors
    /// The index of the first setting whose address leads to no number, or to a number that another setting sets, with
    /// the reason.
    pub fn new(source: Source, file: Place, settings: &[(Vec<Step>, Setting)]) -> Result<Self, (usize, String)> {
        let mut text = source.text().to_owned();
        if file == Place::World {
            settings.iter().for_each(|(steps, _)| text = written_out(&text, steps));
        }
        let find = match file {
            Place::World => in_world,
            Place::Urdf => in_urdf,
        };
        let mut holes = Vec::with_capacity(settings.len());
        for (number, (steps, setting)) in settings.iter().enumerate() {
            let FoundNumber { at, is_whole } = find(&text, steps).map_err(|why| (number, why))?;
            if holes.iter().any(|hole: &Placeholder| hole.at == at) {
                return Err((number, "it is set twice".into()));
            }
            holes.push(Placeholder { at, is_whole, setting: *setting });
        }
        holes.sort_by_key(|hole| hole.at.start);
        let source = source.with_text(text);
        Ok(Self { source, holes })
    }

    /// Returns true if no parameter sets a number in the file.
    pub fn is_fixed(&self) -> bool {
        self.holes.is_empty()
    }

    /// Returns the file, with the defaults that parameters set written out.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Returns the file with the numbers that follow from these values of the parameters.
    pub fn filled(&self, values: &[f64]) -> Source {
        let text = self.source.text();
        let mut filled = String::with_capacity(text.len() + 16 * self.holes.len());
        let mut from = 0;
        for Placeholder { at, is_whole, setting } in &self.holes {
            filled.push_str(&text[from..at.start]);
            let number = setting.factor * values[setting.parameter] + setting.offset;
            // Counts are written without a fraction. A value that is not an integer is refused when the file is read.
            let _ = match *is_whole && number.fract() == 0.0 && number.abs() < 1e15 {
                true => write!(filled, "{}", number as i64),
                false => write!(filled, "{number:?}"),
            };
            from = at.end;
        }
        filled.push_str(&text[from..]);
        self.source.with_text(filled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_put_in_place_and_nothing_else_changes() {
        let source =
            Source::in_memory("w.toml", "# a world\nclearance = 0.01 # m\n[[pallet]]\nrows = 2\nname = \"p\"\n");
        let setting = |parameter, factor, offset| Setting { parameter, factor, offset };
        let at = |address: &str| place(address).unwrap().1;
        let settings =
            [(at("world.pallet.p.rows"), setting(1, 1.0, 0.0)), (at("world.clearance"), setting(0, 2.0, 0.5))];
        let template = Template::new(source.clone(), Place::World, &settings).unwrap();
        let filled = template.filled(&[0.1, 3.0]);
        assert_eq!(filled.text(), "# a world\nclearance = 0.7 # m\n[[pallet]]\nrows = 3\nname = \"p\"\n");
        assert_eq!(template.filled(&[1e-9, 3.5]).text().matches("rows = 3.5").count(), 1);
        let twice = [settings[0].clone(), settings[0].clone()];
        assert_eq!(Template::new(source, Place::World, &twice), Err((1, "it is set twice".into())));
        assert_eq!(place("goal.joints[0]"), Err("goal.joints[0]: an address must begin with world. or urdf.".into()));
    }
}
