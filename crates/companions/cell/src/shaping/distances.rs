//! The distances between the arms and from obstacles in the cost of a motion.

use super::model::{Model, barrier};
use super::{INTERVALS, Shape, Shaping};
use crate::contact::{contact_point, rates};
use cplan_judge::{Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{Pair, Scene};

/// Number of times in each interval at which distances between the arms are measured. From obstacles, they are measured once.
const SAMPLES: usize = 2;

/// Distance of two differences of the clocks at which distances are measured, as a share of an interval. The greatest
/// differences of the clocks decide, unless others are far from them.
const SHIFT_SHARE: f64 = 2.5;

impl Shape {
    /// Returns the number of the interval at a time, the share of it that is gone, and the weights of its control points.
    fn interval_at(&self, time: f64) -> (usize, f64, [f64; 3]) {
        let at = (time / self.interval).clamp(0.0, INTERVALS as f64);
        let first = (at as usize).min(INTERVALS - 1);
        let u = at - first as f64;
        (first, u, [0.5 * (1.0 - u) * (1.0 - u), 0.5 + u - u * u, 0.5 * u * u])
    }

    /// Returns the configuration of an arm at a time.
    fn at(&self, arm: usize, time: f64) -> Configuration {
        let (first, _, weights) = self.interval_at(time);
        let joint = |k: usize| (0..3).map(|i| weights[i] * self.controls[first + i][2 * arm + k]).sum::<f64>();
        Configuration::new(joint(0), joint(1))
    }

    /// Returns the velocity of an arm at a time.
    fn velocity(&self, arm: usize, time: f64) -> Configuration {
        let (first, u, _) = self.interval_at(time);
        let by = |i: usize, j: usize| (self.controls[i + 1][j] - self.controls[i][j]) / self.interval;
        let joint = |j: usize| by(first, j) * (1.0 - u) + by(first + 1, j) * u;
        Configuration::new(joint(2 * arm), joint(2 * arm + 1))
    }

    /// Adds the derivatives of a quantity by the control points, from those by the joints of an arm at a time.
    fn push(&self, arm: usize, time: f64, rates: [f64; 2], entries: &mut Vec<(usize, f64)>) {
        let (first, _, weights) = self.interval_at(time);
        for (i, weight) in weights.into_iter().enumerate() {
            let unknowns = [0, 1].map(|k| Self::unknown(first + i, 2 * arm + k));
            if let [Some(one), Some(two)] = unknowns
                && weight > 0.0
            {
                entries.extend([(one, weight * rates[0]), (two, weight * rates[1])]);
            }
        }
    }
}

impl Shaping<'_> {
    /// Returns the cost of distances, and adds it to the model. `None` if a distance is too small.
    pub(super) fn add_distances(&self, shape: &Shape, weight: f64, model: &mut Model) -> Option<f64> {
        let required = self.between.clearance + self.margin;
        let parts = (2.0 * self.skew / (SHIFT_SHARE * shape.interval)).ceil().min((4 * INTERVALS) as f64) as usize;
        let shift = |k: usize| self.skew * (2.0 * k as f64 / parts as f64 - 1.0);
        let shifts: Vec<f64> = if parts == 0 { vec![0.0] } else { (0..=parts).map(shift).collect() };
        let (mut value, mut entries) = (0.0, Vec::new());
        for k in 0..=SAMPLES * INTERVALS {
            let time = k as f64 / SAMPLES as f64 * shape.interval;
            let first = self.between.stance(0, shape.at(0, time));
            for by in &shifts {
                let late = time + by;
                let second = self.between.stance(1, shape.at(1, late));
                let mut is_apart = true;
                self.between.near([&first, &second], required + self.range, |distance, [one, two]| {
                    entries.clear();
                    shape.push(0, time, one, &mut entries);
                    shape.push(1, late, two, &mut entries);
                    // The difference of the clocks does not grow with the interval.
                    let velocity = shape.velocity(1, late);
                    let by_square = -0.5 * by * (two[0] * velocity[0] + two[1] * velocity[1]);
                    match self.add_distance(distance - required, weight, &mut entries, by_square, model) {
                        Some(cost) => value += cost,
                        None => is_apart = false,
                    }
                });
                if !is_apart {
                    return None;
                }
            }
        }
        for k in 0..=INTERVALS {
            let time = k as f64 * shape.interval;
            value += (0..2).try_fold(0.0, |sum, arm| {
                Some(sum + self.add_obstacles(shape, arm, time, weight, &mut entries, model)?)
            })?;
        }
        Some(value)
    }

    /// Does the same for the obstacles of one arm at one time.
    fn add_obstacles(
        &self,
        shape: &Shape,
        arm: usize,
        time: f64,
        weight: f64,
        entries: &mut Vec<(usize, f64)>,
        model: &mut Model,
    ) -> Option<f64> {
        let (scene, q) = (self.between.scenes[arm], shape.at(arm, time));
        let posture = Posture::new(scene, q);
        let mut value = 0.0;
        for pair in scene.pairs() {
            let required = required(scene, *pair) + self.margin;
            if posture.disc_bound(*pair, Deviation::Box([0.0; 2])) >= required + self.range {
                continue;
            }
            let here = posture.separation(*pair);
            if here.distance < required + self.range {
                let part = scene.part(*pair).at(&posture.pose(pair.link));
                let at = contact_point(&part, scene.piece(*pair), here);
                let rates = rates(scene.arm(), pair.link, q, at, here.direction).map(|rate| -rate);
                entries.clear();
                shape.push(arm, time, rates, entries);
                value += self.add_distance(here.distance - required, weight, entries, 0.0, model)?;
            }
        }
        Some(value)
    }

    /// Returns the cost of a distance, and adds it to the model. `None` if the distance is too small. Where the arms rest, no distance counts.
    fn add_distance(
        &self,
        room: f64,
        weight: f64,
        entries: &mut [(usize, f64)],
        by_square: f64,
        model: &mut Model,
    ) -> Option<f64> {
        if entries.is_empty() {
            return Some(0.0);
        }
        entries.iter_mut().for_each(|(_, rate)| *rate /= self.range);
        let [value, slope, curvature] = barrier(room / self.range)?.map(|term| weight * term);
        model.add(slope, curvature, entries, by_square / self.range);
        Some(value)
    }

    /// Returns the distance of arms at rest from each other and from obstacles, beyond the clearance.
    pub(super) fn room(&self, both: [Configuration; 2]) -> f64 {
        let placed = [0, 1].map(|arm| self.between.at_rest(arm, both[arm]));
        let apart = self.between.distance(placed.each_ref(), f64::INFINITY).least - self.between.clearance;
        let alone = (0..2).map(|arm| {
            let scene = self.between.scenes[arm];
            let posture = Posture::new(scene, both[arm]);
            let room = |pair: &Pair| posture.separation(*pair).distance - required(scene, *pair);
            scene.pairs().iter().map(room).fold(f64::INFINITY, f64::min)
        });
        alone.fold(apart, f64::min)
    }
}

/// Returns the distance that a pair must keep, metres.
fn required(scene: &Scene, pair: Pair) -> f64 {
    // A link meets its robot's own body only if they overlap.
    if scene.self_obstacle(pair.obstacle).is_some() { 0.0 } else { scene.workspace().clearance }
}
