//! Checks that every feasible random task with lines has a valid certificate, and that falsified ones are refused.
//!
//! ```sh
//! CPLAN_TIMES=30 cargo test --profile quick --test planning certificates::followed_lines -- --nocapture
//! ```

use crate::followed_lines::{aside, world};
use cplan::engine::Method;
use cplan::input::Overrides;
use cplan::model::Status;
use cplan::plan;
use cplan_cases::dice::Dice;
use cplan_check_files::{CheckError, check};
use cplan_testkit::problems::problem_of_texts;
use cplan_testkit::shipped;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Tolerance of the lines of random worlds, metres.
const TOLERANCE: f64 = 5e-5;

#[derive(Debug, Default)]
struct Tally {
    found: u64,
    lines: usize,
    read: usize,
    refused: usize,
    longest: Duration,
}

/// Returns the world without the rounded corners of its lines, so that the checker reads these lines.
fn without_radius(world: &str) -> String {
    let sharp = |line: &str| match (line.starts_with("follow = { points"), line.split_once("], radius = ")) {
        (true, Some((points, rest))) => {
            let rest = rest.split_once(", ").map_or("", |(_, rest)| rest);
            format!("{points}], {rest}\n")
        }
        _ => format!("{line}\n"),
    };
    world.lines().map(sharp).collect()
}

/// Returns the joint values of a knot.
fn joints(certificate: &Value, knot: usize) -> [f64; 2] {
    [1, 2].map(|k| certificate["motion"]["knots"][knot][k].as_f64().unwrap())
}

/// A falsified certificate, with the words for it.
type Falsified = (&'static str, Value);

/// Returns falsified copies of a certificate. `step` is the index of a step along a line.
fn falsified(certificate: &Value, step: usize) -> Vec<Falsified> {
    let mut all = Vec::new();
    let mut add = |words, change: &dyn Fn(&mut Value)| {
        let mut changed = certificate.clone();
        change(&mut changed);
        all.push((words, changed));
    };
    let [first, last] = [0, 1].map(|k| certificate["steps"][step]["knots"][k].as_u64().unwrap() as usize);
    let middle = usize::midpoint(first, last);
    if first < middle {
        let [before, after] = [middle - 1, middle + 1].map(|knot| joints(certificate, knot).into());
        let [joint, by] = aside(before, after);
        let value = joints(certificate, middle)[joint as usize] + 4.0 * TOLERANCE * by;
        add("a knot beside the line", &|c| c["motion"]["knots"][middle][1 + joint as usize] = json!(value));
        let early = json!([first, last - 1]);
        add("a step that ends early", &|c| c["steps"][step]["knots"] = early.clone());
    }
    add("a missing step", &|c| drop(c["steps"].as_array_mut().unwrap().remove(step)));
    add("swapped steps", &|c| c["steps"].as_array_mut().unwrap().swap(step - 1, step));
    add("a step without its line", &|c| drop(c["steps"][step].as_object_mut().unwrap().remove("line")));
    add("a larger tolerance", &|c| c["steps"][step]["line"]["tolerance"] = json!(2.0 * TOLERANCE));
    add("a missing place", &|c| drop(c["steps"][step]["line"]["places"].as_array_mut().unwrap().pop()));
    add("another line", &|c| {
        let pieces = c["steps"][step]["line"]["pieces"].as_array_mut().unwrap();
        pieces.iter_mut().for_each(|piece| moved(piece, 0.0, 4.0 * TOLERANCE));
    });
    add("a line that ends elsewhere", &|c| {
        let pieces = c["steps"][step]["line"]["pieces"].as_array_mut().unwrap();
        let last = pieces.len() - 1;
        match pieces[last].get_mut("arc") {
            Some(arc) => arc["by"] = json!(arc["by"].as_f64().unwrap() * 1.1),
            None => moved(&mut pieces[last], 4.0 * TOLERANCE, 0.0),
        }
    });
    all
}

/// Moves the last point of a straight line or a cubic by `last` metres along both axes, and all points by `whole`.
fn moved(piece: &mut Value, last: f64, whole: f64) {
    let shift = |point: &mut Value, by: f64| (0..2).for_each(|k| point[k] = json!(point[k].as_f64().unwrap() + by));
    if let Some(arc) = piece.get_mut("arc") {
        return shift(&mut arc["center"], whole);
    }
    let points = piece.as_object_mut().unwrap().values_mut().next().unwrap().as_array_mut().unwrap();
    let count = points.len();
    points.iter_mut().for_each(|point| shift(point, whole));
    shift(&mut points[count - 1], last);
}

fn certified(seed: u64, tally: &mut Tally) {
    let mut dice: Dice = cplan_cases::dice(seed);
    let drawn = world(&mut dice);
    let world = if seed.is_multiple_of(2) { without_radius(&drawn) } else { drawn };
    let urdf = std::fs::read_to_string(shipped::robot("planar_2r")).unwrap();
    let Ok(problem) = problem_of_texts(&urdf, &world) else { return };
    let answer = plan(&problem, &Method::Visibility.into()).unwrap();
    if answer.status() != Status::Found {
        return;
    }
    let certificate = answer.certificate(&Overrides::default(), None).unwrap();
    let begun = Instant::now();
    let judged = check(&urdf, &world, &certificate);
    tally.longest = tally.longest.max(begun.elapsed());
    let report = judged.unwrap_or_else(|why| panic!("seed {seed}: {why:?}\n{world}"));
    let certificate: Value = serde_json::from_str(&certificate).unwrap();
    let steps = certificate["steps"].as_array().unwrap();
    let lines: Vec<usize> = (0..steps.len()).filter(|index| steps[*index].get("line").is_some()).collect();
    assert_eq!(report.matches("the tip follows").count(), lines.len(), "seed {seed}: {report}");
    tally.found += 1;
    tally.lines += lines.len();
    tally.read += lines.len() - report.matches("as the certificate states it").count();
    for (words, changed) in falsified(&certificate, lines[seed as usize % lines.len()]) {
        match check(&urdf, &world, &changed.to_string()) {
            Err(CheckError::Fails(_)) => {}
            Err(CheckError::Input { .. }) if ["a step without its line", "a larger tolerance"].contains(&words) => {}
            other => panic!("seed {seed}, {words}: {other:?}\n{world}"),
        }
        tally.refused += 1;
    }
}

#[test]
fn tasks_with_lines_have_certificates() {
    let mut tally = Tally::default();
    let seeds = cplan_cases::seeds(32);
    let count = seeds.end - seeds.start;
    for seed in seeds {
        certified(seed, &mut tally);
    }
    println!("of {count}: {tally:?}");
    assert!(tally.found * 4 > count && tally.read > 0 && tally.read < tally.lines, "{tally:?}");
    assert!(tally.refused as u64 >= 7 * tally.found, "{tally:?}");
}
