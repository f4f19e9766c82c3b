//! Planning options: the planner with its settings, the settings for driving, and the content of the output files.

use super::{Method, Planner};
use cplan_dynamics::keep_efforts;
use cplan_model::{Arm, Joint};
use cplan_motion::{Drive, MIN_INTERVAL};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Allowed values of [`Options::levels`].
pub const ALLOWED_LEVELS: RangeInclusive<usize> = 1..=12;

/// Joints that ROS 2 messages name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NamedJoints {
    /// Every movable joint of the robot.
    #[default]
    All,
    /// The two planned joints.
    Planned,
}

/// Options for solving a problem.
///
/// ```
/// use cplan_solver::{Method, Options, Planner};
///
/// let options = Options { planner: Planner::named(Method::First), ..Options::default() };
/// assert_eq!(options.levels, Options::default().levels);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// The planner with its own settings.
    pub planner: Planner,
    /// Number of attempts (levels), from 1 to 12, each finer than the previous one. With polygons, the margin shrinks to a
    /// quarter. With cells, the first attempt uses cells that are free throughout, and the second one cells with free centres;
    /// then their number along each axis doubles, and so on. If all attempts judge cells by their centres, the number doubles
    /// with each attempt.
    pub levels: usize,
    /// Number of boxes for a proof that there is no path, and for planning by subdivision.
    pub boxes: usize,
    /// True if planners that minimise length compute a proven lower bound. If false, they aim at the gap but do not prove it.
    pub bounded: bool,
    /// Settings for driving along the path.
    pub drive: Drive,
    /// Greatest jerk of each joint, rad/s3 or m/s3, instead of the robot's limits; `None` in the array for a joint without a
    /// limit. `None` keeps the robot's limits.
    pub jerk: Option<[Option<f64>; 2]>,
    /// Joints in ROS 2 messages.
    pub joints: NamedJoints,
    /// True if tables and messages include accelerations, so that controllers join points by quintics.
    pub accelerations: bool,
    /// True if the JSON includes the time of each stage. If false, equal input gives equal bytes.
    pub timings: bool,
}

impl Default for Options {
    /// Returns the defaults: the shortest path, six attempts, a sample every hundredth of a second.
    fn default() -> Self {
        Self {
            planner: Planner::named(Method::Shortest),
            levels: 6,
            boxes: 200_000,
            bounded: true,
            drive: Drive::default(),
            jerk: None,
            joints: NamedJoints::All,
            accelerations: false,
            timings: false,
        }
    }
}

impl From<Planner> for Options {
    fn from(planner: Planner) -> Self {
        Self { planner, ..Self::default() }
    }
}

impl From<Method> for Options {
    fn from(method: Method) -> Self {
        Planner::named(method).into()
    }
}

impl Options {
    /// Replaces the arm's jerk limits by those in these options. Motions must also respect effort limits if these options or the
    /// arm require it.
    pub fn override_limits(&self, arm: &mut Arm) {
        Joint::override_jerks(&mut arm.joints, self.jerk);
        if self.drive.torque || arm.dynamics.is_some_and(|dynamics| dynamics.limits) {
            keep_efforts(arm);
        }
    }

    /// Names and describes the first invalid option. `None` if all are valid. `has_steps` is true if the options are for a task
    /// with steps.
    pub fn error(&self, has_steps: bool) -> Option<String> {
        let Drive { period, blend, tip_speed, optimize: _, torque: _ } = self.drive;
        let jerks = self.jerk.into_iter().flatten().flatten();
        let not_positive = |value: &f64| !value.is_finite() || *value <= 0.0;
        if let Some(error) = self.planner.error() {
            Some(error)
        } else if !ALLOWED_LEVELS.contains(&self.levels) {
            Some(format!("levels: {} must be from {} to {}", self.levels, ALLOWED_LEVELS.start(), ALLOWED_LEVELS.end()))
        } else if !(period.is_finite() && period >= MIN_INTERVAL) {
            Some(format!("period: {period} s must be finite and at least {MIN_INTERVAL} s"))
        } else if blend.is_nan() || blend < 0.0 {
            Some(format!("blend: {blend} is not a radius"))
        } else if let Some(wrong) = tip_speed.into_iter().chain(jerks).find(not_positive) {
            Some(format!("speed and jerk: {wrong} must be finite and positive"))
        } else if has_steps && self.planner.gap().is_some() {
            Some("--gap does not apply to worlds with steps; their results always state the proven gap".into())
        } else {
            None
        }
    }
}
