//! Lines with pieces far below the tolerance: hooks, hairpins, closings, dots and micrometre steps.

use super::{BARS, ORIGIN, check, gantry, gantry_tips, scene_of, stroke};
use cplan_cases::dice::Dice;
use cplan_follow::{Cause, Found, Settings, follow};
use cplan_model::Outcome;
use cplan_testkit::follow_oracle::{Point, pass_together, points};
use cplan_text::metres;
use cplan_toolpath::{Curve, Piece, Placement, Toolpath};
use std::f64::consts::TAU;

fn straight(from: Point, to: Point) -> Piece {
    Piece { speed: Some(0.1), ..stroke(Curve::Line { from, to }, 1) }
}

/// Returns the pieces of a polyline.
fn through(corners: &[Point]) -> Vec<Piece> {
    corners.windows(2).map(|pair| straight(pair[0], pair[1])).collect()
}

fn line(pieces: Vec<Piece>) -> Toolpath {
    Toolpath::new(pieces).expect("a line")
}

fn travel(piece: Piece) -> Piece {
    Piece { is_travel: true, speed: None, ..piece }
}

/// Follows a line with the gantry, and compares both by dense points in their order.
fn followed(line: &Toolpath, tolerance: f64) -> Result<Found, String> {
    let settings = Settings { tolerance, ..Settings::default() };
    match follow(&gantry(None), line, &settings).expect("usable settings") {
        Outcome::Found(found) => {
            assert!(found.deviation <= tolerance);
            let step = tolerance / 8.0;
            assert!(pass_together(&gantry_tips(&found, step), &points(line, step), found.deviation + step), "{line:?}");
            Ok(found)
        }
        Outcome::Infeasible(proof) => Err(format!("infeasible: {}", proof.describe())),
        Outcome::Unknown(why) => Err(why),
    }
}

#[test]
fn a_hook_before_a_corner_is_followed_at_every_tolerance() {
    for size in [1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 5e-6] {
        let corner = [0.337, 0.21];
        let hook = [corner[0] - 0.9 * size, corner[1] + 0.5 * size];
        let line = line(through(&[[0.33, 0.21], corner, hook, [0.33, 0.202]]));
        for tolerance in [1e-6, 1e-5, 1e-4, 1e-3] {
            followed(&line, tolerance).unwrap_or_else(|why| panic!("{size} {tolerance}: {why}"));
        }
    }
}

#[test]
fn a_hook_before_a_travel_is_followed() {
    for size in [1e-9, 1e-8, 1e-7, 1e-6] {
        let mut pieces = through(&[[0.3, 0.2], [0.31, 0.2], [0.31 - size, 0.2 + size], [0.305, 0.205], [0.306, 0.2]]);
        pieces[2] = travel(pieces[2]);
        let found = followed(&line(pieces), 1e-5).expect("found");
        let stops = found.timed.trajectory.velocity.iter().filter(|v| v[0].hypot(v[1]) < 1e-9).count();
        assert!(stops >= 4, "it stops at both ends of the travel and of the line: {stops}");
    }
}

/// A circle of two arcs that `Z` closes. The ends differ by rounding.
#[test]
fn the_closing_of_a_circle_by_rounding_is_followed() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 100 100'>\
               <path d='m 32.92839,34.43654 0,3 m 11.89854,-3 A 2.44561,2.44561 0 0 0 39.93571,34.43654 \
               2.44561,2.44561 0 0 0 44.82693,34.43654 Z M 5,5 L 9,9'/></svg>";
    let placement = Placement { shift: [0.3, 0.2], ..Placement::default() };
    let line = cplan_drawing::read_line(svg.as_bytes(), &placement).expect("a line");
    assert!(line.pieces().iter().any(|piece| piece.curve.length() < 1e-15), "no closing by rounding");
    followed(&line, 1e-5).expect("found");
}

/// The way back begins within the tolerance of the way there.
#[test]
fn hairpins_narrower_than_the_tolerance_are_followed() {
    for gap in [0.0, 1e-8, 1e-6, 4e-6, 9e-6] {
        for length in [3e-6, 1e-4, 4e-3] {
            let [x, y] = [0.3, 0.2];
            let turn = [[x + length, y], [x + length, y + gap], [x, y + gap], [x, y + gap + 2e-3]];
            let mut corners = vec![[x - 2e-3, y], [x, y]];
            corners.extend(turn);
            corners.dedup();
            followed(&line(through(&corners)), 1e-5).unwrap_or_else(|why| panic!("{gap} {length}: {why}"));
        }
    }
}

/// Hatches a strip by lines that are nearer to each other than the tolerance, and farther apart.
#[test]
fn hatched_strips_are_followed() {
    for pitch in [2e-6, 8e-6, 2.5e-5, 2e-4] {
        let corner =
            |k: u32| [0.3 + if (k / 2).is_multiple_of(2) { 0.0 } else { 1e-3 }, 0.2 + f64::from(k.div_ceil(2)) * pitch];
        let corners: Vec<Point> = (0..24)
            .map(|k| {
                let [x, y] = corner(k);
                [if k % 2 == 1 { 0.6 + 1e-3 - x } else { x }, y]
            })
            .collect();
        followed(&line(through(&corners)), 1e-5).unwrap_or_else(|why| panic!("{pitch}: {why}"));
    }
}

/// An arc written as straight pieces of 50 nm, with noise: planned as a few chords, at the speed of the smooth arc.
#[test]
fn micrometre_steps_do_not_slow_the_tip() {
    let mut dice = cplan_cases::dice(7);
    let at = |k: u32| {
        let angle = f64::from(k) / 40_000.0;
        [0.3 + 2e-3 * angle.cos(), 0.2 + 2e-3 * angle.sin()]
    };
    let mut noisy = |k: u32| at(k).map(|x| x + dice.within(-2e-8, 2e-8));
    let steps: Vec<Point> = (0..20_000).map(&mut noisy).collect();
    let found = followed(&line(through(&steps)), 1e-5).expect("found");
    assert!(found.waypoints < 200, "{}", found.waypoints);
    let duration = found.timed.trajectory.duration();
    // A millimetre at 0.1 m/s, and a start and a stop with 4 m/s2.
    assert!(duration < 0.04, "{duration}");
}

/// Dots of a stippled drawing are strokes of nanometres between travels.
#[test]
fn the_tip_stops_at_each_dot() {
    let dots: Vec<Point> = (0..20).map(|k| [0.3 + 1e-3 * f64::from(k), 0.2 + 1e-4 * f64::from(k % 3)]).collect();
    let mut pieces = vec![straight([0.29, 0.2], dots[0])];
    for (k, dot) in dots.iter().enumerate() {
        let end = [dot[0] + 2e-8, dot[1]];
        pieces.push(straight(*dot, end));
        if let Some(next) = dots.get(k + 1) {
            pieces.push(travel(straight(end, *next)));
        }
    }
    let found = followed(&line(pieces), 1e-5).expect("found");
    let trajectory = &found.timed.trajectory;
    for dot in &dots[..dots.len() - 1] {
        let stops = trajectory.position.iter().zip(&trajectory.velocity).any(|(q, v)| {
            let off = (ORIGIN[0] + q[0] - dot[0]).hypot(ORIGIN[1] + q[1] - dot[1]);
            off < 1e-6 && v[0].hypot(v[1]) < 1e-9
        });
        assert!(stops, "{dot:?}");
    }
}

#[test]
fn a_line_that_is_tiny_as_a_whole_is_followed() {
    let around = |k: u32| [0.3 + 1e-7 * f64::from(k).sin(), 0.2 + 1e-7 * f64::from(k).cos()];
    let found = followed(&line(through(&(0..50).map(around).collect::<Vec<_>>())), 1e-5).expect("found");
    assert!(found.timed.trajectory.duration() < 0.01);
}

/// Returns a line with tiny parts, and the same line without them.
fn spoilt(dice: &mut Dice, start: Point, tolerance: f64) -> [Toolpath; 2] {
    let (mut clean, mut spoilt) = (Vec::new(), Vec::new());
    let (mut at, mut end) = (start, start);
    for _ in 0..3 + dice.within(0.0, 4.0) as usize {
        let next = [0, 1].map(|k| at[k] + dice.within(-2e-3, 2e-3));
        let (is_travel, is_curved) = (dice.chance(0.2), dice.chance(0.4));
        let control = [dice.within(-1e-3, 1e-3), dice.within(-1e-3, 1e-3)];
        let piece = |from: Point| match (is_travel, is_curved) {
            (true, _) => travel(straight(from, next)),
            (_, false) => straight(from, next),
            (_, true) => {
                let [a, b] = [[from[0] + control[0], from[1]], [next[0], next[1] + control[1]]];
                Piece { curve: Curve::Cubic([from, a, b, next]), ..straight(from, next) }
            }
        };
        clean.push(piece(at));
        spoilt.push(piece(end));
        (at, end) = (next, next);
        let size = tolerance * 10_f64.powf(dice.within(-6.0, -0.2));
        let aside = |dice: &mut Dice| {
            let angle = dice.within(0.0, TAU);
            [at[0] + size * angle.cos(), at[1] + size * angle.sin()]
        };
        let mut corners = vec![end];
        match dice.within(0.0, 4.0) as u32 {
            0 => corners.push(aside(dice)),
            1 => corners.extend([aside(dice), at]),
            2 => (0..1 + dice.within(0.0, 40.0) as usize).for_each(|_| corners.push(aside(dice))),
            _ => {
                // Steps in one direction, with one step back.
                let along = [size / 2.0, size / 3.0];
                let steps = [1.0, 2.0, 1.5, 3.0, 4.0];
                corners.extend(steps.map(|step| [at[0] + step * along[0], at[1] + step * along[1]]));
            }
        }
        end = corners[corners.len() - 1];
        spoilt.extend(through(&corners));
    }
    [line(clean), line(spoilt)]
}

#[test]
fn random_lines_with_tiny_parts_are_followed() {
    let (mut count, mut unknown) = (0, Vec::new());
    for seed in cplan_cases::seeds(60) {
        let mut dice = cplan_cases::dice(seed);
        let tolerance = [2e-6, 1e-5, 1e-4][(seed % 3) as usize];
        let is_gantry = dice.chance(0.5);
        let start = if is_gantry { [0.4, 0.3] } else { [1.1, 0.2] };
        let [clean, spoilt] = spoilt(&mut dice, start, tolerance);
        count += 1;
        if is_gantry {
            followed(&clean, tolerance).unwrap_or_else(|why| panic!("{seed}: {why}"));
            unknown.extend(followed(&spoilt, tolerance).err().map(|why| format!("{seed}: {why}")));
            continue;
        }
        let (scene, settings) = (scene_of(BARS, 3.0, vec![]), Settings { tolerance, ..Settings::default() });
        match follow(&scene, &spoilt, &settings).expect("usable settings") {
            Outcome::Found(found) => drop(check(&BARS, &scene, &spoilt, &settings, &found)),
            other => unknown.push(format!("{seed}: {other:?}")),
        }
    }
    assert!(unknown.is_empty(), "{} of {count}: {unknown:#?}", unknown.len());
}

/// The line ends beyond the reach of the arm by a share of the tolerance.
#[test]
fn places_out_of_reach_by_less_than_the_tolerance_are_followed() {
    let (scene, settings) = (scene_of(BARS, 3.0, vec![]), Settings::default());
    for share in [0.1, 0.5, 0.8, 0.95, 0.99] {
        let end = 1.8 + share * settings.tolerance;
        let angle = 0.3_f64;
        let line = line(through(&[[1.5, 0.4], [end * angle.cos(), end * angle.sin()]]));
        match follow(&scene, &line, &settings).expect("usable settings") {
            Outcome::Found(found) => drop(check(&BARS, &scene, &line, &settings, &found)),
            other => panic!("{share}: {other:?}"),
        }
    }
}

#[test]
fn an_answer_near_the_end_of_the_reach_names_the_place() {
    let (scene, settings) = (scene_of(BARS, 3.0, vec![]), Settings::default());
    let line = |by: f64| line(through(&[[1.0, 0.0], [1.5, 0.0], [1.8 + by, 0.0]]));
    let Outcome::Infeasible(proof) = follow(&scene, &line(1.01e-5), &settings).expect("usable settings") else {
        panic!("a place farther out of reach than the tolerance");
    };
    assert!(matches!(proof.cause, Cause::OutOfReach { by } if (by - 1.01e-5).abs() < 1e-9), "{proof:?}");
    // Hardly less than the tolerance: not enough room for any bound.
    match follow(&scene, &line(0.999_99e-5), &settings).expect("usable settings") {
        Outcome::Unknown(why) => {
            assert!(why.starts_with("800.0 mm of the line") && why.contains("out of reach"), "{why}")
        }
        other => panic!("{:?}", other.status()),
    }
}

#[test]
fn an_unknown_answer_names_a_tolerance_that_works() {
    let (scene, settings) = (scene_of(BARS, 3.0, vec![]), Settings::default());
    let line = line(through(&[[1.0, 0.0], [1.8 + 0.999_99 * settings.tolerance, 0.0]]));
    let Outcome::Unknown(why) = follow(&scene, &line, &settings).expect("usable settings") else {
        panic!("no room is left beside the end");
    };
    let (_, advice) = why.split_once("; a motion is found with `--tolerance ").unwrap_or_else(|| panic!("{why}"));
    let text = advice.trim_end_matches('`');
    assert!(["0.02mm", "0.05mm"].contains(&text), "{why}");
    let wider = Settings { tolerance: metres(text).expect("a length"), ..settings };
    let answer = follow(&scene, &line, &wider).expect("usable settings");
    assert!(matches!(answer, Outcome::Found(_)), "{text}: {:?}", answer.status());
}

#[test]
fn lengths_have_optional_units() {
    assert_eq!([metres("0.05mm"), metres("5e-5"), metres("50 um")], [Ok(0.05 * 1e-3), Ok(5e-5), Ok(5e-5)]);
    assert!(metres("mm").is_err() && metres("5 furlongs").is_err());
}
