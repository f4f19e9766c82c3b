//! Links of the robot that are obstacles for its other links.

use super::Obstacle;
use super::obstacle::Outline;
use crate::domain::Range;
use crate::interval::Interval;
use crate::overlap::Shape;

/// A link of the robot that is an obstacle for others.
#[derive(Clone)]
pub struct Owner {
    /// Its name.
    pub link: String,
    /// Whether joint 1 carries it. Then its place is that with joint 1 at zero, and so is that of what can meet it.
    pub is_carried: bool,
}

impl Obstacle {
    /// Makes an obstacle of a link.
    pub fn link(name: String, owner: Owner, shape: Shape, heights: Option<Range>) -> Self {
        let [at, turn] = [[0, 0], [0, 1]].map(|of| of.map(Interval::whole));
        Self { name: Some(name), own: Some(owner), outline: Outline::Own(shape), at, turn, heights, course: None }
    }

    /// Whether joint 1 carries it.
    pub fn is_carried(&self) -> bool {
        self.own.as_ref().is_some_and(|own| own.is_carried)
    }

    /// Returns its name for messages.
    pub fn called(&self, number: usize) -> String {
        match (&self.own, &self.name) {
            (Some(_), Some(name)) => name.clone(),
            _ => format!("obstacle {number}"),
        }
    }
}
