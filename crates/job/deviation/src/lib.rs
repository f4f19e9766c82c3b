//! Proven bounds on the distance between the path of the tip and a line that it follows.
//!
//! [`Deviation`] bounds the distance for a motion in polynomial pieces, also between samples, and respects the order of the
//! line's points. The planner of motions along lines and the judge of recorded motions both use it. [`ToolDeviation`] does the
//! same for the angle of a tool that a wrist turns along the line.
#![forbid(unsafe_code)]

mod deviation;
mod free_space;
mod kinematics;
mod line;
mod tool_angle;

pub use deviation::{Deviation, Foot, Pairing, advance, sag};
pub use kinematics::{Kinematics, SolutionBox};
pub use line::{Line, Place};
pub use tool_angle::{ToolDeviation, is_sharp};
