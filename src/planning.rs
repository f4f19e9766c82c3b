//! Plans with all searches of this library.

use cplan_engine::{Plan, PlanError, Problem, StoredPlan, StoredPlanError};
use cplan_solver::Options;
use cplan_tasks::SEARCHES;

/// Plans a problem. The result is a certified motion, a proof that no motion exists, or neither if the allowed effort
/// does not suffice. Planning usually takes milliseconds.
///
/// # Errors
/// Invalid options, a motion that lasts too long for its samples, and requested accelerations that jump.
pub fn plan(problem: &Problem, options: &Options) -> Result<Plan, PlanError> {
    plan_with(problem, options, &mut |_| ())
}

/// Plans like [`plan`]. Reports long computations and surprising results to `progress`, in lines of text.
///
/// # Errors
/// The errors of [`plan`].
pub fn plan_with(problem: &Problem, options: &Options, progress: &mut dyn FnMut(&str)) -> Result<Plan, PlanError> {
    #[cfg(feature = "gpu")]
    crate::bring_gpu();
    cplan_engine::plan(problem, options, SEARCHES, progress)
}

/// Returns the stored plan. Its result is not trusted: the problem is planned again, and a different result is refused.
/// Only measured times may differ. So the plan is as certified as a new one.
///
/// # Errors
/// A problem that cannot be planned, and a result that differs.
pub fn restored(stored: &StoredPlan) -> Result<Plan, StoredPlanError> {
    stored.planned_again(SEARCHES)
}
