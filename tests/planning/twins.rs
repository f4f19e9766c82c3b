//! Workspaces without a path, and twins of them with a path. Stored proofs pass the independent check, and found paths
//! pass a sweep by parry2d.

use cplan::Outcome;
use cplan::check::{ProofBox, ProofError, read_proof};
use cplan::engine::{Method, solve};
use cplan::geometry::Convex;
use cplan::input::{self, Overrides};
use cplan::model::{MotionProblem, Scene};
use cplan::proofs::{Connectivity, connectivity};
use cplan::space::{Configuration, Path};
use cplan_testkit::problems::recheck;
use parry2d_f64::math::{Pose, Rotation, Vector};
use parry2d_f64::query::intersection_test;
use parry2d_f64::shape::{Ball, ConvexPolygon, Segment, Shape};

/// For each pair of workspaces, the name, which states what closes the infeasible one, and the robot.
const TWINS: [(&str, &str); 6] = [
    ("limits", "planar_2r"),
    ("annulus", "gantry"),
    ("thin_wall", "polar"),
    ("torus", "planar_2r_continuous"),
    ("slot", "rail_arm"),
    ("singular", "planar_2r"),
];

/// Number of boxes that suffices to decide each workspace.
const BOXES: usize = 200_000;

/// Greatest change of a joint between two samples.
const STEP: f64 = 1e-4;

fn load(name: &str, robot: &str) -> MotionProblem {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let (urdf, world) = (format!("robots/{robot}.urdf"), format!("workspaces/{name}.toml"));
    let loaded = input::load(root.join(urdf), &root.join(world), &Overrides::default());
    loaded.unwrap_or_else(|e| panic!("{e}")).problem
}

#[test]
fn infeasible_twins_are_proven_and_proofs_can_be_read_back() {
    for (what, robot) in TWINS {
        let problem = load(&format!("{what}_closed"), robot);
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
        let twin = load(&format!("{what}_open"), robot);
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

fn check_feasible_twins(method: Method) {
    for (what, robot) in TWINS {
        let problem = load(&format!("{what}_open"), robot);
        let answer = solve(&problem, &method.into(), &mut |_| {});
        let Outcome::Found(certified) = &answer.outcome else {
            panic!("{what} by {method}: {:?}", answer.outcome);
        };
        assert_eq!(first_contact(problem.scene(), certified.path()), None, "{what} by {method}");
    }
}

#[test]
fn feasible_twins_are_solved_by_visibility() {
    check_feasible_twins(Method::Visibility);
}

#[test]
fn feasible_twins_are_solved_by_trapezoids() {
    check_feasible_twins(Method::Trapezoid);
}

#[test]
fn feasible_twins_are_solved_by_subdivision() {
    check_feasible_twins(Method::Subdivision);
}

#[test]
fn the_sweep_sees_contacts() {
    // Tries the twin's path in the closed world.
    for (what, robot) in TWINS.into_iter().filter(|(what, _)| *what != "limits") {
        let (open, closed) = (load(&format!("{what}_open"), robot), load(&format!("{what}_closed"), robot));
        let answer = solve(&open, &Method::Visibility.into(), &mut |_| {});
        let Outcome::Found(certified) = &answer.outcome else { panic!("{what}") };
        assert!(first_contact(closed.scene(), certified.path()).is_some(), "{what}");
    }
}
