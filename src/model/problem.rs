//! A planning problem.

use super::Scene;
use crate::geometry::Point;
use crate::space::{Configuration, GoalSet};

/// Where to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// These joint values.
    Joints(Configuration),
    /// Any configuration that puts the tip here.
    Tip(Point),
}

/// What a user asks: a scene, a start and a goal. The start lies within the joint limits and is free.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Arm and obstacles.
    pub scene: Scene,
    /// Where the arm is.
    pub start: Configuration,
    /// As asked.
    pub goal: Goal,
    /// The configurations that fulfil the goal and are within the limits, reaching any of which will do; at least one. Single
    /// ones are free; of a segment only a part may be.
    pub goals: GoalSet,
}
