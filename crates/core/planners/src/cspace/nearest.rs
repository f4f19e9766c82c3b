//! Finds the free configuration nearest to one that is not free.

use super::slices::Slice;
use cplan_geometry::ROUNDING;
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Contacts, Scene};
use std::f64::consts::{PI, TAU};

/// The free configuration that a search found, with its distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestFree {
    /// The configuration, within the limits. On a circle, it is the copy nearest to the given configuration.
    pub configuration: Configuration,
    /// Euclidean distance in joint space, with radians and metres as numbers.
    pub distance: f64,
    /// Least distance between arm and obstacles at that configuration, metres. It is positive, and at least the
    /// workspace's clearance. Infinite if no obstacle is within reach.
    pub clearance: f64,
    /// Distance between neighbouring slices of the search, in units of joint 1, see [`nearest_free`].
    pub spacing: f64,
}

/// Number of slices over the range of joint 1, or over one turn if the range is longer.
const SLICES_PER_TURN: f64 = 4096.0;
/// Largest number of local minima that are refined, best first.
const MAX_REFINED_MINIMA: usize = 8;
/// Distance between slices, in units of joint 1, at which the refinement ends.
const MIN_SLICE_DISTANCE: f64 = 1e-10;
/// Number of slices on either side of the best one in each step of the refinement.
const SLICES_PER_SIDE: i32 = 8;

/// Returns the free configuration nearest to `q` in joint space. The distance is Euclidean, along the shorter direction
/// on circles. Returns `None` if no slice has a free configuration. `O(slices * pairs)`.
///
/// The slices are at values of joint 1 that are [`NearestFree::spacing`] apart, starting at `q`, and at the ends of
/// the intervals that link 1 forbids. In each slice the nearest free value of joint 2 is exact. The slices around
/// the best local minima are then refined to 1e-10 rad or m.
///
/// The scene's own distances confirm that the result is free. No free configuration on an examined slice is nearer. A
/// nearer one can only lie between two slices.
pub fn nearest_free(scene: &Scene, q: Configuration) -> Option<NearestFree> {
    Search::new(scene, q).run()
}

struct Search<'a> {
    scene: &'a Scene,
    slices: Contacts<'a>,
    /// The values of joint 1 that link 1 forbids, within the axis's domain.
    bands: Slice,
    slice: Slice,
    from: Configuration,
    /// Growth of obstacles, metres. It ensures that the free part of a slice is truly free, despite rounding.
    grow: f64,
    best: Option<NearestFree>,
    spacing: f64,
}

impl<'a> Search<'a> {
    fn new(scene: &'a Scene, from: Configuration) -> Self {
        let grow = scene.workspace().clearance + 2.0 * ROUNDING;
        let slices = Contacts::new(scene);
        let bands = Slice::bands(&slices, grow);
        let first = &scene.arm().joints[0];
        let extent = first.range.extent();
        let spacing = if first.joint_type.is_revolute() { extent.min(TAU) } else { extent } / SLICES_PER_TURN;
        Self { scene, slices, bands, slice: Slice::default(), from, grow, best: None, spacing }
    }

    fn run(mut self) -> Option<NearestFree> {
        let first = &self.scene.arm().joints[0];
        let start = match first.range {
            JointRange::Interval { lower, upper } => self.from[0].clamp(lower, upper),
            JointRange::Circle => self.from[0],
        };
        // Slices farther than this from the start repeat others.
        let farthest = match first.range {
            JointRange::Circle => PI,
            JointRange::Interval { .. } if first.joint_type.is_revolute() => TAU,
            axis @ JointRange::Interval { .. } => axis.extent(),
        };
        let mut samples = Vec::new();
        let ends: Vec<f64> = self.bands.merged.iter().flatten().copied().collect();
        for end in ends {
            let q1 = first.range.lift(end, start);
            samples.extend(self.distance_at(q1).map(|distance| (q1, distance)));
        }
        for k in 0.. {
            let step = f64::from(k) * self.spacing;
            let nearer = |best: NearestFree| (start - self.from[0]).abs() + step < best.distance;
            if step > farthest || !self.best.is_none_or(nearer) {
                break;
            }
            for q1 in [start + step, start - step] {
                samples.extend(self.distance_at(q1).map(|distance| (q1, distance)));
            }
            if self.spacing == 0.0 {
                break;
            }
        }
        for q1 in minima(samples) {
            self.refine(q1);
        }
        self.best
    }

    /// Examines slices on both sides of a slice, at decreasing distances.
    fn refine(&mut self, q1: f64) {
        let (mut middle, mut step) = (q1, self.spacing);
        while step > MIN_SLICE_DISTANCE {
            step /= f64::from(SLICES_PER_SIDE);
            let around = (-SLICES_PER_SIDE..=SLICES_PER_SIDE).map(|k| middle + f64::from(k) * step);
            let found = around.filter_map(|q1| self.distance_at(q1).map(|distance| (q1, distance)));
            let Some((next, _)) = found.min_by(|a, b| a.1.total_cmp(&b.1)) else { return };
            middle = next;
        }
    }

    /// Returns the distance from the given configuration to the nearest free one with this value of joint 1. Records
    /// the latter if it is the best so far. `None` if the value is not allowed, or if no configuration with it is free.
    fn distance_at(&mut self, q1: f64) -> Option<f64> {
        let topology = self.scene.arm().topology();
        let [first, second] = topology.ranges;
        let inside = |band: &[f64; 2], value: f64| band[0] < value && value < band[1];
        if !first.contains(q1) || self.bands.merged.iter().any(|band| inside(band, first.wrap(q1))) {
            return None;
        }
        self.slice.compute(&self.slices, q1, self.grow);
        let (lower, upper) = second.domain();
        let [least, greatest] = topology.sum.map_or([f64::NEG_INFINITY, f64::INFINITY], |sum| sum.second_joint(q1));
        let wanted = match second {
            JointRange::Interval { .. } => self.from[1].max(least).min(greatest).clamp(lower, upper),
            JointRange::Circle => second.wrap(self.from[1]),
        };
        let ends = self.slice.merged.iter().flat_map(|&[start, end]| [start, end]);
        let mut values: Vec<f64> = ends.chain((!self.slice.forbids(wanted)).then_some(wanted)).collect();
        let away = |value: &f64| second.displacement(self.from[1], *value).abs();
        values.sort_by(|a, b| away(a).total_cmp(&away(b)));
        let q1 = first.lift(q1, self.from[0]);
        // The end of an interval at a joint limit is not free, so try the values in order.
        values.into_iter().find_map(|q2| {
            let to = Configuration::new(q1, second.lift(q2, self.from[1]));
            let clearance = self.scene.clearance(to);
            if clearance <= 0.0 || clearance < self.scene.workspace().clearance || !topology.contains(to) {
                return None;
            }
            let distance = (to - self.from).norm();
            if self.best.is_none_or(|best| distance < best.distance) {
                self.best = Some(NearestFree { configuration: to, distance, clearance, spacing: self.spacing });
            }
            Some(distance)
        })
    }
}

/// Returns the values of joint 1 at the local minima, the one with the least distance first. A sample is a local
/// minimum if neither neighbour has a smaller distance.
fn minima(mut samples: Vec<(f64, f64)>) -> Vec<f64> {
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let distance = |i: Option<usize>| i.and_then(|i| samples.get(i)).map_or(f64::INFINITY, |s| s.1);
    let mut found: Vec<(f64, f64)> = (0..samples.len())
        .filter(|&i| samples[i].1 <= distance(i.checked_sub(1)) && samples[i].1 <= distance(Some(i + 1)))
        .map(|i| samples[i])
        .collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    found.truncate(MAX_REFINED_MINIMA);
    found.into_iter().map(|(q1, _)| q1).collect()
}
