//! The visible part of the workspace.

use super::world::ObstacleView;
use crate::axes::Range;
use cplan_geometry::{Convex, Point, Pose};
use cplan_model::Scene;
use cplan_model::space::Configuration;

/// Number of samples along each axis that determine the extent of the arm's motion.
const SAMPLES_PER_AXIS: usize = 17;

/// Returns the least and greatest coordinates of what the arm can sweep, and of obstacles not much farther away: those of the
/// scene, and `moving` obstacles at the time that is shown.
pub fn sides(scene: &Scene, shown: &[Configuration], moving: &[ObstacleView]) -> [Range; 2] {
    /// Fraction of the swept extent by which the panel may grow to include obstacles.
    const MAX_GROWTH: f64 = 0.25;
    const MARGIN_SHARE: f64 = 0.04;
    let swept = reach_box(scene, shown);
    let size = (swept[0].1 - swept[0].0).max(swept[1].1 - swept[1].0);
    let mut sides = swept;
    let fixed = scene.workspace().obstacles.iter().map(|o| bounding_box(&o.pieces));
    for corners in fixed.chain(moving.iter().map(|o| bounding_box(o.own()))) {
        let near = [0, 1].map(|k| {
            (corners[k].0.max(swept[k].0 - MAX_GROWTH * size), corners[k].1.min(swept[k].1 + MAX_GROWTH * size))
        });
        if near.iter().all(|(lower, upper)| lower <= upper) {
            sides = [0, 1].map(|k| (sides[k].0.min(near[k].0), sides[k].1.max(near[k].1)));
        }
    }
    sides.map(|(lower, upper)| (lower - MARGIN_SHARE * size, upper + MARGIN_SHARE * size))
}

/// Returns the box around the arm in many of its configurations, which is accurate enough for a picture.
fn reach_box(scene: &Scene, shown: &[Configuration]) -> [Range; 2] {
    let arm = scene.arm();
    let mut bounds = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    let mut include = |p: Point, r: f64| {
        for k in 0..2 {
            bounds[k] = (bounds[k].0.min(p[k] - r), bounds[k].1.max(p[k] + r));
        }
    };
    include(arm.base, 0.0);
    let [first, second] = arm.topology().ranges.map(|axis| {
        let (lower, upper) = axis.domain();
        (0..SAMPLES_PER_AXIS).map(move |i| lower + (upper - lower) * i as f64 / (SAMPLES_PER_AXIS - 1) as f64)
    });
    let sampled = first.flat_map(|q1| second.clone().map(move |q2| Configuration::new(q1, q2)));
    for q in sampled.chain(shown.iter().copied()) {
        include(arm.tip_at(q), 0.0);
        let mut shape =
            |shape: &Convex, pose: &Pose| shape.core().iter().for_each(|p| include(pose.point(*p), shape.radius()));
        for (link, pose) in arm.poses(q).iter().enumerate() {
            scene.own_parts(link).iter().for_each(|part| shape(&part.shape, pose));
        }
        if let Some(payload) = scene.attachment() {
            let pose = payload.grip.pose(arm, q);
            payload.pieces().for_each(|piece| shape(piece, &pose));
        }
    }
    bounds
}

/// Returns the box around shapes. If there are none, its lower ends are above its upper ends.
pub fn bounding_box<'a>(shapes: impl IntoIterator<Item = &'a Convex>) -> [Range; 2] {
    let mut bounds = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for shape in shapes {
        for (p, k) in shape.core().iter().flat_map(|p| [(p, 0), (p, 1)]) {
            bounds[k] = (bounds[k].0.min(p[k] - shape.radius()), bounds[k].1.max(p[k] + shape.radius()));
        }
    }
    bounds
}
