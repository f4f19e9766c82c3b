//! Programs for robot controllers: the motion of a plan as joint moves, written by a template.
//!
//! - [`Program`]: the joint moves of a plan. Each is a straight line in joint space that ends at rest. The arm stands still
//!   while the gripper acts, and during strokes and turns of the wrist.
//! - [`Template`]: a text in the language of [`minijinja`], shipped or from a file, that writes the program.
//! - [`Signal`]: a digital signal between two programs, at a point of the motion.
//! - [`JointTolerance`]: how far a controller may be from the straight lines.
//!
//! The written text is certified, not the plan. Each joint value carries a mark through the template (`joint_value`). After
//! the marks are removed, the digits between them are the targets, in the order of the text (`written`). The judge checks
//! the straight lines between these targets (`certify`).
//!
//! # The tolerance
//!
//! A deviation of the joints displaces every point of the arm and its payload by at most `D` (`tolerance`). So a line that
//! keeps the distance `c + D` is free by `c` for all motions within the tolerance. The plan is made with the clearance
//! `c + D`, where `D` includes the rounding of the digits. The heights of the quill have the tolerance, too, except at the
//! bottom of a stroke, where the tool meets the part.

mod builder;
mod certify;
mod data;
mod error;
mod joint_value;
mod moves;
mod program;
mod signals;
mod template;
mod tolerance;
mod written;

pub use error::ProgramError;
pub use program::{MovePart, Program};
pub use signals::{Signal, SignalPlace, SignalUse};
pub use template::{SHIPPED, Template};
pub use tolerance::JointTolerance;
pub use written::Written;
