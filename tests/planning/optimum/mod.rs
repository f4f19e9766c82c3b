//! Lower bounds on the length of every free motion. A bound above the length of a free motion is false. So bounds are
//! compared with the motions of all planners in random worlds, with brute force among polygons, and with closed forms.
//! The limit is always far above the length, because bounds are cut off there.

mod degenerate;
mod gantry;
mod polygons;
mod shipped;
mod worlds;

pub use worlds::obstacle;

use cplan::model::MotionProblem;
use cplan::proofs::{MotionQuery, least_length};
use cplan::space::{Metric, SumSpeed};

/// Relative error that rounding may add to a length.
const ROUNDING: f64 = 1e-9;

/// Limits of the length from which the search starts, as multiples of the true length. They are far above it.
const LIMITS: [f64; 2] = [3.0, 10.0];

fn bound(problem: &MotionProblem, metric: Metric, limit: f64, gap: f64) -> f64 {
    let (scene, start, goals) = (problem.scene(), problem.start(), problem.goals());
    let clearance = scene.workspace().clearance;
    least_length(&MotionQuery { scene, start, goals, clearance, metric }, limit, gap, &[])
}

/// Returns metrics of all kinds.
fn metrics() -> [Metric; 5] {
    let sum = Some(SumSpeed { ratio: 1.0, speed: 0.6 });
    [
        Metric::Euclidean,
        Metric::Weighted { weights: [1.0, 0.3] },
        Metric::Motor { ratio: 1.0 },
        Metric::Time { speeds: [0.7, 2.0], sum: None },
        Metric::Time { speeds: [0.7, 2.0], sum },
    ]
}
