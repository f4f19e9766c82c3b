//! What closes motions that are shorter than a bound: evidence for a checker.
//!
//! The evidence is a set of straight segments of configurations, each with the pair of shapes that is too near all along it:
//! *walls* on slices, where joint 1 stays at one value, and *barriers* across the strips between two slices. No motion crosses
//! any of them, so none is shorter than the shortest way past all of them. Each segment is looked at again, apart from the search that
//! found it (`held`: depths from the Minkowski difference, one after the other, each of which covers a part of the segment), and cut to
//! what is seen closed. The checker of certificates judges the segments in exact arithmetic.

mod held;

use cplan_core::model::{Pair, Scene};
use cplan_core::space::Configuration;
use cplan_interrupt::checkpoint;
use held::held;

/// Values of joint 2 at a slice that a pair closes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wall {
    /// The least, ...
    pub lower: f64,
    /// ... and the greatest; on a circle beyond its domain, if the wall leads across the seam.
    pub upper: f64,
    /// Which shapes are too near there.
    pub pair: Pair,
}

/// A straight line across the strip between a slice and the next that a pair closes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Barrier {
    /// Its values of joint 2 at the slice before and at the slice after.
    pub ends: [f64; 2],
    /// Which shapes are too near all along it.
    pub pair: Pair,
}

/// A value of joint 1, and what is closed there and in the strip up to the next slice. On a circle the first slice follows the last.
#[derive(Debug, Clone)]
pub(crate) struct Slice {
    /// The value of joint 1.
    pub q1: f64,
    /// What is closed at it.
    pub walls: Vec<Wall>,
    /// What is closed across the strip after it.
    pub barriers: Vec<Barrier>,
}

/// A straight segment of configurations along all of which a pair is seen too near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedSegment {
    /// Its ends; on a circle beyond its domain, if it leads across the seam.
    pub ends: [Configuration; 2],
    /// Which shapes are too near.
    pub pair: Pair,
}

/// What a search for a lower bound found closed. [`bound_evidence`](crate::bound_evidence) finds it.
#[derive(Debug, Clone)]
pub struct BoundEvidence {
    /// Ascending, all over the domain of joint 1; its ends are slices if it has ends.
    pub(crate) slices: Vec<Slice>,
}

/// How much farther inside barriers may be than they were found, either way, radians or metres.
const INSIDE: [f64; 9] = [0.0, 1e-7, -1e-7, 1e-6, -1e-6, 1e-5, -1e-5, 1e-4, -1e-4];

/// By how much barriers and walls go past a seam, radians, so that they overlap what goes on beyond it, however that is rounded.
const SEAM: f64 = 1e-7;

impl BoundEvidence {
    /// Returns the walls as far as they are seen closed, and the barriers that are, with so many looks along each in either direction.
    /// Barriers lie a little farther inside what is closed, where they hardly are. What ends at a seam goes a little past it.
    #[must_use]
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
                None if circle => (self.slices[0].q1 + std::f64::consts::TAU) + SEAM,
                None => continue,
            };
            for barrier in &slice.barriers {
                let at = |inside: f64| {
                    let [from, to] = barrier.ends;
                    [Configuration::new(slice.q1, from + inside), Configuration::new(next, to + inside)]
                };
                let ends = INSIDE.into_iter().map(at).find(|ends| seen(*ends, barrier.pair) == [0.0, 1.0]);
                closed.extend(ends.map(|ends| ClosedSegment { ends, pair: barrier.pair }));
            }
        }
        closed
    }
}

/// The ends of a wall, a little farther where it ends at a seam.
fn past_seam(scene: &Scene, wall: &Wall) -> [f64; 2] {
    let range = scene.arm().topology().ranges[1];
    let (lower, upper) = range.domain();
    let by = |is_there: bool| if range.is_circle() && is_there { SEAM } else { 0.0 };
    [wall.lower - by(wall.lower <= lower), wall.upper + by(wall.upper >= upper)]
}
