//! The nearest free configuration, compared with a lattice of configurations whose distances to the obstacles are
//! computed.

use cplan::cspace::nearest_free;
use cplan::geometry::{Point, Vector};
use cplan::model::{JointType, Scene, Workspace};
use cplan::space::{Configuration, JointRange};
use cplan_testkit::arms::{all_kinds, arm, joint, link, rr};
use cplan_testkit::scenes::{obstacle, placed, q, scene};
use cplan_testkit::shapes::{disc, rectangle, wall};

/// Returns true if a configuration is free, computed by the definition instead of slices.
fn is_free(scene: &Scene, at: Configuration) -> bool {
    let clearance = scene.clearance(at);
    scene.arm().topology().contains(at) && clearance > 0.0 && clearance >= scene.workspace().clearance
}

/// Returns the least distance from `from` to a free configuration of an `n` by `n` lattice over the domain.
fn lattice(scene: &Scene, from: Configuration, n: u32) -> f64 {
    let topology = scene.arm().topology();
    let value = |axis: JointRange, i: u32| {
        let (lower, upper) = axis.domain();
        lower + (upper - lower) * f64::from(i) / f64::from(n)
    };
    let mut least = f64::INFINITY;
    for i in 0..=n {
        for k in 0..=n {
            let at = q(value(topology.ranges[0], i), value(topology.ranges[1], k));
            let distance = topology.distance(from, at);
            if distance < least && is_free(scene, at) {
                least = distance;
            }
        }
    }
    least
}

fn crowded(which: usize, clearance: f64) -> Scene {
    let pieces = vec![
        disc(Point::new(0.75, 0.35), 0.15),
        rectangle(-0.9, -0.4, -0.7, -0.3),
        wall(Point::new(0.4, -0.9), Point::new(1.1, -0.2)),
    ];
    scene(all_kinds().remove(which), pieces).with_clearance(clearance).unwrap()
}

#[test]
fn no_configuration_of_a_lattice_is_free_and_nearer() {
    const N: u32 = 240;
    let mut blocked = 0;
    for which in 0..all_kinds().len() {
        for clearance in [0.0, 0.05] {
            let scene = crowded(which, clearance);
            for i in 0..6 {
                for k in 0..6 {
                    let domain = scene.arm().topology().ranges.map(JointRange::domain);
                    let part = |j: usize, i: i32| {
                        domain[j].0 + (domain[j].1 - domain[j].0) * (f64::from(i) * 1.09 - 0.2) / 5.0
                    };
                    let from = q(part(0, i), part(1, k));
                    if is_free(&scene, from) {
                        continue;
                    }
                    blocked += 1;
                    let found = nearest_free(&scene, from).expect("much is free");
                    let at = found.configuration;
                    assert!(is_free(&scene, at), "kind {which}: {from} to {at}");
                    assert_eq!(found.clearance, scene.clearance(at));
                    assert!((found.distance - (at - from).norm()).abs() < 1e-12);
                    let brute = lattice(&scene, from, N);
                    // A minimum between two slices may be missed. The error is at most their spacing.
                    assert!(found.distance <= brute + found.spacing, "kind {which}: {} > {brute}", found.distance);
                }
            }
        }
    }
    assert!(blocked > 50, "only {blocked} configurations were not free");
}

/// Checks a bar in front of a disc. The nearest free configuration is a turn of joint 1, whose angle has a closed form.
#[test]
fn the_nearest_free_configuration_has_the_known_angle() {
    let turn = JointType::Revolute { sign: 1.0 };
    let limits = JointRange::Interval { lower: -3.0, upper: 3.0 };
    let blind = arm(
        [joint("a", turn, limits), joint("b", turn, limits)],
        [link("first", vec![wall(Point::zeros(), Point::new(1.0, 0.0))]), link("second", Vec::new())],
        Vector::new(1.0, 0.0),
        Point::new(0.5, 0.0),
    );
    let scene = scene(blind, vec![disc(Point::new(0.8, 0.0), 0.2)]);
    // The tangent from the base to the disc.
    let angle = (0.2f64 / 0.8).asin();
    let found = nearest_free(&scene, q(0.1, 0.4)).unwrap();
    assert!((found.configuration - q(angle, 0.4)).norm() < 1e-7, "{}", found.configuration);
    let scene = scene.with_clearance(0.1).unwrap();
    let found = nearest_free(&scene, q(-0.1, 0.4)).unwrap();
    assert!((found.configuration - q(-(0.3f64 / 0.8).asin(), 0.4)).norm() < 1e-7, "{}", found.configuration);
    assert!(found.clearance >= 0.1);
    // A configuration that is only outside the limits: the limit is nearest.
    let found = nearest_free(&scene, q(1.0, 3.5)).unwrap();
    assert_eq!(found.configuration, q(1.0, 3.0));
}

#[test]
fn the_short_way_round_the_circle_counts() {
    let scene = scene(rr([JointRange::Circle; 2]), vec![disc(Point::new(-0.5, 0.02), 0.05)]);
    let from = q(std::f64::consts::PI - 0.001, 0.0);
    let found = nearest_free(&scene, from).unwrap();
    assert!(is_free(&scene, found.configuration));
    assert!(found.distance < 0.3 && (found.configuration - from).norm() == found.distance);
    assert!(found.configuration[0] > std::f64::consts::PI, "the disc lies above the bar: {}", found.configuration);
}

#[test]
fn a_buried_arm_has_no_free_configuration() {
    let obstacles = vec![obstacle("rock", disc(Point::zeros(), 5.0))];
    let workspace = Workspace { name: String::new(), obstacles, clearance: 0.0, preferences: Vec::new() };
    assert_eq!(nearest_free(&placed(rr([JointRange::Circle; 2]), workspace), q(0.0, 0.0)), None);
}

#[test]
fn the_command_names_the_nearest_free_configuration() {
    let check = |at: &str| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_cplan"));
        let output = command.args(["check", "robots/planar_2r.urdf", "workspaces/shelf.toml", "--json", "--at", at]);
        let output = output.output().unwrap();
        assert!(output.status.success());
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    let blocked = check("10deg,0deg");
    let nearest = &blocked["nearest_free"];
    let [q1, q2] = [0, 1].map(|i| nearest["configuration"][i].as_f64().unwrap());
    let distance = nearest["distance"].as_f64().unwrap();
    assert!((distance - (q1 - 10f64.to_radians()).hypot(q2)).abs() < 1e-12);
    assert!(nearest["resolution"].as_f64().unwrap() > 0.0);
    let free = check(&format!("{q1},{q2}"));
    assert_eq!(free["free"], true);
    assert!(free.get("nearest_free").is_none());
}
