//! Random worlds in which the arm's own body is an obstacle.

use cplan::geometry::{Convex, Vector};
use cplan::model::{Arm, Carrier, MotionProblem, Obstacle, SelfObstacle};
use cplan_cases::dice::Dice;
use cplan_testkit::world;

/// Returns the world of a seed for an arm of a kind whose own body is an obstacle. Returns `None` if the draw has no
/// two free configurations.
pub fn world_of_body(kind: &str, seed: u64) -> Option<MotionProblem> {
    world::drawn(kind, seed, self_obstacles)
}

/// Draws static shapes near the base, and shapes on link 1 near its end. A link is free to meet some of them.
fn self_obstacles(dice: &mut Dice, arm: &Arm) -> Vec<SelfObstacle> {
    let mut all = Vec::new();
    for number in 0..1 + dice.below(4) as usize {
        let (carrier, center) = match dice.chance(0.5) {
            true => (Carrier::Base, arm.base),
            false => (Carrier::FirstJoint, arm.base + arm.offset),
        };
        let near = center + Vector::new(dice.within(-0.3, 0.3), dice.within(-0.3, 0.3));
        let ignored = if dice.chance(0.3) { vec!["first".to_owned()] } else { Vec::new() };
        let obstacle = |obstacle| SelfObstacle {
            carrier,
            obstacle,
            number,
            is_visual: false,
            ignored: ignored.clone(),
            permanent: Default::default(),
        };
        let shapes = world::obstacle(dice, 0.0, near).into_iter().flat_map(|o| split(&o));
        all.extend(shapes.map(obstacle));
    }
    all
}

/// Returns one obstacle for each piece of an obstacle.
fn split(obstacle: &Obstacle) -> Vec<Obstacle> {
    let one = |piece: &Convex| Obstacle { pieces: vec![piece.clone()], ..obstacle.clone() };
    obstacle.pieces.iter().map(one).collect()
}
