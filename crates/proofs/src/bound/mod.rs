//! Lower bounds on the length of motions, checked without trusting who found them.
//!
//! The evidence is a set of straight segments of configurations, each with the pair of shapes that is too near all along it:
//! *walls* on slices, where joint 1 stays at one value, and *barriers* across the strips between two slices. No motion crosses
//! any of them, so none is shorter than the shortest way past all of them. The check looks along every segment for itself
//! (`held`: depths from the Minkowski difference, one after the other, each of which covers a part of the segment), takes
//! of a wall what it could see closed, and looks for the shortest way itself (`cover`, `ways`: from each end of a wall
//! to all that it sees). It shares no code with the search that found the evidence, but for the kernels of geometry and
//! [`cplan_core::check::Deviation`].

mod cover;
mod held;
mod ways;

use cover::{Cover, HeldSlice};
use cplan_core::model::{Pair, Scene};
use cplan_core::space::{Configuration, GoalSet, JointRange, Measure, Metric, Segment};
use cplan_interrupt::checkpoint;
use held::{MOST_LOOKS, held};

/// Values of joint 2 at a slice that a pair closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// The least, ...
    pub lower: f64,
    /// ... and the greatest; on a circle beyond its domain, if the wall leads across the seam.
    pub upper: f64,
    /// Which shapes are too near there.
    pub pair: Pair,
}

/// A straight line across the strip between a slice and the next that a pair closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Barrier {
    /// Its values of joint 2 at the slice before and at the slice after.
    pub ends: [f64; 2],
    /// Which shapes are too near all along it.
    pub pair: Pair,
}

/// A value of joint 1, and what is closed there and in the strip up to the next slice. On a circle the first slice follows the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
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

/// The claim that no motion is shorter, with what closes shorter ways.
#[derive(Debug, Clone, PartialEq)]
pub struct LengthClaim {
    /// Ascending, all over the domain of joint 1; its ends are slices if it has ends.
    pub slices: Vec<Slice>,
    /// Slices that count for the goals at their value of joint 1 alone, of which they leave some out.
    pub goal_slices: Vec<Slice>,
    /// No motion is claimed to be shorter.
    pub length: f64,
}

/// A lower bound on the length of all motions from a start to any of some goals. Only [`LengthClaim::checked`] makes one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheckedBound {
    length: f64,
    slices: usize,
    refused: usize,
}

impl CheckedBound {
    /// No motion is shorter: proven. The length claimed, or less, where the check saw less closed than was claimed.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// How many slices bear it out.
    #[must_use]
    pub fn slices(&self) -> usize {
        self.slices
    }

    /// How many of the claimed walls and barriers the check could not see closed; it did without them.
    #[must_use]
    pub fn refused(&self) -> usize {
        self.refused
    }
}

/// What rounding may add to a length, as a share of it, and as a share of the greatest coordinate: sums of some hundred
/// legs, and places a hair apart.
const ROUNDING: [f64; 2] = [1e-9, 1e-12];

/// How much farther inside barriers may be than they were found, either way, radians or metres.
const INSIDE: [f64; 9] = [0.0, 1e-7, -1e-7, 1e-6, -1e-6, 1e-5, -1e-5, 1e-4, -1e-4];

/// By how much barriers and walls go past a seam, radians, so that they overlap what goes on beyond it, however that is rounded.
const SEAM: f64 = 1e-7;

impl LengthClaim {
    /// The walls as far as they are seen closed, and the barriers that are, with so many looks along each in either direction: barriers a
    /// little farther inside what is closed, where they hardly are. What ends at a seam goes a little past it.
    #[must_use]
    pub fn closed(&self, scene: &Scene, clearance: f64, looks: usize) -> Vec<ClosedSegment> {
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

    /// Checks the claim, wherever it comes from: what of it is true, which may be a lower bound that is lower. Some hundred
    /// looks at a pair of shapes for each wall, and ways from each end of a wall that shorter ways come by: tenths of a second
    /// for a claim that took milliseconds to find.
    #[must_use]
    pub fn checked(
        &self,
        scene: &Scene,
        start: Configuration,
        goals: &GoalSet,
        clearance: f64,
        metric: Metric,
    ) -> CheckedBound {
        let (scene, topology) = (&*scene.inner(), scene.arm().topology());
        let mut refused = 0;
        let mut slices: Vec<HeldSlice> = Vec::new();
        for slice in &self.slices {
            let is_next = slices.last().is_none_or(|last: &HeldSlice| last.q1 < slice.q1);
            if !(topology.ranges[0].contains(slice.q1) && is_next) {
                refused += 1;
                continue;
            }
            slices.push(held_slice(scene, slice, clearance, &mut refused));
        }
        let count = if slices.len() == self.slices.len() { slices.len() } else { 0 };
        for (number, slice) in self.slices.iter().enumerate().take(count) {
            let next = (number + 1) % count;
            let beyond = if next == 0 { std::f64::consts::TAU } else { 0.0 };
            if next == 0 && !topology.ranges[0].is_circle() {
                continue;
            }
            for barrier in &slice.barriers {
                checkpoint();
                let ends = [slice.q1, self.slices[next].q1 + beyond];
                let [from, to] = [0, 1].map(|k| Configuration::new(ends[k], barrier.ends[k]));
                if held(scene, barrier.pair, [from, to], clearance, MOST_LOOKS) == [0.0, 1.0] {
                    slices[number].barriers.push(barrier.ends);
                } else {
                    refused += 1;
                }
            }
        }
        if !spans(topology.ranges[0], &slices) {
            slices.clear();
        }
        let measure = Measure::from(metric);
        let from = topology.wrap(start);
        let mut pieces: Vec<Segment> = goals.wrapped(&topology).collect();
        for slice in &self.goal_slices {
            let slice = held_slice(scene, slice, clearance, &mut refused);
            pieces = pieces.iter().flat_map(|piece| slice.leaves(&topology, piece)).collect();
        }
        let largest = pieces.iter().flat_map(Segment::ends).chain([from]).map(|q| q.amax()).fold(0.0, f64::max);
        let seen = slices.len();
        let cover = Cover::new(&topology, slices, measure, from, &pieces, self.length);
        let length = ways::shortest(&cover, measure, from, self.length);
        let rounding = f64::max(length * ROUNDING[0], (largest + self.length) * ROUNDING[1]);
        CheckedBound { length: (length - rounding).max(0.0), slices: seen, refused }
    }
}

/// The ends of a wall, a little farther where it ends at a seam.
fn past_seam(scene: &Scene, wall: &Wall) -> [f64; 2] {
    let range = scene.arm().topology().ranges[1];
    let (lower, upper) = range.domain();
    let by = |is_there: bool| if range.is_circle() && is_there { SEAM } else { 0.0 };
    [wall.lower - by(wall.lower <= lower), wall.upper + by(wall.upper >= upper)]
}

/// Whether slices reach from end to end of a domain that has ends: or else ways could lead round them.
fn spans(range: JointRange, slices: &[HeldSlice]) -> bool {
    let ends = [slices.first(), slices.last()].map(|slice| slice.map(|slice| slice.q1));
    range.is_circle() || ends == [Some(range.domain().0), Some(range.domain().1)]
}

/// The walls of a slice as far as they are seen closed.
fn held_slice(scene: &Scene, slice: &Slice, clearance: f64, refused: &mut usize) -> HeldSlice {
    let mut walls = Vec::with_capacity(slice.walls.len());
    for wall in &slice.walls {
        checkpoint();
        let ends = [wall.lower, wall.upper].map(|q2| Configuration::new(slice.q1, q2));
        let [from, to] = held(scene, wall.pair, ends, clearance, MOST_LOOKS);
        let at = |share: f64| if share == 1.0 { wall.upper } else { wall.lower + (wall.upper - wall.lower) * share };
        // A wall of no width, or the wrong way round, closes nothing.
        if from < to && wall.lower < wall.upper { walls.push([at(from), at(to)]) } else { *refused += 1 }
    }
    HeldSlice::new(&scene.arm().topology(), slice.q1, &walls)
}
