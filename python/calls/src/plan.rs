//! Plans, and their motions as columns.

use crate::error::Refusal;
use crate::problem::Options;
use serde::Serialize;

/// A motion in time: one row per sample, one column per joint, base to tip.
#[derive(Debug, Serialize)]
pub struct Trajectory {
    /// Seconds from the start.
    pub time: Vec<f64>,
    /// Joint values, in radians or metres.
    pub position: Vec<[f64; 2]>,
    /// Joint velocities.
    pub velocity: Vec<[f64; 2]>,
    /// Joint accelerations at the beginning of each interval.
    pub acceleration: Vec<[f64; 2]>,
    /// Names of the joints.
    pub joints: [String; 2],
    /// Units of the joints' values.
    pub units: [&'static str; 2],
    /// Description of the motion between samples.
    pub interpolation: &'static str,
}

/// Plans. `progress` receives lines of text during long work.
///
/// # Errors
/// Options that do not suit the problem.
pub fn plan(
    problem: &cplan::Problem,
    options: &Options,
    progress: &mut dyn FnMut(&str),
) -> Result<cplan::Plan, Refusal> {
    cplan::engine::plan_with(problem, &options.options, progress).map_err(Refusal::value)
}

/// Restores a pickled plan: it plans again.
///
/// # Errors
/// A result that differs from the stored one.
pub fn restored(data: &[u8]) -> Result<cplan::Plan, Refusal> {
    let stored = serde_json::from_slice(data).map_err(Refusal::value)?;
    cplan::engine::restored(&stored).map_err(Refusal::value)
}

/// Returns the motion of a plan as columns. `None` if there is no motion.
pub fn trajectory(plan: &cplan::Plan) -> Option<Trajectory> {
    let motion = plan.trajectory().cloned()?;
    let joints = &plan.arm().joints;
    Some(Trajectory {
        time: motion.time,
        position: motion.position,
        velocity: motion.velocity,
        acceleration: motion.acceleration,
        joints: joints.each_ref().map(|joint| joint.name.clone()),
        units: joints.each_ref().map(|joint| joint.unit()),
        interpolation: cplan::motion::interpolation(plan.arm()),
    })
}
