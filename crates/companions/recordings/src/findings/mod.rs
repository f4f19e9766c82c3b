//! Findings about recorded motions and tasks, as data.

mod motion;
mod plan;
mod task;

pub(crate) use motion::ExceededLimits;
pub use motion::{CollisionFinding, EncounterFinding, Judgement, LimitFinding, MomentFinding, MotionFindings};
pub use plan::{FarthestFinding, PlanFinding};
pub(crate) use task::judge_steps;
pub use task::{StepFinding, TurnContactFinding, TurnFinding};
