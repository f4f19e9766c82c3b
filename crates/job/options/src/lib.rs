//! Options of planners and motions: one grammar for the command line, `compare --with` and the live page.

mod field;
mod motion;
mod names;
mod number;
mod planner;
mod readers;
mod roadmap;

pub use field::direction;
pub use motion::MotionArgs;
pub use names::{INITIALS, JOINTS, LIMITS, MEASURES, ORDERS, Word, planners, word};
pub use number::{finite, number_in, positive};
pub use planner::{EffortArgs, PlannerArgs, PlannerWords};
