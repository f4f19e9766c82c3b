//! From a task to a sequence of certified motions: which posture to take at each target, how to grip, and in which
//! order, are chosen together, for the least total time.
//!
//! Each motion has a scene of its own: objects lie where the steps before have left them, and what is carried is part of
//! the arm. The object that a motion goes to, and the one just let go of, are no obstacles to link 2, which has to reach
//! into them; they are to link 1 and to payloads.
//!
//! [`plan`] searches a layered graph, whose nodes say what is done, where the arm and the objects are, and what is
//! carried, by A* over times. Motions are planned only when they matter: until then an edge counts as the time that the
//! joints would take if nothing were in the way, which no motion undercuts. Such times to the end, over all postures (and
//! orders), are the heuristic; at the start they bound the whole task from below.

mod answer;
mod failed_step;
mod files;
mod impossible;
mod joints;
mod legs;
mod least_time;
mod order;
mod outlook;
mod part;
mod plan;
mod postures;
mod report;
mod search;
mod sequence;
mod state;
mod step_report;
mod stroke;

pub use answer::{Event, Leg, TaskAnswer, TaskVerdict};
pub use failed_step::{FailedStep, PostureReport};
pub use impossible::{Impossible, Unreached};
pub use joints::MessageError;
pub use least_time::rest_to_rest;
pub use plan::plan;
pub use report::{Choice, TaskReport};
pub use sequence::Sequence;
pub use step_report::{ActionName, EventName, EventReport, StepReport, StrokeReport, TurnReport};
pub use stroke::ToolStroke;

use crate::engine::{Effort, Method};
use crate::motion::Drive;

/// How to plan the motions of a task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Manner {
    /// The planner of each motion.
    pub method: Method,
    /// How hard it tries.
    pub effort: Effort,
    /// How to drive along its paths.
    pub drive: Drive,
}
