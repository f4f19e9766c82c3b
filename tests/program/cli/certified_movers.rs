//! Certificates of plans among moving obstacles, and the verdict of the checker, which shares no code with the program.

use super::*;
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use std::f64::consts::PI;
use std::fmt::Write;

/// Names of shipped worlds with moving obstacles or objects.
const WORLDS: [&str; 8] =
    ["belt_pick", "belt_stop", "cart_in_task", "conveyor", "crossing", "gate", "swing", "traffic"];

#[test]
fn every_shipped_motion_among_moving_obstacles_has_a_valid_certificate() {
    let robot = shipped("robots/planar_2r.urdf");
    for name in WORLDS {
        let (place, world) = (Place::new(), shipped(&format!("workspaces/moving/{name}.toml")));
        let (done, report) = place.certified(&robot, &world, "--quiet --output m.json --output m.csv", 0);
        done.succeeds_silently();
        let is_task = ["belt_pick", "belt_stop", "cart_in_task"].contains(&name);
        has(&report, &[if is_task { "steps from the start" } else { "is shorter than" }]);
        // Recordings have certificates too, by the interpolation of their format. A table does not state which step
        // ends when.
        for file in if is_task { &["m.json"][..] } else { &["m.json", "m.csv"] } {
            place.run(&["verify", &robot, &world, file], "--quiet --certificate v.json").succeeds_silently();
            let report = place.judged([&robot, &world, "v.json"]);
            assert!(report.is_ok(), "{name} {file}: {report:?}");
        }
    }
    // If the only path is closed for ever, the program writes no certificate.
    let place = Place::new();
    let unknown =
        place.run(&[robot, shipped("workspaces/moving/parked.toml")], "--quiet --certificate c.json").exits(4);
    unknown.warns(&["claims nothing"]);
    assert!(!place.path("c.json").exists());
}

/// Checks that the certificate of a motion does not hold in a world where the cart comes half a second later, nor in
/// one without the cart.
#[test]
fn a_certificate_does_not_hold_for_another_time() {
    let (place, robot, world) =
        (Place::new(), shipped("robots/planar_2r.urdf"), shipped("workspaces/moving/crossing.toml"));
    place.run(&[&robot, &world], "--quiet --certificate c.json").exits(0);
    let certificate = super::certificates::without_digests(&place.read("c.json"));
    let (urdf, text) = (read(&robot), read(&world));
    check(&urdf, &text, &certificate).unwrap();
    let later = |by: f64| {
        let mut parts = text.split("time = ");
        let mut world = parts.next().unwrap().to_owned();
        for part in parts {
            let end = part.find(|c: char| c != '.' && !c.is_ascii_digit()).unwrap();
            let time: f64 = part[..end].parse().unwrap();
            let _ = write!(world, "time = {:?}{}", time + by, &part[end..]);
        }
        world
    };
    check(&urdf, &later(0.0), &certificate).unwrap();
    let judged = check(&urdf, &later(0.5), &certificate);
    assert!(matches!(&judged, Err(CheckError::Fails(why)) if why.contains("obstacle")), "{judged:?}");
}

/// Draws static posts, and discs, triangles and bars that pass by and may turn.
fn drawn(dice: &mut Dice) -> String {
    let spot = |dice: &mut Dice| {
        let (angle, radius) = (dice.within(-PI, PI), dice.within(0.5, 1.9));
        [radius * angle.cos(), radius * angle.sin()]
    };
    let q = |dice: &mut Dice| [dice.within(-2.0, 2.0), dice.within(-2.0, 2.0)];
    let mut text = format!("start.joints = {:?}\ngoal.joints = {:?}\n", q(dice), q(dice));
    for _ in 0..dice.below(3_usize) {
        let _ = write!(text, "[[obstacle]]\ncircle = {{ center = {:?}, radius = 0.05 }}\n", spot(dice));
    }
    for _ in 0..2 + dice.below(3_usize) {
        let size = dice.within(0.05, 0.2);
        let shape = match dice.below(3) {
            0 => format!("circle = {{ center = [0.0, 0.0], radius = {size:?} }}"),
            1 => format!("polygon = [[0.0, {size:?}], [-{size:?}, -{size:?}], [{size:?}, -{size:?}]]"),
            _ => format!("polyline = [[-{size:?}, 0.0], [{size:?}, 0.0]]"),
        };
        let (near, angle) = (spot(dice), dice.within(-PI, PI));
        let speed = dice.within(0.1, 1.0);
        let velocity = [speed * angle.cos(), speed * angle.sin()];
        let (first, span, spin) = (dice.within(0.0, 1.0), dice.within(1.0, 4.0), dice.within(-2.0, 2.0));
        let at = |time: f64| [0, 1].map(|k| near[k] + velocity[k] * time);
        let (from, to) = (at(-span / 2.0), at(span / 2.0));
        let last = first + span;
        let leaves = if dice.chance(0.5) { velocity } else { [0.0; 2] };
        let _ = write!(
            text,
            "[[obstacle]]\n{shape}\nmotion = {{ velocity = {leaves:?}, stops = [{{ time = {first:?}, at = {from:?} }}, \
             {{ time = {last:?}, at = {to:?}, angle = {spin:?} }}] }}\n"
        );
    }
    text
}

#[test]
fn certificates_among_random_moving_obstacles_hold() {
    let (robot, mut found, mut waited) = (shipped("robots/planar_2r.urdf"), 0, 0);
    for seed in seeds(24) {
        let (place, mut dice) = (Place::new(), Dice::new(seed ^ 0x6d6f_7665));
        let done = place.run_in(&robot, drawn(&mut dice), "--certificate c.json");
        // If start or goal is blocked, there is nothing to plan.
        if done.code != 0 {
            continue;
        }
        let judged = place.judged([&robot, "world.toml", "c.json"]);
        assert!(judged.is_ok(), "{seed}: {judged:?}\n{}", place.read("world.toml"));
        found += 1;
        waited += usize::from(done.stdout.contains("\nwaits "));
    }
    println!("{found} found, {waited} with waits");
    assert!(!uses_default_cases() || (found > 8 && waited > 0), "{found} found, {waited} with waits");
}

/// Checks an object that stands still during a part of its trajectory. It has no direction of motion there.
#[test]
fn obstacles_waiting_out_of_reach_stay_out_of_reach() {
    let place = Place::new();
    let urdf = shipped("robots/planar_2r.urdf");
    let world = "[start]\njoints = [0.4, 1.0]\n[[object]]\nname = \"p\"\ncircle = { center = [0, 0], radius = 0.05 }\nat = [2.5, 0.0]\n\
                 motion = { stops = [{ time = 1.0, at = [2.5, 0.1] }, { time = 2.0, at = [2.8, 1.0] }] }\n\
                 [[step]]\npick = \"p\"\n[[step]]\nplace = { at = [0.3, 1.35] }\n";
    place.run_in(&urdf, world, "").exits(3).says(&["not within the arm's reach at any time"]);
}

/// Checks a pick at the very beginning of its window, which is not a whole nanosecond. The plan uses the first whole
/// nanosecond within it.
#[test]
fn a_pick_at_the_beginning_of_its_window_is_within_it() {
    let (place, urdf) = (Place::new(), shipped("robots/planar_2r.urdf"));
    let shipped = read(shipped("workspaces/moving/belt_pick.toml"));
    let mut rounded_down = 0;
    for k in 0..6 {
        let [from, to] = [2.120_956_725_469_559_8 + 0.201_3 * f64::from(k), 6.0];
        let world =
            shipped.replacen("pick = \"bottle 1\"", &format!("pick = \"bottle 1\"\nwindow = [{from:?}, {to:?}]"), 1);
        place.write("world.toml", world);
        let picked = number(&place.certified(&urdf, "world.toml", "--json", 0).0.json()["steps"][0]["arrival"]);
        assert!(from <= picked && picked <= to, "{from}: {picked}");
        rounded_down += usize::from(picked < from + 1e-9 && (picked - from) > 5e-10);
    }
    assert!(rounded_down > 0, "no pick was at the beginning of its window");
}
