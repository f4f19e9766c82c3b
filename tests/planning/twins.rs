//! Workspaces without a path, and twins of them with a path. Stored proofs pass the independent check, and found paths
//! pass a sweep by parry2d.

use cplan::Outcome;
use cplan::check::{ProofBox, ProofError, read_proof};
use cplan::engine::{Method, solve};
use cplan::geometry::Convex;
use cplan::model::{MotionProblem, Scene};
use cplan::proofs::{Connectivity, connectivity};
use cplan::space::{Configuration, Path};
use cplan_testkit::problems::recheck;
use cplan_testkit::shipped;
use parry2d_f64::math::{Pose, Rotation, Vector};
use parry2d_f64::query::intersection_test;
use parry2d_f64::shape::{Ball, ConvexPolygon, Segment, Shape};

/// Names of the pairs of workspaces, which state what closes the infeasible one.
const TWINS: [&str; 6] = ["limits", "annulus", "thin_wall", "torus", "slot", "singular"];

fn closed(what: &str) -> MotionProblem {
    shipped::world(&format!("{what}_closed")).motion()
}

fn open(what: &str) -> MotionProblem {
    shipped::world(&format!("{what}_open")).motion()
}

/// Number of boxes that suffices to decide each workspace.
const BOXES: usize = 200_000;

/// Greatest change of a joint between two samples.
const STEP: f64 = 1e-4;

#[test]
fn infeasible_twins_are_proven_and_proofs_can_be_read_back() {
    for what in TWINS {
        let problem = closed(what);
        let (scene, start, goals) = (problem.scene(), problem.start(), problem.goals());
        let Connectivity::Disconnected(proof) = connectivity(scene, start, goals, 0.0, BOXES) else {
            panic!("{what} is not proven");
        };
        let boxes: Vec<ProofBox> = proof.collision_boxes().iter().map(ProofBox::from).collect();
        let text = serde_json::json!({ "proof": boxes }).to_string();
        let read = read_proof(&text).unwrap();
        let claim = read.collision_boxes();
        assert_eq!(claim, proof.collision_boxes(), "{what}");
        assert_eq!(recheck(claim, scene, start, goals, 0.0), Ok(()), "{what}");
        // The twin has a path, so the proof must not hold there: some box is false.
        let twin = open(what);
        let refused = recheck(claim, twin.scene(), twin.start(), twin.goals(), 0.0);
        let is_false = matches!(
            refused,
            Err(ProofError::UnknownPair(_) | ProofError::NotColliding { .. } | ProofError::NotSeparated(_))
        );
        assert!(is_false, "{what}: {refused:?}");
    }
}

/// Returns parry2d's shape for the core of a rounded polygon. Only discs have a radius here; all other shapes have
/// sharp corners.
fn shape(convex: &Convex) -> Box<dyn Shape> {
    let corners: Vec<Vector> = convex.core().iter().map(|p| Vector::new(p.x, p.y)).collect();
    assert!(corners.len() == 1 || convex.radius() == 0.0);
    match corners[..] {
        [_] => Box::new(Ball::new(convex.radius())),
        [a, b] => Box::new(Segment::new(a, b)),
        _ => Box::new(ConvexPolygon::from_convex_polyline_unmodified(corners).expect("with area")),
    }
}

/// Returns parry2d's pose for a shape. Only discs need one, which is that of the centre.
fn place(convex: &Convex) -> Pose {
    match convex.core() {
        [center] => Pose::from_translation(Vector::new(center.x, center.y)),
        _ => Pose::identity(),
    }
}

/// Returns the first configuration of the path at which parry2d finds a contact, in steps of at most [`STEP`].
fn first_contact(scene: &Scene, path: &Path) -> Option<Configuration> {
    let pairs: Vec<_> = scene.pairs().iter().map(|&p| (p.link, scene.part(p), scene.piece(p))).collect();
    let shapes: Vec<_> = pairs.iter().map(|(link, a, b)| (*link, shape(a), place(a), shape(b), place(b))).collect();
    let meets = |q: Configuration| {
        let poses = scene.arm().poses(q).map(|pose| {
            let t = pose.translation;
            let rotation = Rotation { re: pose.rotation.re, im: pose.rotation.im };
            Pose::from_parts(Vector::new(t.x, t.y), rotation)
        });
        let meet = |(link, a, at_a, b, at_b): &(usize, Box<dyn Shape>, Pose, Box<dyn Shape>, Pose)| {
            let test = intersection_test(&(poses[*link] * *at_a), &**a, at_b, &**b);
            test.expect("parry2d tests all pairs of convex shapes").intersecting
        };
        shapes.iter().any(meet)
    };
    let samples = path.segments().flat_map(|(a, b)| {
        let n = ((b - a).amax() / STEP).ceil().max(1.0) as u32;
        (0..=n).map(move |i| a + (b - a) * (f64::from(i) / f64::from(n)))
    });
    samples.into_iter().find(|&q| meets(q))
}

#[test]
fn feasible_twins_are_free_by_parry2d() {
    for what in TWINS {
        let problem = open(what);
        for method in [Method::Visibility, Method::Trapezoid, Method::Subdivision] {
            let answer = solve(&problem, &method.into(), &mut |_| {});
            let Outcome::Found(certified) = &answer.outcome else {
                panic!("{what} by {method}: {:?}", answer.outcome);
            };
            assert_eq!(first_contact(problem.scene(), certified.path()), None, "{what} by {method}");
        }
    }
}

#[test]
fn the_sweep_sees_contacts() {
    // Tries the twin's path in the closed world.
    for what in TWINS.into_iter().filter(|what| *what != "limits") {
        let (open, closed) = (open(what), closed(what));
        let answer = solve(&open, &Method::Visibility.into(), &mut |_| {});
        let Outcome::Found(certified) = &answer.outcome else { panic!("{what}") };
        assert!(first_contact(closed.scene(), certified.path()).is_some(), "{what}");
    }
}
