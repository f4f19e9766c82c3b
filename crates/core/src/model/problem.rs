//! A planning problem.

use super::Scene;
use super::scene_record::MotionRecord;
use crate::space::{Configuration, GoalSet};
use cplan_geometry::Point;
use serde::{Deserialize, Serialize};

/// A destination.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// These joint values.
    Joints(Configuration),
    /// Any configuration that puts the tip here.
    Tip(Point),
    /// Any configuration that puts the tip into this rectangle: lower left and upper right corner. For arms that do not
    /// slide along both axes only its middle counts ([`Goal::of_arm`]).
    Area([Point; 2]),
}

impl Goal {
    /// Returns the target place of the tip, for a rectangle its middle; `None` for joint values.
    #[must_use]
    pub fn tip(&self) -> Option<Point> {
        match self {
            Self::Joints(_) => None,
            Self::Tip(tip) => Some(*tip),
            Self::Area([low, high]) => Some((low + high) * 0.5),
        }
    }

    /// Returns the target place of the tip that is nearest to its present place; `None` for joint values.
    #[must_use]
    pub fn nearest_tip(&self, is: Point) -> Option<Point> {
        match self {
            Self::Area([low, high]) => Some(is.sup(low).inf(high)),
            goal => goal.tip(),
        }
    }
}

/// A defect of a scene, a start and goals.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MotionProblemError {
    /// The start lies outside a joint's limits, or is not a number.
    #[error("the start is outside the limits of joint \"{joint}\": {value}")]
    StartOutside {
        /// The joint's name in the URDF.
        joint: String,
        /// The joint's value, radians or metres.
        value: f64,
    },
    /// The arm meets an obstacle at the start, or is nearer to one than the clearance.
    #[error("the start is not free: {why}")]
    StartBlocked {
        /// The link, the obstacle, and the depth.
        why: String,
    },
    /// There is no goal.
    #[error("there is no goal")]
    NoGoal,
    /// A goal lies outside a joint's limits, or is not a number.
    #[error("goal {} is outside the limits of joint \"{joint}\": {value}", goal + 1)]
    GoalOutside {
        /// Number of the goal, from 0.
        goal: usize,
        /// The joint's name.
        joint: String,
        /// The joint's value, radians or metres.
        value: f64,
    },
    /// A goal that is a single configuration is not free.
    #[error("goal {} is not free: {why}", goal + 1)]
    GoalBlocked {
        /// Number of the goal, from 0.
        goal: usize,
        /// The link, the obstacle, and the depth.
        why: String,
    },
}

/// A user's query: a scene, a start, and alternative goals.
///
/// The start lies within the joint limits and is free. There is at least one goal; goals lie within the limits. Single
/// configurations among them are free; of a segment only a part may be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "MotionRecord", into = "MotionRecord")]
pub struct MotionProblem {
    scene: Scene,
    start: Configuration,
    goals: GoalSet,
}

impl MotionProblem {
    /// Creates a problem from a start to any of the goals: a configuration, a segment of them, or a set. `O(n)`
    /// distances in the scene's pairs for the start and for each goal.
    ///
    /// # Errors
    /// When the start or a goal is outside the limits or not free, or there is no goal.
    pub fn new(scene: Scene, start: Configuration, goals: impl Into<GoalSet>) -> Result<Self, MotionProblemError> {
        let goals = goals.into();
        let outside = |q: Configuration| {
            let joints = scene.arm().joints.iter().zip(q.iter());
            joints.filter(|(joint, value)| !joint.range.contains(**value)).map(|(j, v)| (j.name.clone(), *v)).next()
        };
        let blocked = |q: Configuration| scene.obstructions(q).first().map(|found| scene.explain(found));
        if let Some((joint, value)) = outside(start) {
            return Err(MotionProblemError::StartOutside { joint, value });
        }
        if let Some(why) = blocked(start) {
            return Err(MotionProblemError::StartBlocked { why });
        }
        if goals.is_empty() {
            return Err(MotionProblemError::NoGoal);
        }
        for (goal, piece) in goals.pieces().iter().enumerate() {
            let [from, to] = piece.ends();
            if let Some((joint, value)) = outside(from).or_else(|| outside(to)) {
                return Err(MotionProblemError::GoalOutside { goal, joint, value });
            }
            if let Some(why) = blocked(from).filter(|_| piece.is_point()) {
                return Err(MotionProblemError::GoalBlocked { goal, why });
            }
        }
        Ok(Self { scene, start, goals })
    }

    /// Creates a problem without checks. For a start and goals that are known to be valid, or that are never used.
    #[must_use]
    #[doc(hidden)]
    pub fn trusted(scene: Scene, start: Configuration, goals: impl Into<GoalSet>) -> Self {
        Self { scene, start, goals: goals.into() }
    }

    /// Returns arm and obstacles.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the scene without start and goals.
    #[must_use]
    pub fn into_scene(self) -> Scene {
        self.scene
    }

    /// Returns the arm's start configuration.
    #[must_use]
    pub fn start(&self) -> Configuration {
        self.start
    }

    /// Returns the alternative goals: reaching any of them is enough.
    #[must_use]
    pub fn goals(&self) -> &GoalSet {
        &self.goals
    }

    /// Gives access to the arm, to change its joints' limits on speed, acceleration, jerk and effort. Start and goals
    /// do not depend on them.
    pub fn arm_mut(&mut self) -> &mut super::Arm {
        self.scene.arm_mut()
    }
}
