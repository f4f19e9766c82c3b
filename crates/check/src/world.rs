//! What stands around the arm, and what is asked.

use crate::decimal::Decimal;
use crate::domain::Range;
use crate::obstacle::Obstacle;
use crate::polygon::Corner;

/// What stands around the arm, and what is asked.
#[derive(Default)]
pub struct World {
    /// Where the arm is, if the world says it.
    pub start: Option<Goal>,
    /// Where the arm is to go, if the world says it.
    pub goal: Option<Goal>,
    /// How far the arm keeps from obstacles, metres.
    pub clearance: Decimal,
    /// Obstacles that stand: those of the file, then the map's walls, then the objects where they lie at first, or move.
    pub obstacles: Vec<Obstacle>,
    /// Obstacles of the file that move.
    pub movers: Vec<Obstacle>,
}

/// Where the arm is, or is to go.
#[derive(Clone)]
pub enum Goal {
    /// Values of the joints.
    Joints([Range; 2]),
    /// A place of the tip, in whatever configuration.
    Tip(Corner),
    /// Rectangles of the tip by opposite corners, any of which will do.
    Areas(Vec<[Corner; 2]>),
}

impl World {
    /// All obstacles, those that move last.
    pub fn all(&self) -> impl Iterator<Item = &Obstacle> {
        self.obstacles.iter().chain(&self.movers)
    }
}
