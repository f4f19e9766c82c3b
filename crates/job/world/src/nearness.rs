//! Checks whether obstacles are near the arm at all. Drawings and maps may use other units, or another origin.

use cplan_geometry::{Convex, separation};
use cplan_model::Scene;
use cplan_model::space::JointRange;
use cplan_text::format_distinct;

/// Returns a warning if all obstacles are out of the arm's reach. Stops at the first obstacle that may be within reach.
pub(super) fn warning(scene: &Scene) -> Option<String> {
    let arm = scene.arm();
    let slides = arm.joints.iter().filter(|joint| !joint.joint_type.is_revolute()).map(|joint| match joint.range {
        JointRange::Interval { lower, upper } => lower.abs().max(upper.abs()),
        JointRange::Circle => f64::INFINITY,
    });
    let reach = arm.reach() + slides.sum::<f64>();
    let base = Convex::trusted(vec![arm.base], 0.0);
    let mut nearest = f64::INFINITY;
    for piece in scene.workspace().obstacles.iter().flat_map(|obstacle| &obstacle.pieces) {
        nearest = nearest.min(separation(&base, piece).distance);
        if nearest <= reach + scene.workspace().clearance {
            return None;
        }
    }
    nearest.is_finite().then(|| {
        let [nearest, reach] = format_distinct([nearest, reach], 4);
        format!(
            "no obstacle is within the arm's reach: the nearest is {nearest} m from joint 1, no part of the arm comes farther than \
             {reach} m; is the world in metres, and [robot] `at` where the arm stands?"
        )
    })
}
