//! Along which part of a straight motion a pair of shapes is too near.

use cplan_core::check::{Deviation, Posture};
use cplan_core::model::{Pair, Scene};
use cplan_core::space::Configuration;
use cplan_geometry::penetration_depth;

/// Share of the lengths involved by which a depth must exceed the motion, far above the rounding of either.
const ROUNDING: f64 = 1e-12;

/// A look that covers less than this share of the segment is the last: towards its end shapes come apart.
const LEAST: f64 = 1e-12;

/// The part of the motion between two configurations, about its middle, along which a pair is proven nearer than `clearance`,
/// or to overlap: from a share of the way to another, with so many looks in either direction. Both are one half if there is none.
///
/// Shapes that overlap by a depth do so until a point has moved as far: so each look covers some of the motion, and the next
/// one looks at the end of that. Where the part slides without turning, its places relative to the piece are a straight
/// segment, and those that overlap are a convex set, the Minkowski difference: what overlaps at both ends does so between.
pub(super) fn held(scene: &Scene, pair: Pair, ends: [Configuration; 2], clearance: f64, looks: usize) -> [f64; 2] {
    if scene.pairs().binary_search(&pair).is_err() {
        return [0.5; 2];
    }
    let piece = scene.piece(pair).grown(clearance);
    // By how much they overlap for certain, and the posture there.
    let looked = |at: Configuration| {
        let posture = Posture::new(scene, at);
        let part = scene.part(pair).at(&scene.arm().pose(pair.link, at));
        // What rounding makes of the place is far less than what it makes of the depth.
        (penetration_depth(&part, &piece) - ROUNDING * posture.scale(part.core(), part.radius(), &piece), posture)
    };
    if slides(scene, pair, ends) && ends.iter().all(|&end| looked(end).0 > 0.0) {
        return [0.0, 1.0];
    }
    let along = |direction: f64| {
        let mut covered = 0.0;
        for _ in 0..looks {
            let (room, posture) = looked(ends[0] + (ends[1] - ends[0]) * (0.5 + direction * covered));
            if room <= 0.0 {
                break;
            }
            // A bound on motions grows at least as fast as they do.
            let whole = posture.farthest_motion(pair, Deviation::Along(ends[1] - ends[0]));
            let step = room / whole * (1.0 - ROUNDING);
            covered += step;
            if covered >= 0.5 {
                return 0.5;
            }
            if step < LEAST {
                break;
            }
        }
        covered
    };
    [0.5 - along(-1.0), 0.5 + along(1.0)]
}

/// Whether no joint turns the part of a pair between two configurations.
fn slides(scene: &Scene, pair: Pair, ends: [Configuration; 2]) -> bool {
    let joints = if pair.link == 2 { 1..=1 } else { 0..=pair.link };
    joints.into_iter().all(|k| ends[0][k] == ends[1][k] || !scene.arm().joints[k].joint_type.is_revolute())
}
