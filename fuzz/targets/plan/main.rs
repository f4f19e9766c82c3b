//! Plans in small scenes, then does not believe it: found paths are sampled densely through parry2d with kinematics of
//! this file, proofs are checked again and against the other planners.
#![no_main]

mod draft;

use cplan::Outcome;
use cplan::check::{CertifiedPath, Disconnection, certify};
use cplan::engine::{Method, solve};
use cplan::geometry::Convex;
use cplan::model::{JointType, MotionProblem, Scene};
use cplan::space::{Configuration, Path};
use cplan::{Options, Planner};
use draft::Draft;
use libfuzzer_sys::fuzz_target;
use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query;
use parry2d_f64::shape::SharedShape;

/// Error of the iterations of parry's GJK algorithm, metres.
const PARRY: f64 = 1e-6;

/// Number of samples of a straight piece.
const SAMPLES: u32 = 200;

/// Returns options with little effort, so that many scenes are tried.
fn options(method: Method) -> Options {
    let planner = Planner::named(method).with_margin(1e-2).with_cells(32);
    Options { levels: 2, boxes: 2000, bounded: false, ..planner.into() }
}

/// Returns a shape's core, turned by an angle and moved, or `None` if parry's constructor refuses a sliver.
fn core(shape: &Convex, angle: f64, by: Vector) -> Option<(Pose, SharedShape)> {
    let (sin, cos) = angle.sin_cos();
    let points: Vec<Vector> =
        shape.core().iter().map(|p| Vector::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y) + by).collect();
    Some(match points[..] {
        [p] => (Pose::from_translation(p), SharedShape::ball(0.0)),
        [p, q] => (Pose::identity(), SharedShape::segment(p, q)),
        _ => (Pose::identity(), SharedShape::convex_polyline_unmodified(points)?),
    })
}

/// Returns angle and position of both links.
fn frames(scene: &Scene, q: Configuration) -> [(f64, Vector); 2] {
    let arm = scene.arm();
    let mut angle = 0.0_f64;
    let mut place = Vector::new(arm.base.x, arm.base.y);
    let turned =
        |angle: f64, x: f64, y: f64| Vector::new(angle.cos() * x - angle.sin() * y, angle.sin() * x + angle.cos() * y);
    [0, 1].map(|k| {
        if k == 1 {
            place += turned(angle, arm.offset.x, arm.offset.y);
        }
        match arm.joints[k].joint_type {
            JointType::Revolute { sign } => angle += sign * q[k],
            JointType::Prismatic { direction } => place += turned(angle, direction.x * q[k], direction.y * q[k]),
        }
        (angle, place)
    })
}

fn check_sample(scene: &Scene, q: Configuration, promised: f64) {
    let frames = frames(scene, q);
    for (link, (angle, place)) in scene.arm().links.iter().zip(frames) {
        for part in &link.parts {
            let Some((p, a)) = core(&part.shape, angle, place) else {
                continue;
            };
            for obstacle in &scene.workspace().obstacles {
                if !part.heights.meet(obstacle.heights) {
                    continue;
                }
                for piece in &obstacle.pieces {
                    let Some((r, b)) = core(piece, 0.0, Vector::new(0.0, 0.0)) else {
                        continue;
                    };
                    let Ok(found) = query::distance(&p, a.as_ref(), &r, b.as_ref()) else {
                        continue;
                    };
                    let distance = found.distance - part.shape.radius() - piece.radius();
                    assert!(distance > promised - PARRY, "{distance} at {q}, promised {promised}");
                }
            }
        }
    }
}

fn check_path(problem: &MotionProblem, found: &CertifiedPath) {
    let (scene, path) = (problem.scene(), found.path());
    let topology = scene.arm().topology();
    assert!(found.clearance() > 0.0 && found.clearance() >= scene.workspace().clearance);
    assert_eq!(path.start(), problem.start());
    assert!(problem.goals().contains(&topology, path.goal(), 1e-9));
    assert!(path.waypoints().iter().all(|&q| topology.contains(q)));
    for (a, b) in path.segments().chain([(path.goal(), path.goal())]) {
        for i in 0..=SAMPLES {
            check_sample(scene, a + (b - a) * (f64::from(i) / f64::from(SAMPLES)), found.clearance());
        }
    }
}

fuzz_target!(|draft: Draft| {
    let Some(problem) = draft.problem() else { return };
    let chosen = Method::ALL[usize::from(draft.method) % Method::ALL.len()];
    let (mut found, mut infeasible) = (false, false);
    for method in [chosen, Method::Subdivision] {
        match solve(&problem, &options(method), &mut |_| {}).outcome {
            Outcome::Found(path) => {
                check_path(&problem, &path.certified);
                found = true;
            }
            Outcome::Infeasible(proof) => {
                let clearance = problem.scene().workspace().clearance;
                let claim = Disconnection::new(proof.collision_boxes().to_vec());
                claim.checked(problem.scene(), problem.start(), problem.goals(), clearance).expect("the proof holds");
                let topology = problem.scene().arm().topology();
                for goal in problem.goals().points() {
                    let straight = Path::new(vec![problem.start(), topology.lift(goal, problem.start())]);
                    assert!(certify(problem.scene(), straight).is_err(), "the straight way is free");
                }
                infeasible = true;
            }
            Outcome::Unknown(_) => {}
        }
    }
    assert!(!(found && infeasible), "found, and proven infeasible");
});
