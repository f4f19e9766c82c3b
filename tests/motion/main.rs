//! Motions on paths with blends: their curves, limits and clearances, and how near they come to the optimum.

mod certificate;
mod corner_optimum;
mod jerk;
mod margins;
#[cfg(feature = "mcap")]
mod mcap;
mod optimum;
mod played;
#[cfg(feature = "mcap")]
mod recorded_scene;
mod sampled;
mod torque;
mod trajectory;

use cplan::check::{CertifiedCurve, CertifiedPath, blend, certify};
use cplan::model::Scene;
use cplan::space::Path;
use cplan_testkit::arms::gantry;
use cplan_testkit::scenes::{q, scene};
use proptest::prelude::*;

/// Returns a gantry in an empty room, where a blend can be as large as requested.
fn empty(velocity: [f64; 2], acceleration: [f64; 2]) -> Scene {
    let mut arm = gantry([-100.0, 100.0], vec![]);
    for (k, joint) in arm.joints.iter_mut().enumerate() {
        (joint.velocity, joint.acceleration) = (velocity[k], acceleration[k]);
    }
    scene(arm, vec![])
}

fn certified(scene: &Scene, waypoints: &[[f64; 2]]) -> CertifiedPath {
    let path = Path::new(waypoints.iter().map(|&[a, b]| q(a, b)).collect());
    certify(scene, path).expect("an empty room")
}

fn curve(scene: &Scene, waypoints: &[[f64; 2]], radius: f64) -> CertifiedCurve {
    blend(scene, &certified(scene, waypoints), radius, 0.0)
}

/// Generates limits of two joints that differ by a factor of up to a thousand.
fn limits() -> impl Strategy<Value = [[f64; 2]; 2]> {
    let power = |range: std::ops::Range<f64>| range.prop_map(|e| 10f64.powf(e));
    let both = move |range: std::ops::Range<f64>| [power(range.clone()), power(range)];
    (both(-1.0..1.0), both(-0.5..2.5)).prop_map(|(velocity, acceleration)| [velocity, acceleration])
}

/// Generates paths with long and short legs, sharp and gentle corners.
fn waypoints() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let turn = prop_oneof![-3.2..3.2_f64, -0.3..0.3_f64, Just(std::f64::consts::PI), Just(0.0)];
    prop::collection::vec((-2.5..0.7_f64, turn), 1..7).prop_map(|legs| {
        let (mut at, mut heading) = ([0.0, 0.0], 0.4);
        let mut waypoints = vec![at];
        for (exponent, turn) in legs {
            heading += turn;
            let length = 10f64.powf(exponent);
            at = [at[0] + length * f64::cos(heading), at[1] + length * f64::sin(heading)];
            waypoints.push(at);
        }
        waypoints
    })
}
