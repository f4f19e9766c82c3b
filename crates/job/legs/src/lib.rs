//! The motion of a task, step by step. Every planner of tasks returns it; results, pictures and pages read it.
//!
//! - [`Leg`]: the arm's actions for one step, with the motions of the tool's own joints ([`ToolStroke`], [`WristMotion`],
//!   [`TimedTurn`]) and their [`Overlap`] with the motion of the arm.
//! - [`TaskAnswer`]: all legs and their [`Sequence`], or the [`FailedStep`].
//! - [`TaskReplay`]: how the planner found each motion.

mod answer;
mod failed_step;
mod leg;
mod replay;
mod sequence;
mod timed_turn;
mod tool;
mod wrist_state;

pub use answer::{TaskAnswer, TaskMotion};
pub use failed_step::{FailedStep, RefusedIkSolution, Standstill, StandstillScene};
pub use leg::{Event, Leg};
pub use replay::{MotionReplay, TaskReplay};
pub use sequence::Sequence;
pub use timed_turn::TimedTurn;
pub use tool::{Overlap, ToolStroke, WristMotion};
pub use wrist_state::wrist_state;
