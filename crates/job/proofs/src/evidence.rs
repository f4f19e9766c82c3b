//! Evidence that no motion is shorter than a bound, for a checker.
//!
//! The evidence is a set of straight segments in joint space. All along a segment, a pair of shapes is too near. *Walls* are
//! segments at a single value of joint 1, a slice; *barriers* cross the strip between two slices. No motion crosses a segment, so
//! no motion is shorter than the shortest path around all segments.
//!
//! Each segment is tested again, independently of the search, and cut to its proven part. The test (`held`) computes overlap
//! depths from the Minkowski difference, step by step along the segment. The checker of certificates tests the segments in exact
//! arithmetic.

mod blocked_part;

use blocked_part::held;
use cplan_interrupt::checkpoint;
use cplan_model::space::Configuration;
use cplan_model::{Pair, Scene};

/// An interval of joint 2 on a slice in which a pair of shapes collides.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wall {
    /// Least value of joint 2.
    pub lower: f64,
    /// Greatest value of joint 2. With a continuous joint, it is beyond the domain if the wall crosses the seam.
    pub upper: f64,
    /// The pair that is too near.
    pub pair: Pair,
}

/// A straight line across the strip between two slices, all along which a pair collides.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Barrier {
    /// Values of joint 2 on the slice before and on the slice after.
    pub ends: [f64; 2],
    /// The pair that is too near.
    pub pair: Pair,
}

/// A value of joint 1, its walls, and the barriers between it and the next slice. With a continuous joint 1, the first slice
/// follows the last.
#[derive(Debug, Clone)]
pub(crate) struct Slice {
    /// Value of joint 1.
    pub q1: f64,
    /// Walls on the slice.
    pub walls: Vec<Wall>,
    /// Barriers across the strip after the slice.
    pub barriers: Vec<Barrier>,
}

/// A straight segment of configurations along which a pair is proven too near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedSegment {
    /// Ends of the segment. With a continuous joint, they may be beyond the domain, if the segment crosses its seam.
    pub ends: [Configuration; 2],
    /// The pair that is too near.
    pub pair: Pair,
}

/// Walls and barriers from a search for a lower bound; see [`bound_evidence`](crate::bound_evidence).
#[derive(Debug, Clone)]
pub struct BoundEvidence {
    /// Slices, ascending, over the whole domain of joint 1, including its limits if it has any.
    pub(crate) slices: Vec<Slice>,
}

/// If a barrier cannot be proven, it is shifted along `q2` by these values, radians or metres, one after the other.
const BARRIER_SHIFTS: [f64; 9] = [0.0, 1e-7, -1e-7, 1e-6, -1e-6, 1e-5, -1e-5, 1e-4, -1e-4];

/// Length by which barriers and walls are extended beyond a seam, radians, so that they overlap their continuation despite
/// rounding.
const SEAM_OVERLAP: f64 = 1e-7;

impl BoundEvidence {
    /// Returns the proven parts of walls, and the proven barriers. A segment is tested at up to `looks` places in either
    /// direction from its middle. A barrier whose shapes barely overlap may be shifted slightly. Segments that end at a seam are
    /// extended slightly beyond it.
    pub fn segments(&self, scene: &Scene, clearance: f64, looks: usize) -> Vec<ClosedSegment> {
        let (scene, mut closed) = (&*scene.inner(), Vec::new());
        let seen = |ends: [Configuration; 2], pair: Pair| {
            checkpoint();
            held(scene, pair, ends, clearance, looks)
        };
        let circle = scene.arm().topology().ranges[0].is_circle();
        for (number, slice) in self.slices.iter().enumerate() {
            for wall in &slice.walls {
                let ends = past_seam(scene, wall).map(|q2| Configuration::new(slice.q1, q2));
                let [from, to] = seen(ends, wall.pair);
                let at = |share: f64| if share == 1.0 { ends[1] } else { ends[0] + (ends[1] - ends[0]) * share };
                if from < to {
                    closed.push(ClosedSegment { ends: [at(from), at(to)], pair: wall.pair });
                }
            }
            let next = match self.slices.get(number + 1) {
                Some(next) => next.q1,
                None if circle => (self.slices[0].q1 + std::f64::consts::TAU) + SEAM_OVERLAP,
                None => continue,
            };
            for barrier in &slice.barriers {
                let at = |inside: f64| {
                    let [from, to] = barrier.ends;
                    [Configuration::new(slice.q1, from + inside), Configuration::new(next, to + inside)]
                };
                let ends = BARRIER_SHIFTS.into_iter().map(at).find(|ends| seen(*ends, barrier.pair) == [0.0, 1.0]);
                closed.extend(ends.map(|ends| ClosedSegment { ends, pair: barrier.pair }));
            }
        }
        closed
    }
}

/// Returns the ends of a wall, extended slightly if it ends at a seam.
fn past_seam(scene: &Scene, wall: &Wall) -> [f64; 2] {
    let range = scene.arm().topology().ranges[1];
    let (lower, upper) = range.domain();
    let by = |is_there: bool| if range.is_circle() && is_there { SEAM_OVERLAP } else { 0.0 };
    [wall.lower - by(wall.lower <= lower), wall.upper + by(wall.upper >= upper)]
}
