//! Checks that every feasible random task has a valid certificate, and that infeasible ones have none.
//!
//! ```sh
//! CPLAN_TIMES=100 cargo test --profile quick --test planning certificates::tasks -- --nocapture
//! ```

use super::KINDS;
use super::drawn::{Drawn, V};
use cplan::engine::{Method, NoCertificate};
use cplan::input::Overrides;
use cplan::model::Status;
use cplan::plan;
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_check_files::{CheckError, check};
use cplan_testkit::problems::problem_of_texts;
use serde_json::Value;
use std::fmt::Write;
use std::time::{Duration, Instant};

#[derive(Debug, Default)]
struct Tally {
    asked: usize,
    done: [usize; KINDS as usize],
    rigid: usize,
    turned: usize,
    resting: usize,
    free_order: usize,
    falsified: usize,
    infeasible: usize,
    longest: Duration,
}

/// Returns a world file with objects, and steps that pick and place them, for an arm among its obstacles.
fn world(dice: &mut Dice, drawn: &Drawn, mut free: impl FnMut(&mut Dice) -> Option<V>) -> Option<String> {
    let scale = drawn.scale;
    let has_wrist = (drawn.at, drawn.angle) == ([0.0; 2], 0.0);
    let mut text = format!("start.joints = {:?}\n", free(dice)?);
    let is_free = dice.chance(0.3);
    if is_free {
        text += "task.order = \"free\"\n";
    }
    if has_wrist {
        text += "robot.wrist = { velocity = 3.0 }\n";
    }
    text += &drawn.world(false);
    let mut steps = String::new();
    for number in 0..1 + dice.below(2) {
        let [from, to] = [free(dice)?, free(dice)?].map(|q| drawn.tip(q));
        let size = scale * dice.within(0.01, 0.06);
        let polygon = |corners: &[V]| {
            let corners: Vec<V> = corners.iter().map(|p| p.map(|c| c * size)).collect();
            format!("polygon = {corners:?}")
        };
        let outline = match dice.below(4) {
            0 => format!("circle = {{ center = [0.0, {:?}], radius = {size:?} }}", 0.2 * size),
            1 => polygon(&[[0.0, 0.0], [2.0, 0.3], [1.5, 1.0], [-0.4, 0.9]]),
            2 => polygon(&[[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]]),
            // An object in the form of an L.
            _ => polygon(&[[0.0, 0.0], [1.5, 0.0], [1.5, 0.5], [0.5, 0.5], [0.5, 1.5], [0.0, 1.5]]),
        };
        let is_level = dice.chance(0.5);
        let _ = writeln!(
            text,
            "[[object]]\nname = \"part {number}\"\n{outline}\nat = {from:?}\nangle = {:?}\npayload = \"{}\"",
            dice.within(-4.0, 4.0),
            if is_level { "level" } else { "rigid" }
        );
        if dice.chance(0.3) {
            let _ = writeln!(text, "grasp = [{:?}, {:?}]", dice.within(-1.0, 1.0) * size, 0.1 * size);
        }
        if dice.chance(0.3) {
            let _ = writeln!(text, "height = [0.0, {:?}]\nlift = {:?}", 0.02 * scale, dice.within(0.0, 0.1) * scale);
        }
        if dice.chance(0.3) {
            text += "supports = [\"obstacle 1\"]\n";
        }
        let angle = match is_level && has_wrist && dice.chance(0.5) {
            true => format!(", angle = {:?}", dice.within(-4.0, 4.0)),
            false => String::new(),
        };
        let _ = writeln!(
            steps,
            "[[step]]\npick = \"part {number}\"\n[[step]]\nplace = {{ at = {to:?}{angle} }}\ndwell = 0.1"
        );
    }
    if !is_free && dice.chance(0.5) {
        let _ = writeln!(steps, "[[step]]\nmove = {{ joints = {:?} }}", free(dice)?);
    }
    Some(text + &steps)
}

/// Plans tasks for the arm of this seed, and checks their certificates.
fn tasks(seed: u64, tally: &mut Tally) {
    let mut dice = Dice::new(seed.wrapping_mul(0x51a3_77c1_90d5_0b2f));
    let kind = seed % KINDS;
    let drawn = Drawn::new(&mut dice, kind);
    let urdf = drawn.urdf();
    let Some(scene) = drawn.scene() else { return };
    let free = |dice: &mut Dice| drawn.free(dice, &scene, 0.02 * drawn.scale);
    for _ in 0..3 {
        let Some(world) = world(&mut dice, &drawn, free) else { continue };
        let Ok(problem) = problem_of_texts(&urdf, &world) else { continue };
        tally.asked += 1;
        let answer = plan(&problem, &Method::First.into()).unwrap();
        if answer.status() == Status::Infeasible {
            let none = answer.certificate(&Overrides::default(), None);
            assert_eq!(none, Err(NoCertificate::Task), "seed {seed}: {urdf}\n{world}");
            tally.infeasible += 1;
        }
        if answer.status() != Status::Found {
            continue;
        }
        let certificate = answer.certificate(&Overrides::default(), None).unwrap();
        let begun = Instant::now();
        let judged = check(&urdf, &world, &certificate);
        tally.longest = tally.longest.max(begun.elapsed());
        assert!(judged.is_ok(), "seed {seed}: {judged:?}\n{urdf}\n{world}");
        tally.done[kind as usize] += 1;
        tally.rigid += usize::from(world.contains("rigid"));
        tally.turned += usize::from(certificate.contains("\"turn\""));
        tally.resting += usize::from(world.contains("supports"));
        tally.free_order += usize::from(world.contains("task.order"));
        // The object lies elsewhere, by more than any tolerance, so the certificate picks an object that is not there.
        let mut whole: Value = serde_json::from_str(&certificate).unwrap();
        let far = 1e-3 * drawn.scale.max(1.0);
        let Some((before, after)) = world.split_once("[[object]]") else { continue };
        let Some((x, _)) = after.split_once("at = [").and_then(|(_, rest)| rest.split_once(',')) else { continue };
        let moved: f64 = x.parse::<f64>().unwrap() + far;
        let lies = after.replacen(&format!("at = [{x},"), &format!("at = [{moved:?},"), 1);
        let elsewhere = format!("{before}[[object]]{lies}");
        let refused = check(&urdf, &elsewhere, &certificate);
        assert!(matches!(refused, Err(CheckError::Fails(_))), "seed {seed}: {refused:?}\n{elsewhere}");
        whole["steps"].as_array_mut().unwrap().pop();
        let refused = check(&urdf, &world, &whole.to_string());
        assert!(matches!(refused, Err(CheckError::Fails(_))), "seed {seed}: {refused:?}");
        tally.falsified += 2;
    }
}

#[test]
fn certificates_of_random_tasks_hold() {
    let mut tally = Tally::default();
    for seed in seeds(16) {
        tasks(seed, &mut tally);
    }
    println!("{tally:?}");
    if uses_default_cases() {
        let some = [tally.rigid, tally.turned, tally.resting, tally.free_order, tally.falsified];
        let is_some = some.iter().all(|n| *n > 0) && tally.infeasible > 0;
        assert!(tally.done.iter().all(|n| *n > 0) && is_some, "{tally:?}");
    }
}
