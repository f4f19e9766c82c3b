//! Joints on circles, many turns from zero. A proof there is checked against the true start.

use super::*;
use cplan::check::{Cell, CollisionBox, ProofError};
use cplan::input::{LoadedScene, load_scene};
use cplan::model::Pair;
use cplan::space::Configuration;
use cplan_testkit::problems::recheck;
use std::f64::consts::{PI, TAU};

/// A world with a wall that the first link touches at an angle between 0.4 and 1.
const WALL: &str =
    "[goal]\njoints = [-2.5, 0.3]\n[[obstacle]]\npolygon = [[0.6, 0.6], [0.9, 0.6], [0.9, 0.9], [0.6, 0.9]]\n";

fn scene(place: &Place) -> LoadedScene {
    place.write("world.toml", WALL);
    load_scene(shipped("robots/planar_2r_continuous.urdf"), &place.path("world.toml")).unwrap()
}

/// Angle of the second link that keeps it away from the wall, in radians.
const FOLDED: f64 = -2.0;

/// Returns the greatest angle at which the first link is free, to the last bit.
fn last_free(scene: &LoadedScene) -> f64 {
    let is_free = |q1: f64| scene.scene.clearance(Configuration::new(q1, FOLDED)) > 0.0;
    let (mut free, mut hit) = (0.0, PI / 4.0);
    assert!(is_free(free) && !is_free(hit));
    while (hit - free) > 2.0 * f64::EPSILON {
        let middle = (free + hit) / 2.0;
        if is_free(middle) { free = middle } else { hit = middle }
    }
    free
}

/// Returns starts, many turns from zero, that are free by some picoradians. Each comes with a second value: what
/// remains if multiples of 2 pi, rounded to a double, are subtracted. That value collides.
fn starts(last_free: f64) -> impl Iterator<Item = (f64, f64)> {
    (70_000..159_000_u32).filter_map(move |turns| {
        let start = last_free - 2e-11 + f64::from(turns) * TAU;
        let careless = (start + PI).rem_euclid(TAU) - PI;
        Some((start, careless)).filter(|(_, careless)| *careless > last_free + 8e-12)
    })
}

/// Returns a tiny box around a configuration in which the first link is in the wall.
fn stuck(q1: f64) -> CollisionBox {
    let cell = Cell { lower: [q1 - 1e-14, FOLDED - 1e-14], upper: [q1 + 1e-14, FOLDED + 1e-14] };
    CollisionBox { cell, pair: Pair { link: 0, part: 0, obstacle: 0, piece: 0 } }
}

#[test]
fn a_start_half_a_million_radians_from_zero_is_not_moved_into_a_stuck_box() {
    let place = Place::new();
    let loaded = scene(&place);
    let scene = &loaded.scene;
    let free = |q1: f64| scene.clearance(Configuration::new(q1, FOLDED)) > 0.0;
    let candidates: Vec<(f64, f64)> =
        starts(last_free(&loaded)).filter(|(start, careless)| free(*start) && !free(*careless)).collect();
    assert!(candidates.len() > 100, "{}", candidates.len());
    let goal = Configuration::new(-2.5, 0.3);
    let tried = usize::try_from(cplan_cases::times(60)).unwrap();
    let step = (candidates.len() / tried).max(1);
    for &(start, careless) in candidates.iter().step_by(step) {
        let verdict = recheck(&[stuck(careless)], scene, Configuration::new(start, FOLDED), &goal.into(), 0.0);
        assert_eq!(verdict, Err(ProofError::NotSeparated(0)), "{start} is not {careless}");
    }

    // The same through the program.
    let (start, careless) = candidates[0];
    let CollisionBox { cell, .. } = stuck(careless);
    place.write(
        "proof.json",
        format!(
            "{{\"status\": \"infeasible\", \"proof\": [{{\"lower\": [{:?}, {:?}], \"upper\": [{:?}, {:?}], \"link\": 0, \
             \"part\": 0, \"obstacle\": 0, \"piece\": 0}}]}}",
            cell.lower[0], cell.lower[1], cell.upper[0], cell.upper[1]
        ),
    );
    let robot = shipped("robots/planar_2r_continuous.urdf");
    let start = format!("{start:?},{FOLDED}");
    let done = place.run(&["recheck", &robot, "world.toml", "--proof", "proof.json", "--start", &start], "");
    assert_ne!(done.code, 0, "{}", done.stdout);
    done.warns(&["do not separate the goal from the start"]);
}

#[test]
fn plans_and_proofs_many_turns_from_zero_are_those_at_zero() {
    let place = Place::new().with("world.toml", WALL);
    let robot = shipped("robots/planar_2r_continuous.urdf");
    for turns in [0.0, 79_577.0, -159_000.0] {
        let start = format!("{:?},{:?}", 2.6 + TAU * turns, FOLDED);
        let done = place.run(&[&robot, "world.toml", "--start", &start, "--json"], "").exits(0);
        let result = done.json();
        assert!((number(&result["path"][0][0]) - (2.6 + TAU * turns)).abs() < 1e-9, "{}", result["path"]);
        assert!(number(&result["clearance"]) > 0.0);
        place.write("plan.json", done.stdout);
        place.run(&["verify", &robot, "world.toml", "plan.json", "--start", &start], "").exits(0);
    }
    // Beyond a million radians, doubles are too coarse.
    let done = place.run(&[&robot, "world.toml", "--start", "1e7,0"], "");
    assert_ne!(done.code, 0);
    done.warns(&["too large"]);
}

#[test]
fn files_without_an_end_are_refused() {
    #[cfg(unix)]
    {
        let place = Place::new().with("world.toml", WALL);
        let robot = shipped("robots/planar_2r_continuous.urdf");
        let done =
            place.run(&["recheck", &robot, "world.toml", "--proof", "/dev/zero", "--start", "2.6,-2"], "").exits(1);
        done.warns(&["/dev/zero", "larger than"]);
        for name in ["zero.json", "zero.csv", "zero.yaml", "zero.mcap"] {
            std::os::unix::fs::symlink("/dev/zero", place.path(name)).unwrap();
            let done = place.run(&["verify", &robot, "world.toml", name], "").exits(1);
            assert!(cfg!(not(feature = "mcap")) || done.stderr.contains("larger than"), "{}", done.stderr);
        }
    }
}
