//! The tables of study files, and their schema.

#[cfg(test)]
use cplan_robot::schema::*;
use cplan_robot::{FromToml, Quantity, Spanned, TomlError, TomlValue, toml_table};
use std::ops::Range;
use toml::de::DeValue;

/// A text, and where it stands.
pub(super) type Text = Spanned<String>;

toml_table! {
    /// A study of many layouts for cplan: a robot in a world, numbers that vary, and measures. Lengths are in metres,
    /// angles in radians, times in seconds.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "cplan study"))]
    pub(super) struct StudyFile {
        /// Title of tables and pages; by default the file's name.
        pub name: Option<String>,
        /// The robot's URDF, relative to this file. It may be missing where the robot is given otherwise, as in Python.
        #[cfg_attr(test, schemars(with = "Option<String>"))]
        pub robot: Option<Text>,
        /// The world file, relative to this file. It may be missing where the world is given otherwise.
        #[cfg_attr(test, schemars(with = "Option<String>"))]
        pub world: Option<Text>,
        /// Options of the main job, such as ["--planner=first", "--clearance=0.01"].
        pub options: Option<Spanned<Vec<String>>>,
        /// Draws for each combination of the values that are listed; needed where a parameter is drawn.
        pub draws: Option<Spanned<u64>>,
        /// Seed of the draws; by default 0.
        pub seed: Option<u64>,
        /// Measures: length, over_bound, lower_bound, clearance, duration; by default all of them.
        #[cfg_attr(test, schemars(with = "Option<Vec<String>>"))]
        pub measure: Option<Vec<Text>>,
        /// True to allow overlapping obstacles that do not overlap in the world file; by default such a layout is refused.
        #[cfg_attr(test, schemars(default))]
        pub overlap: bool,
        /// Conditions on layouts, such as ["clearance >= 0.01", "duration <= 3"].
        #[cfg_attr(test, schemars(default, with = "Vec<String>"))]
        pub conditions: Vec<Text>,
        /// Objective that ranks layouts: "least duration", "most clearance"; by default the first measure, duration before
        /// length.
        #[cfg_attr(test, schemars(with = "Option<String>"))]
        pub objective: Option<Text>,
        pub search: Option<SearchTable>,
        /// The parameters that vary between layouts.
        #[cfg_attr(test, schemars(default, with = "Vec<ParameterTable>"))]
        pub parameter: Vec<Spanned<ParameterTable>>,
    }

    /// A search for a better layout than those listed and drawn, within the ranges of the parameters.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields))]
    pub(super) struct SearchTable {
        /// Layouts that it may try.
        pub layouts: Spanned<u64>,
    }

    /// A number of world or robot that differs: listed, in equal steps, or drawn.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields))]
    pub(super) struct ParameterTable {
        /// Its name, a column of the table.
        #[cfg_attr(test, schemars(with = "String"))]
        pub name: Text,
        /// The unit of its values, for tables and pictures.
        pub unit: Option<String>,
        /// The numbers that it sets: an address such as "world.robot.at[0]" or "urdf.joint.elbow.origin.xyz[0]", or
        /// several.
        pub sets: Spanned<Targets>,
        /// Its values; angles may be written as "30deg".
        pub values: Option<Spanned<Vec<Quantity>>>,
        /// Its least value.
        pub from: Option<Spanned<Quantity>>,
        /// Its greatest value.
        pub to: Option<Spanned<Quantity>>,
        /// The number of its values from the least to the greatest, in equal steps.
        pub steps: Option<Spanned<u64>>,
        /// Instead of steps: "uniform" (independent draws) or "latin" (one in each of as many equal intervals as there are
        /// draws).
        #[cfg_attr(test, schemars(with = "Option<String>"))]
        pub draw: Option<Text>,
    }
}

/// The numbers that a parameter sets.
#[cfg_attr(test, derive(JsonSchema), schemars(untagged))]
pub(super) enum Targets {
    /// An address.
    One(String),
    /// Several, each the address of a number.
    Many(Vec<Target>),
}

/// A number that follows from a parameter.
#[cfg_attr(test, derive(JsonSchema), schemars(untagged))]
pub(super) enum Target {
    /// The number at this address is the parameter's value.
    Address(String),
    /// It is `factor` times the value, plus `offset`.
    Scaled(Scaled),
}

toml_table! {
    /// A number that is some multiple of a parameter, plus something.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields))]
    pub(super) struct Scaled {
        /// The address.
        pub address: String,
        /// Factor; by default 1.
        pub factor: Option<f64>,
        /// Offset; by default 0.
        pub offset: Option<f64>,
    }
}

impl ParameterTable {
    /// Returns the position of the first value that is written in degrees, if any.
    pub fn degrees(&self) -> Option<Range<usize>> {
        let listed = self.values.iter().filter(|values| values.get_ref().iter().any(|value| value.in_degrees));
        let ends = [&self.from, &self.to].into_iter().flatten().filter(|end| end.get_ref().in_degrees);
        listed.map(Spanned::span).chain(ends.map(Spanned::span)).next()
    }
}

impl FromToml for Targets {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        match value.get_ref() {
            DeValue::String(address) => Ok(Self::One(address.to_string())),
            _ => Vec::read(value).map(Self::Many).map_err(|_| no_variant(value, "Targets")),
        }
    }
}

impl FromToml for Target {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        match value.get_ref() {
            DeValue::String(address) => Ok(Self::Address(address.to_string())),
            _ => Scaled::read(value).map(Self::Scaled).map_err(|_| no_variant(value, "Target")),
        }
    }
}

fn no_variant(value: &TomlValue, name: &str) -> TomlError {
    TomlError::new(value, format!("data did not match any variant of untagged enum {name}"))
}

impl Targets {
    /// Returns each address that the parameter sets, with its factor and offset.
    pub fn all(&self) -> Vec<(&str, f64, f64)> {
        match self {
            Self::One(address) => vec![(address.as_str(), 1.0, 0.0)],
            Self::Many(targets) => targets.iter().map(Target::setting).collect(),
        }
    }
}

impl Target {
    fn setting(&self) -> (&str, f64, f64) {
        match self {
            Self::Address(address) => (address.as_str(), 1.0, 0.0),
            Self::Scaled(Scaled { address, factor, offset }) => {
                (address.as_str(), factor.unwrap_or(1.0), offset.unwrap_or(0.0))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_agrees_with_its_file() {
        compare_with_file(toml_schemas().into_root_schema_for::<StudyFile>(), "study.schema.json");
    }
}
