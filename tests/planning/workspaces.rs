//! Checks that every shipped workspace has the outcome that its file states, with every planner.
//!
//! The first comment of a workspace names its robot (`# robot: planar_2r`) and the outcome (`# expect: found` or `#
//! expect: infeasible`). A line `# unknown: wavefront harmonic` names planners whose finest resolution may not suffice:
//! they may answer as stated or unknown, but never the contrary.

use cplan::Outcome;
use cplan::engine::{Method, solve};
use cplan::geometry::Convex;
use cplan::model::{Carrier, MotionProblem};
use cplan_testkit::shipped;

struct Shipped {
    name: String,
    problem: MotionProblem,
    expect: String,
    /// Names of the planners whose answer may be unknown.
    unknown: Vec<String>,
}

fn shipped() -> Vec<Shipped> {
    let shipped = |world: shipped::Shipped| {
        let unknown: Vec<String> = world.stated("unknown").split_whitespace().map(str::to_owned).collect();
        assert!(unknown.iter().all(|name| name.parse::<Method>().is_ok()), "{}: {unknown:?}", world.name);
        Shipped { problem: world.motion(), name: world.name, expect: world.expect, unknown }
    };
    shipped::worlds("").into_iter().map(shipped).collect()
}

/// Returns the least and greatest coordinates of shapes, rounded to micrometres.
fn extent(pieces: &[Convex]) -> Vec<i64> {
    let far = |axis: usize, sign: f64| {
        let reach =
            |piece: &Convex| piece.core().iter().map(|p| sign * p[axis]).fold(f64::MIN, f64::max) + piece.radius();
        (1e6 * pieces.iter().map(reach).fold(f64::MIN, f64::max)).round() as i64
    };
    [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)].map(|(axis, sign)| far(axis, sign)).to_vec()
}

/// Pictures would name such an obstacle beside the link.
#[test]
fn no_world_repeats_the_base_of_its_robot() {
    let mut bases = 0;
    let worlds = ["", "arch", "tasks"].into_iter().flat_map(shipped::worlds);
    for world in worlds.chain([shipped::world("explore/packing_cell")]) {
        let problem = world.problem();
        let scene = problem.scene();
        let fixed = scene.arm().self_obstacles.iter().filter(|own| own.carrier == Carrier::Base);
        for base in fixed.map(|own| extent(&own.obstacle.pieces)) {
            bases += 1;
            let twin = scene.workspace().obstacles.iter().find(|obstacle| extent(&obstacle.pieces) == base);
            assert!(twin.is_none(), "{}: {twin:?} is the base of the robot", world.name);
        }
    }
    assert!(bases > 3, "{bases}");
}

/// Returns the least distance at configurations no farther apart than `step` in joint space.
fn sampled_clearance(problem: &MotionProblem, path: &cplan::space::Path, step: f64) -> f64 {
    let mut least = f64::INFINITY;
    for (a, b) in path.segments() {
        let n = ((b - a).norm() / step).ceil().max(1.0);
        let mut i = 0.0;
        while i <= n {
            least = least.min(problem.scene().clearance(a + (b - a) * (i / n)));
            i += 1.0;
        }
    }
    least
}

/// Checks the answers of a planner to all shipped problems.
fn check(method: Method, all: &[Shipped]) {
    let mut wrong = Vec::new();
    let mut output = [0, 0];
    for Shipped { name, problem, expect, unknown } in all {
        let answer = solve(problem, &method.into(), &mut |_| {});
        match (&answer.outcome, expect.as_str()) {
            (Outcome::Found(certified), "found") => {
                let path = certified.path();
                assert_eq!(path.start(), problem.start(), "{name}");
                let topology = problem.scene().arm().topology();
                assert!(problem.goals().contains(&topology, path.goal(), 1e-9), "{name}: {:?}", path.goal());
                let sampled = sampled_clearance(problem, path, 2e-3);
                assert!(certified.clearance() > 0.0, "{name}");
                assert!(certified.clearance() >= problem.scene().workspace().clearance, "{name}");
                assert!(sampled >= certified.clearance(), "{name}: sampled {sampled}");
                output[0] += 1;
            }
            (Outcome::Infeasible(proof), "infeasible") => {
                assert!(!proof.collision_boxes().is_empty(), "{name}");
                output[1] += 1;
            }
            (Outcome::Unknown(_), _) if unknown.iter().any(|name| name == method.name()) => {}
            (verdict, _) => wrong.push(format!("{name}: expected {expect}, got {verdict:?}\n{:?}", answer.history)),
        }
    }
    // A planner that may answer unknown usually does.
    for (output, expect) in output.into_iter().zip(["found", "infeasible"]) {
        let count = all.iter().filter(|s| s.expect == expect).count();
        assert!(output * 2 > count, "{method}: {expect} in {output} of {count}");
    }
    assert!(wrong.is_empty(), "{method}:\n{}", wrong.join("\n"));
}

#[test]
fn every_planner_solves_the_shipped_workspaces() {
    let all = shipped();
    assert!(all.len() >= 10, "only {} workspaces", all.len());
    for kind in ["RR", "RP", "PR", "PP"] {
        assert!(all.iter().any(|s| s.problem.scene().arm().kind() == kind), "no workspace for an {kind} arm");
    }
    let all = &all;
    std::thread::scope(|scope| {
        for method in Method::ALL {
            scope.spawn(move || check(method, all));
        }
    });
}

#[test]
fn the_visibility_path_is_the_shortest_up_to_the_margin() {
    for Shipped { name, problem, expect, unknown } in shipped() {
        if expect != "found" {
            continue;
        }
        let length = |method: Method| match solve(&problem, &method.into(), &mut |_| {}).outcome {
            Outcome::Found(path) => path.path().length(),
            other => panic!("{name}: {other:?}"),
        };
        let shortest = length(Method::Visibility);
        let able = |method: &Method| unknown.iter().all(|name| name != method.name());
        let others = [
            Method::Trapezoid,
            Method::Triangles,
            Method::Voronoi,
            Method::Prm,
            Method::Wavefront,
            Method::Subdivision,
        ];
        for method in others.into_iter().filter(able) {
            // Fields and channels keep their own distance from obstacles. The margin costs far below 2 %.
            let other = length(method);
            assert!(shortest <= 1.02 * other, "{name}: visibility {shortest}, {method} {other}");
        }
    }
}
