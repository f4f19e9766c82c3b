//! Every random task that can be done has a certificate that holds, and so have those that cannot but for the kinds of proofs that are said
//! to have none.
//!
//! ```sh
//! CPLAN_TIMES=100 cargo test --profile quick --test planning certificates::tasks -- --nocapture
//! ```

use super::drawn::{Drawn, V};
use super::{KINDS, TRIES};
use crate::common::dice::Dice;
use crate::common::random::{seeds, usual};
use cplan::input::{self, Overrides, Source};
use cplan::model::Status;
use cplan::space::Configuration;
use cplan::{Planner, Problem, plan};
use cplan_check::{CheckError, check};
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
    impossible: usize,
    step_by_step: usize,
    carrying: usize,
    without: usize,
    longest: Duration,
}

/// Where walls may be put into a world.
const WALLS: &str = "# walls\n";

/// Objects, and steps that pick and place them, for an arm among its obstacles: the text of a world.
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
    text += WALLS;
    let mut steps = String::new();
    for number in 0..1 + dice.below(2) {
        let [from, to] = [free(dice)?, free(dice)?].map(|q| drawn.tip(q));
        let size = scale * dice.within(0.01, 0.06);
        let kind = dice.below(4);
        let outline = match kind {
            0 => format!("circle = {{ center = [0.0, {:?}], radius = {size:?} }}", 0.2 * size),
            1 => format!(
                "polygon = {:?}",
                [[0.0, 0.0], [2.0, 0.3], [1.5, 1.0], [-0.4, 0.9]].map(|p| p.map(|c| c * size))
            ),
            2 => format!(
                "polygon = {:?}",
                [[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]].map(|p| p.map(|c| c * size))
            ),
            // Like an L.
            _ => {
                let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
                format!("polygon = {:?}", corners.map(|p| p.map(|c| 0.5 * c * size)))
            }
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

/// Two walls, so many times as far away as things are.
fn walls(dice: &mut Dice, drawn: &Drawn, far: f64) -> String {
    let mut text = String::new();
    for number in 0..2 {
        let [x, y] = drawn.tip(drawn.joints.map(|joint| {
            let [low, high] = joint.range.unwrap_or([-3.2, 3.2]);
            dice.within(low, high)
        }));
        let [half, thin] = [dice.within(0.1, 0.6), dice.within(0.01, 0.05)].map(|side| side * drawn.scale);
        let [half, thin] = if dice.chance(0.5) { [half, thin] } else { [thin, half] };
        let away = (far - 1.0) * drawn.scale;
        let corners = [[-half, -thin], [half, -thin], [half, thin], [-half, thin]].map(|[a, b]| [x + a + away, y + b]);
        let _ = writeln!(text, "[[obstacle]]\nname = \"wall {number}\"\npolygon = {corners:?}");
    }
    text
}

/// If it is proven that a task cannot be done, the certificate of that, which holds, and does not without boxes or a case that it needs.
fn impossible(seed: u64, [urdf, world]: [&str; 2], problem: &Problem, tally: &mut Tally) -> Option<String> {
    let answer = plan(problem, &Planner::First.into()).unwrap();
    if answer.status() != Status::Infeasible {
        return None;
    }
    let Ok(certificate) = answer.certificate(&Overrides::default(), None) else {
        tally.without += 1;
        return None;
    };
    let begun = Instant::now();
    let judged = check(urdf, world, &certificate);
    tally.longest = tally.longest.max(begun.elapsed());
    assert!(judged.is_ok(), "seed {seed}: {judged:?}\n{urdf}\n{world}\n{certificate}");
    let whole: Value = serde_json::from_str(&certificate).unwrap();
    let cases = whole["cases"].as_array().unwrap();
    tally.impossible += 1;
    tally.step_by_step += usize::from(cases.iter().any(|case| case["step"] != cases[0]["step"]));
    tally.carrying += usize::from(certificate.contains("\"carried\""));
    let mut refused = 0;
    for (number, case) in cases.iter().enumerate() {
        let mut falsified = vec![whole.clone()];
        falsified[0]["cases"].as_array_mut().unwrap().remove(number);
        if !case["boxes"].as_array().unwrap().is_empty() {
            falsified.push(whole.clone());
            falsified[1]["cases"][number]["boxes"] = Value::Array(Vec::new());
        }
        for falsified in falsified {
            // What is left may be enough: a case that rules out some ends of a step is no matter where none follows on it.
            let left = check(urdf, world, &falsified.to_string());
            let is_refused = matches!(left, Err(CheckError::Fails(_)));
            assert!(is_refused || left == judged, "seed {seed}, case {number}: {left:?}\n{falsified}");
            refused += usize::from(is_refused);
            tally.falsified += 1;
        }
    }
    assert!(refused > 0, "seed {seed}: no case is needed\n{certificate}");
    Some(certificate)
}

/// Tasks for an arm of this seed.
fn tasks(seed: u64, tally: &mut Tally) {
    let mut dice = Dice::new(seed.wrapping_mul(0x51a3_77c1_90d5_0b2f));
    let kind = seed % KINDS;
    let drawn = Drawn::new(&mut dice, kind);
    let urdf = drawn.urdf();
    let source = |name: &str, text: &str| Source::in_memory(name, text);
    let scene = |world: &str| input::scene_from(source("arm.urdf", &urdf), source("world.toml", world));
    // Slides along one line, and the like.
    let Ok(loaded) = scene(&drawn.world(false)) else { return };
    let free = |dice: &mut Dice| {
        (0..TRIES).find_map(|_| {
            let q = drawn.joints.map(|joint| {
                let [low, high] = joint.range.unwrap_or([-3.2, 3.2]);
                dice.within(low, high)
            });
            let at = Configuration::from(q);
            (loaded.scene.clearance(at) > loaded.scene.workspace().clearance + 0.02 * drawn.scale).then_some(q)
        })
    };
    for _ in 0..3 {
        let Some(world) = world(&mut dice, &drawn, free) else { continue };
        let Ok(problem) = scene(&world).and_then(|scene| Problem::of_scene(scene, &Overrides::default())) else {
            continue;
        };
        tally.asked += 1;
        let answer = plan(&problem, &Planner::First.into()).unwrap();
        let of_walls = dice.bits();
        let walls = [1.0, 100.0].map(|far| walls(&mut Dice::new(of_walls), &drawn, far));
        let [among, beside] = walls.map(|walls| world.replace(WALLS, &walls));
        if let Ok(problem) = scene(&among).and_then(|scene| Problem::of_scene(scene, &Overrides::default())) {
            let is_impossible = impossible(seed, [&urdf, &among], &problem, tally);
            // Far away the same walls are in nobody's way.
            if let Some(certificate) = is_impossible.filter(|_| answer.status() == Status::Found) {
                let refused = check(&urdf, &beside, &certificate);
                assert!(matches!(refused, Err(CheckError::Fails(_))), "seed {seed}: {refused:?}\n{beside}");
                tally.falsified += 1;
            }
        }
        if answer.status() != Status::Found {
            impossible(seed, [&urdf, &world], &problem, tally);
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
        // What is taken elsewhere by more than anything may miss is not what lies there.
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
    for seed in seeds(30) {
        tasks(seed, &mut tally);
    }
    println!("{tally:?}");
    if usual() {
        let some = [tally.rigid, tally.turned, tally.resting, tally.free_order, tally.falsified];
        let is_some = some.iter().all(|n| *n > 0) && tally.impossible > 10;
        assert!(tally.done.iter().all(|n| *n > 0) && is_some, "{tally:?}");
    }
}

/// Where an object that turns with the arm is let go of depends on where it was taken.
#[test]
fn the_step_after_a_rigid_place_is_impossible() {
    let mut tally = Tally::default();
    tasks(5 << 32, &mut tally);
    assert!(tally.step_by_step > 0, "{tally:?}");
}

/// Where what lies untouched is picked does not depend on what was turned before.
#[test]
fn what_is_picked_after_others_were_turned_is_known_as_well() {
    let mut tally = Tally::default();
    tasks(90_194_313_353, &mut tally);
    assert!(tally.impossible > tally.without, "{tally:?}");
}

/// How what an arm turned lies is followed through groups in free order.
#[test]
fn what_is_turned_in_free_order_is_known() {
    let mut tally = Tally::default();
    tasks(94_489_280_646, &mut tally);
    assert!(tally.impossible > 0 && tally.without == 0, "{tally:?}");
}
