//! Parts of straight motions along which a pair of shapes is too near.

use cplan_geometry::penetration_depth;
use cplan_judge::{Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{Pair, Scene};

/// Margin by which an overlap depth must exceed the motion, as a share of the lengths in the computation. It is far above
/// rounding errors.
const ROUNDING: f64 = 1e-12;

/// Least share of the segment that one test must cover. If it covers less, the shapes come apart there, and testing ends.
const MIN_TEST_SHARE: f64 = 1e-12;

/// Returns the part of a straight motion, around its middle, along which a pair is proven to be nearer than `clearance`, or to
/// overlap. The part is given by its ends, as shares of the motion; both are one half if nothing is proven. There are at most
/// `looks` tests in either direction.
///
/// Shapes that overlap by a certain depth still overlap until a point has moved that far. So each test covers a stretch of the
/// motion, and the next one is at its end.
///
/// If the link's part moves without turning, its positions relative to the piece lie on a straight line. Positions of overlap
/// form a convex set, the Minkowski difference. So an overlap at two places implies an overlap in between.
pub(super) fn held(scene: &Scene, pair: Pair, ends: [Configuration; 2], clearance: f64, looks: usize) -> [f64; 2] {
    if scene.pairs().binary_search(&pair).is_err() {
        return [0.5; 2];
    }
    let piece = scene.piece(pair).grown(clearance);
    // Returns a lower bound on the overlap, and the posture there.
    let looked = |at: Configuration| {
        let posture = Posture::new(scene, at);
        let part = scene.part(pair).at(&scene.arm().pose(pair.link, at));
        // The rounding error of the depth is far greater than that of the position.
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
            // The bound on the motion grows at least as fast as the motion itself.
            let whole = posture.farthest_motion(pair, Deviation::Along(ends[1] - ends[0]));
            let step = room / whole * (1.0 - ROUNDING);
            covered += step;
            if covered >= 0.5 {
                return 0.5;
            }
            if step < MIN_TEST_SHARE {
                break;
            }
        }
        covered
    };
    [0.5 - along(-1.0), 0.5 + along(1.0)]
}

/// Returns true if the part of a pair does not turn between two configurations.
fn slides(scene: &Scene, pair: Pair, ends: [Configuration; 2]) -> bool {
    let joints = if pair.link == 2 { 1..=1 } else { 0..=pair.link };
    joints.into_iter().all(|k| ends[0][k] == ends[1][k] || !scene.arm().joints[k].joint_type.is_revolute())
}
