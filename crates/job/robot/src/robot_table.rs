//! The world file's `[robot]` table.

use crate::Spanned;
use crate::calibration::CalibrationTable;
use crate::drives::DrivesValue;
use crate::quantity::{Length, Lengths, Number, Numbers, PerJoint, Written};
#[cfg(feature = "schema")]
use crate::schema::*;
use crate::stroke::{ArchValue, StrokeTable};
use crate::toml_table;
use crate::wrist::WristTable;

toml_table! {
    /// Settings that complete or override the URDF. All keys are optional.
    #[derive(Debug, Clone, Default, PartialEq)]
    #[cfg_attr(feature = "schema", derive(JsonSchema), schemars(deny_unknown_fields, rename = "robot"))]
    pub struct RobotTable {
        /// Position of the robot's root frame in the world, m; by default [0, 0].
        #[cfg_attr(feature = "schema", schemars(with = "Option<LengthPair>"))]
        pub at: Option<Lengths>,
        /// Angle of the robot's root frame in the world, rad; by default 0.
        pub angle: Option<Written>,
        /// The two planned joints, from the base to the tip; needed only if the URDF has more than two movable joints.
        #[cfg_attr(feature = "schema", schemars(with = "Option<[String; 2]>"))]
        pub joints: Option<Spanned<Vec<Spanned<String>>>>,
        /// Link whose origin is the tip; by default the end of the chain.
        pub tip: Option<Spanned<String>>,
        /// Values of the movable joints that are not planned, by name, rad or m; by default 0, or the limit nearest to
        /// 0.
        #[cfg_attr(feature = "schema", schemars(default, with = "BTreeMap<String, Quantity>"))]
        pub fixed: PerJoint<Written>,
        /// Least and greatest value of a joint, by name, rad or m, instead of the URDF's.
        #[cfg_attr(feature = "schema", schemars(default, with = "BTreeMap<String, [Quantity; 2]>"))]
        pub limits: PerJoint<Spanned<Vec<Written>>>,
        /// Top speed of a joint, by name, rad/s or m/s, instead of the URDF's.
        #[cfg_attr(feature = "schema", schemars(default, with = "BTreeMap<String, Positive>"))]
        pub velocity: PerJoint<Number>,
        /// Greatest acceleration of a joint, by name, rad/s2 or m/s2; by default the joint reaches its top speed in
        /// 0.25 s.
        #[cfg_attr(feature = "schema", schemars(default, with = "BTreeMap<String, Positive>"))]
        pub acceleration: PerJoint<Number>,
        /// Motors of two joints that turn, with their limits: a table, "standard_scara" or "direct".
        pub drives: Option<Spanned<DrivesValue>>,
        /// Greatest errors of the robot and of the obstacles' positions. Motions are free for all errors up to these;
        /// by default none.
        pub calibration: Option<Spanned<CalibrationTable>>,
        /// Greatest jerk of a joint, by name, rad/s3 or m/s3; by default without limit.
        #[cfg_attr(feature = "schema", schemars(default, with = "BTreeMap<String, Positive>"))]
        pub jerk: PerJoint<Number>,
        /// Greatest torque or force of a joint, by name, N m or N, instead of the URDF's.
        #[cfg_attr(feature = "schema", schemars(default, with = "BTreeMap<String, Positive>"))]
        pub effort: PerJoint<Number>,
        /// True if torques and forces, computed with the masses of the URDF, must stay within the joints' `effort`
        /// limits.
        #[cfg_attr(feature = "schema", schemars(default))]
        pub dynamics: bool,
        /// Acceleration of free fall in the robot's root frame, m/s2; by default [0, 0, -9.81].
        #[cfg_attr(feature = "schema", schemars(with = "Option<[f64; 3]>"))]
        pub gravity: Option<Numbers>,
        /// True if links of the robot are obstacles for its other links; by default true.
        pub(crate) own_body: Option<bool>,
        /// Pairs of the robot's links that may touch each other.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Vec<[String; 2]>>"))]
        pub ignore_contact: Option<Vec<Spanned<Vec<Spanned<String>>>>>,
        /// Radius of the capsule that replaces a link without geometry, m.
        #[cfg_attr(feature = "schema", schemars(with = "Option<PositiveLength>"))]
        pub bar: Option<Length>,
        /// The wrist, which keeps or changes the orientation of objects with payload "level".
        pub wrist: Option<WristTable>,
        /// Motion of the tool down and up at picks and places; by default the tool stays at its height.
        pub stroke: Option<StrokeTable>,
        /// Overlap of strokes and turns of the wrist with motions of the arm.
        pub(crate) arch: Option<Spanned<ArchValue>>,
        /// Payload of objects without `payload`; by default "rigid".
        #[cfg_attr(feature = "schema", schemars(with = "Option<HeldAs>"))]
        pub payload: Option<Spanned<String>>,
    }
}

impl RobotTable {
    /// Returns the table without the robot's placement and errors, for the reader of URDFs.
    #[must_use]
    pub fn unplaced(&self) -> Self {
        Self { at: None, angle: None, calibration: None, ..self.clone() }
    }

    /// Returns the name of the wrist's joint, if the table states it.
    pub fn wrist_joint(&self) -> Option<&Spanned<String>> {
        self.wrist.as_ref()?.joint.as_ref()
    }

    /// Returns true if strokes and turns of the wrist may overlap with motions of the arm. By default, they may.
    pub fn allows_arches(&self) -> bool {
        !matches!(self.arch.as_ref().map(Spanned::get_ref), Some(ArchValue::Switch(false)))
    }

    /// Returns true if links of the robot are obstacles to its other links. By default, they are.
    pub fn own_body_is_obstacle(&self) -> bool {
        self.own_body != Some(false)
    }
}
