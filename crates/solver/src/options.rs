//! What is asked for: a planner with options of its own, how to drive, and what files hold.

use super::{Method, Planner};
use cplan_core::model::{Arm, Joint};
use cplan_dynamics::keep_efforts;
use cplan_motion::{Drive, SHORTEST_INTERVAL};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Numbers of attempts.
pub const LEVELS: RangeInclusive<usize> = 1..=12;

/// Joints that ROS 2 messages name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NamedJoints {
    /// Every movable joint of the robot.
    #[default]
    All,
    /// The two that are planned for.
    Planned,
}

/// What is asked for beside the problem.
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
    /// Which planner, with options of its own.
    pub planner: Planner,
    /// Attempts, from 1 to 12, each finer than the one before: a quarter of the margin; cells that are wholly free, then as
    /// many that are free at their centres, then twice as many along each axis; sampled ones twice as many each time.
    pub levels: usize,
    /// Boxes for a proof that there is no path, and for planning by subdivision.
    pub boxes: usize,
    /// Whether planners that optimise bound the optimum from below; if not, the gap is aimed at without proof.
    pub bounded: bool,
    /// How to drive along the path.
    pub drive: Drive,
    /// Greatest jerk of each joint in place of its own, rad/s3 or m/s3; none for a joint without a limit.
    pub jerk: Option<[Option<f64>; 2]>,
    /// Joints that ROS 2 messages name.
    pub joints: NamedJoints,
    /// Whether tables and messages have accelerations, so that controllers join points by quintics.
    pub accelerations: bool,
    /// Whether the JSON has the time that each stage took; without it the same input gives the same bytes.
    pub timings: bool,
}

impl Default for Options {
    /// The shortest path, six attempts, a sample every hundredth of a second.
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
    /// The planner of that name, as it is if nothing else is said.
    fn from(method: Method) -> Self {
        Planner::named(method).into()
    }
}

impl Options {
    /// Puts the limits that are given here in place of the joints' own.
    pub fn override_limits(&self, arm: &mut Arm) {
        Joint::override_jerks(&mut arm.joints, self.jerk);
        if self.drive.torque || arm.dynamics.is_some_and(|dynamics| dynamics.limits) {
            keep_efforts(arm);
        }
    }

    /// What makes no sense, by name. `has_steps` says whether they are for a sequence of steps.
    pub fn error(&self, has_steps: bool) -> Option<String> {
        let Drive { period, blend, tip_speed, optimize: _, torque: _ } = self.drive;
        let jerks = self.jerk.into_iter().flatten().flatten();
        let not_positive = |value: &f64| !value.is_finite() || *value <= 0.0;
        if let Some(error) = self.planner.error() {
            Some(error)
        } else if !LEVELS.contains(&self.levels) {
            Some(format!("levels: {} is not from {} to {}", self.levels, LEVELS.start(), LEVELS.end()))
        } else if !(period.is_finite() && period >= SHORTEST_INTERVAL) {
            Some(format!("period: {period} s is not finite and at least {SHORTEST_INTERVAL} s"))
        } else if blend.is_nan() || blend < 0.0 {
            Some(format!("blend: {blend} is not a radius"))
        } else if let Some(wrong) = tip_speed.into_iter().chain(jerks).find(not_positive) {
            Some(format!("speed and jerk: {wrong} is not finite and positive"))
        } else if has_steps && self.planner.gap().is_some() {
            Some("--gap is for a single motion; what is proven of a sequence of steps is part of every answer".into())
        } else {
            None
        }
    }
}
