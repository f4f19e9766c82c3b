//! Warns about obstacles far from the arm: drawings and maps may use other units, or another origin.

use cplan_geometry::{Convex, separation};
use cplan_model::space::JointRange;
use cplan_model::{Obstacle, Scene};
use cplan_text::format_distinct;

/// An obstacle farther away than this is probably in other units. In reaches of the arm; the walls of a hall are nearer.
const FAR_REACHES: f64 = 10.0;

/// Returns a warning if all obstacles are out of the arm's reach; otherwise one for each obstacle that is far from it.
pub(super) fn warnings(scene: &Scene) -> Vec<String> {
    let arm = scene.arm();
    let slides = arm.joints.iter().filter(|joint| !joint.joint_type.is_revolute()).map(|joint| match joint.range {
        JointRange::Interval { lower, upper } => lower.abs().max(upper.abs()),
        JointRange::Circle => f64::INFINITY,
    });
    let reach = arm.reach() + slides.sum::<f64>();
    let base = Convex::trusted(vec![arm.base], 0.0);
    // Ignores the pieces after the first one that may be within reach.
    let distance = |obstacle: &Obstacle| {
        let mut nearest = f64::INFINITY;
        for piece in &obstacle.pieces {
            nearest = nearest.min(separation(&base, piece).distance);
            if nearest <= reach + scene.workspace().clearance {
                break;
            }
        }
        nearest
    };
    let obstacles = &scene.workspace().obstacles;
    let distances: Vec<f64> = obstacles.iter().map(distance).collect();
    let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
    if nearest.is_finite() && nearest > reach + scene.workspace().clearance {
        let [nearest, reach] = format_distinct([nearest, reach], 4);
        return vec![format!(
            "no obstacle is within reach: the nearest is {nearest} m from joint 1, and the arm reaches {reach} m; check that the world is in metres, and that [robot] `at` is the place of the arm"
        )];
    }
    let is_far = |distance: f64| distance.is_finite() && distance > FAR_REACHES * reach;
    let far = obstacles.iter().zip(distances).filter(|(_, distance)| is_far(*distance));
    far.map(|(obstacle, distance)| {
        let [distance, reach] = format_distinct([distance, reach], 4);
        format!(
            "obstacle \"{}\" is {distance} m from joint 1, but the arm reaches only {reach} m; check that the obstacle is in metres",
            obstacle.name
        )
    })
    .collect()
}
