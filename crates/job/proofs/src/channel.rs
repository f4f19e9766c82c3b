//! A chain of free boxes in which a path can be pulled taut.

use super::boxes::{Portal, portal};
use super::chain::{End, Mosaic, ends_in};
use cplan_model::space::{Configuration, Measure, Metric, Path, Segment};

/// A chain of adjacent free boxes. Boxes are convex, so a path that is straight between portals is free.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    start: Configuration,
    goals: Segment,
    /// Left and right end of each portal.
    portals: Vec<[Configuration; 2]>,
}

impl Channel {
    /// Creates the channel of a chain of boxes. The first box contains `start`, the last one contains goals.
    pub(super) fn new(boxes: &impl Mosaic, chain: &[u32], start: Configuration, ends: &[End]) -> Self {
        let topology = boxes.topology();
        // The shift that makes wrapped values continue from `start`.
        let mut lift = start - topology.wrap(start);
        let mut portals = Vec::with_capacity(chain.len());
        for pair in chain.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|i| boxes.cell(i));
            // Consecutive boxes share a side, so there is always a portal.
            let Some(Portal { left, right, shift }) = portal(&a, &b, topology) else { continue };
            portals.push([left + lift, right + lift]);
            lift += shift;
        }
        let last = portals.last().map_or(start, |[left, right]| (left + right) / 2.0);
        let goals = chain.last().into_iter().flat_map(|&index| ends_in(ends, index)).map(|part| part.shifted(lift));
        let euclid = |goals: &Segment| goals.distance(Measure::from(Metric::Euclidean), last);
        let nearest = goals.min_by(|a, b| euclid(a).total_cmp(&euclid(b)));
        Self { start, goals: nearest.unwrap_or(Segment::point(start)), portals }
    }

    /// Returns the path's start.
    pub fn start(&self) -> Configuration {
        self.start
    }

    /// Returns the goal segment in the last box that is nearest to the middle of the last portal, or to the start if there is no
    /// portal. With continuous joints, it may be a copy of a goal, shifted by whole turns.
    pub fn goals(&self) -> &Segment {
        &self.goals
    }

    /// Returns the portals in order: the pieces of sides that consecutive boxes share, in unwrapped values. As seen in the
    /// direction of passage in a plot of `q2` over `q1`, the first end of a portal is to the left and the second to the right.
    pub fn portals(&self) -> &[[Configuration; 2]] {
        &self.portals
    }

    /// Returns the path from the start, through the middles of the portals, to the goal segment.
    pub fn path(&self) -> Path {
        let middles = self.portals.iter().map(|[left, right]| (left + right) / 2.0);
        let mut places: Vec<Configuration> = std::iter::once(self.start).chain(middles).collect();
        places.push(self.goals.nearest(Measure::from(Metric::Euclidean), places[places.len() - 1]));
        Path::new(places)
    }
}
