//! Links of the robot that are obstacles for its other links.

use super::Obstacle;
use super::obstacle::Outline;
use crate::domain::Range;
use crate::interval::Interval;
use crate::overlap::Shape;

impl Obstacle {
    /// Makes an obstacle of a link that stands still.
    pub fn link(name: String, link: String, shape: Shape, heights: Option<Range>) -> Self {
        let [at, turn] = [[0, 0], [0, 1]].map(|of| of.map(Interval::whole));
        Self { name: Some(name), own: Some(link), outline: Outline::Own(shape), at, turn, heights, course: None }
    }

    /// Returns its name for messages.
    pub fn called(&self, number: usize) -> String {
        match (&self.own, &self.name) {
            (Some(_), Some(name)) => name.clone(),
            _ => format!("obstacle {number}"),
        }
    }
}
