//! The world around the arm, and the start and goal of the query.

use crate::decimal::Decimal;
use crate::domain::Range;
use crate::elbow::Elbow;
use crate::obstacle::Obstacle;
use crate::polygon::Corner;

/// The world around the arm, and the start and goal of the query.
#[derive(Default)]
pub struct World {
    /// Start of the arm, if the world file states one.
    pub start: Option<Goal>,
    /// Goal of the arm, if the world file states one.
    pub goal: Option<Goal>,
    /// Required distance between the arm and obstacles, metres.
    pub clearance: Decimal,
    /// Obstacles without a motion of their own, in this order: those of the file, the map's walls, and the objects at
    /// their initial poses.
    pub obstacles: Vec<Obstacle>,
    /// Moving obstacles of the file.
    pub movers: Vec<Obstacle>,
}

/// A start or a goal of the arm.
#[derive(Clone)]
pub enum Goal {
    /// Joint values.
    Joints([Range; 2]),
    /// A tip position. Every configuration with the tip there, and with the elbow on the stated side, satisfies the goal.
    Tip(Corner, Option<Elbow>),
    /// Rectangles for the tip, given by opposite corners. A tip in any of them satisfies the goal.
    Areas(Vec<[Corner; 2]>),
}

impl World {
    /// Iterates over all obstacles, moving obstacles last.
    pub fn all(&self) -> impl Iterator<Item = &Obstacle> {
        self.obstacles.iter().chain(&self.movers)
    }
}
