//! Plans: one call of [`plan()`] leads from files or a model to the result that is printed and written.
//!
//! - [`Problem`]: the requested motion or task, read from files or made in code.
//! - [`Plan`]: the answer. `motion` times the path that the solver found, `fastest` compares several paths, and [`Refutation`] is
//!   a proof.
//! - `result`: the figures of a plan, its JSON, and its file formats. `stored`: serialised problems and plans.
//! - `certificate`: evidence that a checker can judge without this program, such as [`Plan::certificate`].
//! - [`findings`]: verdicts on given configurations.
//!
//! The search for one motion is in the crate `solver`. Companion crates provide others ([`Searches`]): `movers` for moving
//! obstacles, `tasks` for sequences of steps.

mod certificate;
mod clock;
mod fastest;
mod field_report;
pub mod findings;
mod margins;
mod motion;
mod plan;
mod problem;
mod result;
mod searches;
mod stored;

pub use certificate::{
    BoundCertificate, CertifiedLine, ExcludedSolution, NoCertificate, certificate_of_bound, certificate_of_boxes,
    certificate_of_recording,
};
pub use cplan_world::AllowedErrors;
pub use motion::Motion;
pub use plan::{Detail, Plan, PlanError, Refutation, plan};
pub use problem::{Problem, ProblemError};
pub use result::MessageError;
pub use searches::{MotionAmongMovers, MoverSearch, Searches, TaskSearch};
pub use stored::{StoredPlan, StoredPlanError};
