//! Explains why there is no motion, or why a step of a task fails, and which changes open a path. For a motion that
//! exists, explains which elements make it longer.
//!
//! ```
//! use cplan_explain::{MotionQuestion, explain};
//! use cplan_model::{Arm, Joint, Obstacle, Outcome, Scene, Workspace};
//! use cplan_model::space::{Configuration, GoalSet};
//! use cplan_model::Status;
//! use cplan_solver::Options;
//!
//! // A post that blocks the first link, and one far away that blocks nothing.
//! let posts = [Obstacle::circle("far", [5.0, 0.0], 0.1)?, Obstacle::circle("near", [0.4, 0.0], 0.1)?];
//! let mut arm = Arm::rr([1.0, 0.8], 0.06)?;
//! arm.joints[0] = Joint::turning("shoulder", -2.0, 2.0);
//! let scene = Scene::new(arm, Workspace::new(posts))?;
//! let goals = GoalSet::from(Configuration::new(1.0, 0.0));
//! let explanation = explain(&MotionQuestion::new(scene, Configuration::new(-1.0, 0.0), goals), &Options::default());
//!
//! let Outcome::Infeasible(closed) = &explanation.outcome else { panic!("{:?}", explanation.status()) };
//! assert_eq!(closed.blocking(explanation.question.scene()), ["near"]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bottleneck;
mod cards;
mod change;
mod changed;
mod ends;
mod explanation;
mod flood;
mod json;
mod motion_tree;
mod output;
mod reach;
mod reach_section;
mod shaping;
mod threshold;
mod words;

pub use bottleneck::{Bottleneck, bottleneck};
pub use change::{Change, ChangeContext, ChangeKind, changes};
pub use cplan_blockers::{
    Blocker, BlockingSet, Element, End, MIN_CLEARANCE, MotionQuestion, Side, TIME_LIMIT, Target, blocking_set,
    blocking_sets,
};
pub use ends::{BlockedEnd, OutOfReach, blocked_ends};
pub use explanation::{Explanation, FoundExplanation, InfeasibleExplanation, StepFailure, explain, explain_step};
pub use motion_tree::{MotionTree, Origin};
pub use output::{section, summary, view, with_explanation, with_step_explanation};
pub use reach::{Access, MAX_PLACES, Reach, Solution, reach};
pub use reach_section::reach_section;
pub use shaping::{Saving, savings};
pub use threshold::Threshold;
