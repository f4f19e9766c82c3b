//! A chain of free boxes, as a way to go.

use super::boxes::Door;
use super::chain::Mosaic;
use crate::space::{Configuration, Path};

/// A chain of adjacent free boxes. Each is convex, so any way that goes straight from door to door is free.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    start: Configuration,
    goal: Configuration,
    /// Left and right end of each door.
    doors: Vec<[Configuration; 2]>,
}

impl Channel {
    /// The doors of a chain of boxes, the last of which holds one of the goals.
    pub(super) fn new(boxes: &impl Mosaic, chain: &[u32], start: Configuration, goals: &[Configuration]) -> Self {
        let topology = boxes.topology();
        // What to add to values in the fundamental domain to continue the way from `start`.
        let mut lift = start - topology.wrap(start);
        let mut doors = Vec::with_capacity(chain.len());
        for pair in chain.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|i| boxes.cell(i));
            let Some(Door { left, right, shift }) = a.door(&b, topology) else { continue };
            doors.push([left + lift, right + lift]);
            lift += shift;
        }
        let last = chain.last().map(|&i| boxes.cell(i));
        let goal = goals.iter().map(|&g| topology.wrap(g)).find(|&g| last.is_some_and(|cell| cell.contains(g)));
        Self { start, goal: goal.map_or(start, |g| g + lift), doors }
    }

    /// Where it begins.
    #[must_use]
    pub fn start(&self) -> Configuration {
        self.start
    }

    /// Where it ends: a goal, or on circles a copy of one.
    #[must_use]
    pub fn goal(&self) -> Configuration {
        self.goal
    }

    /// The pieces of side between its boxes, in order, in unwrapped values: the ends to the left and to the right hand
    /// of who passes (seen with `q1` to the right and `q2` upwards).
    #[must_use]
    pub fn doors(&self) -> &[[Configuration; 2]] {
        &self.doors
    }

    /// The path through the middles of the doors.
    #[must_use]
    pub fn path(&self) -> Path {
        let middles = self.doors.iter().map(|[left, right]| (left + right) / 2.0);
        Path::new(std::iter::once(self.start).chain(middles).chain([self.goal]).collect())
    }
}
