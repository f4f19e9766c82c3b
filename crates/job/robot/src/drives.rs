//! The table `drives` of `[robot]` in the world file.

use super::quantity::{Number, Numbers, Written};
#[cfg(feature = "schema")]
use super::schema::*;
use super::toml_values::{FromToml, TomlError, TomlValue};
use crate::Spanned;
use crate::toml_table;

/// The motors of the two joints: "standard_scara" if the elbow's motor is mounted on the base, "direct" if it is
/// mounted on link 1, or a table.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(inline, untagged))]
pub enum DrivesValue {
    /// `"standard_scara"` if the elbow's motor is mounted on the base; `"direct"` if it is mounted on link 1.
    Preset(String),
    /// The motors, with their limits.
    Table(Box<DrivesTable>),
}

impl FromToml for DrivesValue {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        match value.get_ref().as_str() {
            Some(name) => Ok(Self::Preset(name.to_owned())),
            None => DrivesTable::read(value).map(|table| Self::Table(Box::new(table))),
        }
    }
}

toml_table! {
    /// The motors of two revolute joints. At the joint values q1 and q2, the shafts have the angles
    /// `gear[0] q1 + zero[0]` and `gear[1] (ratio q1 + q2) + zero[1]`.
    #[derive(Debug, Clone, PartialEq)]
    #[cfg_attr(feature = "schema", derive(JsonSchema), schemars(deny_unknown_fields, rename = "drives"))]
    pub struct DrivesTable {
        /// Body on which the elbow's motor is mounted: `"base"`, or `"link"` for link 1; by default `"base"`.
        pub elbow: Option<Spanned<String>>,
        /// For an elbow's motor on the base: `ratio` in the formula above; by default 1, as with equal pulleys.
        pub ratio: Option<Number>,
        /// Gear ratios: turns of each motor's shaft per turn of its output; negative for the opposite direction; by
        /// default [1, 1].
        #[cfg_attr(feature = "schema", schemars(with = "Option<NumberPair>"))]
        pub gear: Option<Numbers>,
        /// Angles of the shafts at joint values of zero, rad; by default [0, 0].
        #[cfg_attr(feature = "schema", schemars(with = "Option<[Quantity; 2]>"))]
        pub zero: Option<Spanned<Vec<Written>>>,
        /// Limits of the shafts.
        pub motors: Option<MotorTable>,
    }

    /// Limits of both motors' shafts, in addition to the limits of the joints.
    #[derive(Debug, Clone, PartialEq)]
    #[cfg_attr(feature = "schema", derive(JsonSchema), schemars(deny_unknown_fields, rename = "motors"))]
    pub struct MotorTable {
        /// Least angles, rad.
        #[cfg_attr(feature = "schema", schemars(with = "Option<[Quantity; 2]>"))]
        pub lower: Option<Spanned<Vec<Written>>>,
        /// Greatest angles, rad.
        #[cfg_attr(feature = "schema", schemars(with = "Option<[Quantity; 2]>"))]
        pub upper: Option<Spanned<Vec<Written>>>,
        /// Top speeds, rad/s.
        #[cfg_attr(feature = "schema", schemars(with = "Option<[Positive; 2]>"))]
        pub velocity: Option<Numbers>,
        /// Greatest accelerations, rad/s2.
        #[cfg_attr(feature = "schema", schemars(with = "Option<[Positive; 2]>"))]
        pub acceleration: Option<Numbers>,
        /// Greatest jerks, rad/s3.
        #[cfg_attr(feature = "schema", schemars(with = "Option<[Positive; 2]>"))]
        pub jerk: Option<Numbers>,
        /// Greatest torques, N m. Like the efforts of joints, they limit motions with `dynamics = true`.
        #[cfg_attr(feature = "schema", schemars(with = "Option<[Positive; 2]>"))]
        pub effort: Option<Numbers>,
    }
}
