//! Straight segments of configurations.

use super::{Configuration, Measure};
use cplan_geometry::{Orientation, Point, cross, orientation};
use serde::{Deserialize, Serialize};

/// A straight line between two configurations, both included; a single configuration if they are equal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[Configuration; 2]", into = "[Configuration; 2]")]
pub struct Segment {
    from: Configuration,
    to: Configuration,
}

impl Segment {
    /// Creates the segment between two configurations, both included.
    pub fn new(from: Configuration, to: Configuration) -> Self {
        Self { from, to }
    }

    /// Creates a segment of a single configuration.
    pub fn point(q: Configuration) -> Self {
        Self { from: q, to: q }
    }

    /// Returns the two ends.
    pub fn ends(&self) -> [Configuration; 2] {
        [self.from, self.to]
    }

    /// Returns true if the segment is a single configuration.
    pub fn is_point(&self) -> bool {
        self.from == self.to
    }

    /// Returns the Euclidean length in joint space.
    pub fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    /// Returns the configuration at a fraction of the segment, 0 at the first end and 1 at the second. A coordinate
    /// that is equal at both ends stays exactly equal.
    pub fn at(&self, share: f64) -> Configuration {
        match share {
            _ if share <= 0.0 => self.from,
            _ if share >= 1.0 => self.to,
            _ => self.from + (self.to - self.from) * share,
        }
    }

    /// Returns the segment moved by a displacement.
    #[must_use]
    pub fn shifted(&self, by: Configuration) -> Self {
        Self { from: self.from + by, to: self.to + by }
    }

    /// Returns the part on which an affine function is not negative, given its values at the two ends; `None` if
    /// there is none.
    #[must_use]
    pub fn where_positive(&self, at_from: f64, at_to: f64) -> Option<Self> {
        let share = at_from / (at_from - at_to);
        match (at_from >= 0.0, at_to >= 0.0) {
            (true, true) => Some(*self),
            (false, false) => None,
            (true, false) => Some(Self { to: self.at(share), ..*self }),
            (false, true) => Some(Self { from: self.at(share), ..*self }),
        }
    }

    /// Returns the part on or to the left of the directed line from `a` to `b`; `None` if all of it is to the right.
    #[must_use]
    pub fn left_of(&self, a: Point, b: Point) -> Option<Self> {
        let [from, to] = self.ends().map(|p| cross(b - a, p - a));
        self.where_positive(from, to)
    }

    /// Returns the part in a convex polygon with these corners, counter-clockwise; `None` if that part is empty.
    #[must_use]
    pub fn within_polygon(&self, corners: &[Point]) -> Option<Self> {
        let n = corners.len();
        (0..n).try_fold(*self, |part, k| part.left_of(corners[k], corners[(k + 1) % n]))
    }

    /// Returns the part in a box, which may have infinite sides; `None` if that part is empty.
    #[must_use]
    pub fn within(&self, lower: [f64; 2], upper: [f64; 2]) -> Option<Self> {
        (0..2).try_fold(*self, |part, k| {
            let above = part.where_positive(part.from[k] - lower[k], part.to[k] - lower[k])?;
            above.where_positive(upper[k] - above.from[k], upper[k] - above.to[k])
        })
    }

    /// Returns true if the segment and a box have a point in common, sides included. Exact.
    pub fn meets(&self, lower: [f64; 2], upper: [f64; 2]) -> bool {
        let overlaps = |k: usize| {
            let (least, greatest) = (self.from[k].min(self.to[k]), self.from[k].max(self.to[k]));
            least <= upper[k] && lower[k] <= greatest
        };
        if !(overlaps(0) && overlaps(1)) {
            return false;
        }
        if self.from[0] == self.to[0] || self.from[1] == self.to[1] {
            return true;
        }
        // Both ranges overlap, and the segment is slanted. It misses the box exactly if all corners lie strictly on
        // one side.
        let [a, b] = self.ends();
        let sides = [[lower[0], lower[1]], [upper[0], lower[1]], [upper[0], upper[1]], [lower[0], upper[1]]]
            .map(|[x, y]| orientation(a, b, Point::new(x, y)));
        [Orientation::Clockwise, Orientation::CounterClockwise].iter().all(|side| sides.iter().any(|s| s != side))
    }

    /// Returns the configuration of the segment nearest to `p`, up to rounding; the first if several are equally
    /// near.
    pub fn nearest(&self, measure: Measure, p: Configuration) -> Configuration {
        if self.is_point() {
            return self.from;
        }
        let displacement = self.to - self.from;
        let there = p - self.from;
        let foot = measure.product(there, displacement) / measure.product(displacement, displacement);
        let Measure::Polygon { weights: [u, v], sum } = measure else { return self.at(foot) };
        // The maximum of some terms is least at an end of the segment, where one term vanishes, or where two are
        // equal.
        let share = |rate: f64, value: f64| if rate == 0.0 { 0.0 } else { value / rate };
        let shares = [
            foot,
            0.0,
            1.0,
            share(displacement[0], there[0]),
            share(displacement[1], there[1]),
            share(u * displacement[0] - v * displacement[1], u * there[0] - v * there[1]),
            share(u * displacement[0] + v * displacement[1], u * there[0] + v * there[1]),
        ];
        let of_sum = |[a, b]: [f64; 2]| {
            let along = |d: Configuration| a * d[0] + b * d[1];
            let term = |x: f64, y: f64| {
                let of = |d: Configuration| along(d) + x * d[0] + y * d[1];
                share(of(displacement), of(there))
            };
            [term(0.0, 0.0), term(u, 0.0), term(-u, 0.0), term(0.0, v), term(0.0, -v)]
        };
        let shares = shares.into_iter().chain(sum.map(of_sum).into_iter().flatten());
        let better = |best: Configuration, next: Configuration| {
            if measure.norm(next - p) < measure.norm(best - p) { next } else { best }
        };
        shares.map(|share| self.at(share)).reduce(better).unwrap_or(self.from)
    }

    /// Returns the length of the shortest displacement from `p` to the segment.
    pub fn distance(&self, measure: Measure, p: Configuration) -> f64 {
        measure.norm(self.nearest(measure, p) - p)
    }
}

impl From<[Configuration; 2]> for Segment {
    fn from([from, to]: [Configuration; 2]) -> Self {
        Self { from, to }
    }
}

impl From<Segment> for [Configuration; 2] {
    fn from(segment: Segment) -> Self {
        segment.ends()
    }
}

impl From<Configuration> for Segment {
    fn from(q: Configuration) -> Self {
        Self::point(q)
    }
}
