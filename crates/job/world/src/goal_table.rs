//! The world file's `[goal]`.

#[cfg(test)]
use super::schema::*;
use cplan_robot::{Length, Lengths, Spanned, Written, toml_table};

toml_table! {
    /// Goal of the arm: joint values, a position of the tip, or areas for the tip. For a position, cplan chooses the
    /// best IK solution.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "goal", extend("oneOf" = [{ "required": ["joints"] }, { "required": ["tip"] }, { "required": ["areas"] }], "dependencies" = { "elbow": ["tip"] })))]
    pub(super) struct GoalTable {
        /// Values of both joints, base to tip, rad or m.
        #[cfg_attr(test, schemars(with = "Option<[Quantity; 2]>"))]
        pub joints: Option<Spanned<Vec<Written>>>,
        /// Coordinates of the tip, m.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        pub tip: Option<Lengths>,
        /// With `tip`: side of the elbow, seen from joint 1 towards the tip; by default either.
        #[cfg_attr(test, schemars(with = "Option<ElbowSide>"))]
        pub elbow: Option<Spanned<String>>,
        /// Rectangles, each given by two opposite corners, m. The tip must reach one of them. If the arm has a revolute
        /// joint, it must reach the middle of one of them. Not in steps.
        #[cfg_attr(test, schemars(with = "Option<Vec<[LengthPair; 2]>>"))]
        pub areas: Option<Spanned<Vec<Spanned<Vec<Lengths>>>>>,
        /// Value of the joint that lowers the tool, m; by default the tool is raised. Not in steps.
        pub stroke: Option<Length>,
        /// Value of the wrist's joint, rad; by default its value at the start. Not in steps.
        pub wrist: Option<Written>,
    }
}
