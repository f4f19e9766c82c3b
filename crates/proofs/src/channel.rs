//! A chain of free boxes that contains paths.

use super::boxes::{Portal, portal};
use super::chain::{End, Mosaic, ends_in};
use cplan_core::space::{Configuration, Measure, Metric, Path, Segment};

/// A chain of adjacent free boxes. Each box is convex, so any path that runs straight from portal to portal is free.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    start: Configuration,
    goals: Segment,
    /// Left and right end of each portal.
    portals: Vec<[Configuration; 2]>,
}

impl Channel {
    /// Computes the portals of a chain of boxes. The last box contains goals.
    pub(super) fn new(boxes: &impl Mosaic, chain: &[u32], start: Configuration, ends: &[End]) -> Self {
        let topology = boxes.topology();
        // The shift from values in the fundamental domain to the turns of a path that continues from `start`.
        let mut lift = start - topology.wrap(start);
        let mut portals = Vec::with_capacity(chain.len());
        for pair in chain.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|i| boxes.cell(i));
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

    /// Returns its start.
    #[must_use]
    pub fn start(&self) -> Configuration {
        self.start
    }

    /// Returns the goals in its last box. On circles these may be copies of goals.
    #[must_use]
    pub fn goals(&self) -> &Segment {
        &self.goals
    }

    /// Returns the shared side pieces between its boxes, in order, in unwrapped values. Each consists of its left and
    /// its right end as seen in the direction of passage, with `q1` to the right and `q2` upwards.
    #[must_use]
    pub fn portals(&self) -> &[[Configuration; 2]] {
        &self.portals
    }

    /// Returns the path through the middles of the portals.
    #[must_use]
    pub fn path(&self) -> Path {
        let middles = self.portals.iter().map(|[left, right]| (left + right) / 2.0);
        let mut places: Vec<Configuration> = std::iter::once(self.start).chain(middles).collect();
        places.push(self.goals.nearest(Measure::from(Metric::Euclidean), places[places.len() - 1]));
        Path::new(places)
    }
}
