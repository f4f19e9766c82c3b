//! A planning problem.

use super::scene_record::MotionRecord;
use super::{Elbow, Scene};
use crate::space::{Configuration, GoalSet};
use cplan_geometry::Point;
use serde::{Deserialize, Serialize};

/// A destination of the arm, as the user gives it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// A configuration.
    Joints(Configuration),
    /// A point for the tip, in plane coordinates, metres. Every configuration that puts the tip there is a goal.
    Tip(Point),
    /// A point for the tip, metres, with the elbow on a side. Only the configurations on that side are goals.
    TipAndElbow(Point, Elbow),
    /// A rectangle for the tip, given by its lower left and upper right corners, metres. For an arm that does not
    /// slide along both axes, only the rectangle's middle counts ([`Goal::of_arm`]).
    Area([Point; 2]),
}

impl Goal {
    /// Returns the place for the tip; for a rectangle this is its middle. `None` for joint values.
    pub fn tip(&self) -> Option<Point> {
        match self {
            Self::Joints(_) => None,
            Self::Tip(tip) | Self::TipAndElbow(tip, _) => Some(*tip),
            Self::Area([low, high]) => Some((low + high) * 0.5),
        }
    }

    /// Returns the required side of the elbow. `None` if any side will do.
    pub fn elbow(&self) -> Option<Elbow> {
        match self {
            Self::TipAndElbow(_, elbow) => Some(*elbow),
            Self::Joints(_) | Self::Tip(_) | Self::Area(_) => None,
        }
    }

    /// Returns the point for the tip that is nearest to `is`, the tip's present position. `None` for joint values.
    pub fn nearest_tip(&self, is: Point) -> Option<Point> {
        match self {
            Self::Area([low, high]) => Some(is.sup(low).inf(high)),
            goal => goal.tip(),
        }
    }
}

/// The reason why a scene, a start and goals do not form a valid problem.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MotionProblemError {
    /// The start lies outside a joint's limits, or is not a number.
    #[error("the start is outside the limits of {limit}: {value}")]
    StartOutside {
        /// The limit in words: `joint "elbow"`.
        limit: String,
        /// The limited value, radians or metres.
        value: f64,
    },
    /// The arm collides at the start, or is nearer to an obstacle than the clearance.
    #[error("the start is not free: {why}")]
    StartBlocked {
        /// The link, the obstacle, and the depth or distance, in words.
        why: String,
    },
    /// There is no goal.
    #[error("there is no goal")]
    NoGoal,
    /// A goal lies outside a joint's limits, or is not a number.
    #[error("goal {} is outside the limits of {limit}: {value}", goal + 1)]
    GoalOutside {
        /// Index of the goal, from 0.
        goal: usize,
        /// The limit in words.
        limit: String,
        /// The limited value, radians or metres.
        value: f64,
    },
    /// A goal that is a single configuration is not free: the arm collides, or is nearer to an obstacle than the
    /// clearance.
    #[error("goal {} is not free: {why}", goal + 1)]
    GoalBlocked {
        /// Index of the goal, from 0.
        goal: usize,
        /// The link, the obstacle, and the depth or distance, in words.
        why: String,
    },
}

/// A user's query: a scene, a start, and alternative goals.
///
/// The start lies within the joint limits and is free. There is at least one goal. Goals lie within the limits. A
/// goal that is a single configuration is free; of a segment, only a part may be free, or none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "MotionRecord")]
pub struct MotionProblem {
    scene: Scene,
    start: Configuration,
    goals: GoalSet,
}

impl MotionProblem {
    /// Creates a problem from a start and alternative goals, and checks it. For the start and for each goal it
    /// computes the distance of every pair in the scene.
    ///
    /// # Errors
    /// If the start or a goal is outside the limits or not free, or if there is no goal.
    pub fn new(scene: Scene, start: Configuration, goals: impl Into<GoalSet>) -> Result<Self, MotionProblemError> {
        let goals = goals.into();
        let topology = scene.arm().topology();
        let outside = |q: Configuration| {
            let limited = topology.violated_limit(q)?;
            Some((scene.arm().describe_limit(limited), topology.value(limited, q)))
        };
        let blocked = |q: Configuration| scene.obstructions(q).first().map(|found| scene.explain(found));
        if let Some((limit, value)) = outside(start) {
            return Err(MotionProblemError::StartOutside { limit, value });
        }
        if let Some(why) = blocked(start) {
            return Err(MotionProblemError::StartBlocked { why });
        }
        if goals.is_empty() {
            return Err(MotionProblemError::NoGoal);
        }
        for (goal, piece) in goals.pieces().iter().enumerate() {
            let [from, to] = piece.ends();
            if let Some((limit, value)) = outside(from).or_else(|| outside(to)) {
                return Err(MotionProblemError::GoalOutside { goal, limit, value });
            }
            if let Some(why) = blocked(from).filter(|_| piece.is_point()) {
                return Err(MotionProblemError::GoalBlocked { goal, why });
            }
        }
        Ok(Self { scene, start, goals })
    }

    /// Creates a problem without checks. The start and the goals must be known to be valid, or never be used.
    #[doc(hidden)]
    pub fn trusted(scene: Scene, start: Configuration, goals: impl Into<GoalSet>) -> Self {
        Self { scene, start, goals: goals.into() }
    }

    /// Returns the arm and its obstacles.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the scene without start and goals.
    pub fn into_scene(self) -> Scene {
        self.scene
    }

    /// Returns the arm's start configuration.
    pub fn start(&self) -> Configuration {
        self.start
    }

    /// Returns the goals. A path must reach one of them.
    pub fn goals(&self) -> &GoalSet {
        &self.goals
    }

    /// Returns mutable access to the arm, to change its joints' limits on speed, acceleration, jerk and effort.
    /// Start and goals do not depend on these.
    pub fn arm_mut(&mut self) -> &mut super::Arm {
        self.scene.arm_mut()
    }
}
