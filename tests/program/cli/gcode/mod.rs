//! `cplan gcode` from outside: written programs and answers against a machine of the tests' own.

use super::*;
mod firmware;
mod oracle;
mod placed;
mod segments;
mod words;

use cplan_cases::dice;
use cplan_cases::dice::Dice;
use oracle::{Machine, Move, Point, Stop, distance, moves};
use std::fmt::Write;

/// Distance from an obstacle, metres, below which a travel may count as unsafe. It is several tolerances.
const NEAR: f64 = 1e-3;

/// Rounding of places in results, metres.
const ROUNDING: f64 = 1e-6;

fn machine(dice: &mut Dice) -> Machine {
    let obstacle = |dice: &mut Dice| {
        let (angle, away, size) = (dice.within(-2.5, 2.5), dice.within(0.2, 0.42), dice.within(0.015, 0.04));
        let center = [away * angle.cos(), away * angle.sin()];
        let (count, turn) = (3 + dice.below(3_u32), dice.within(0.0, 2.0));
        let corner = |k: u32| {
            let (sin, cos) = (turn + f64::from(k) / f64::from(count) * std::f64::consts::TAU).sin_cos();
            [center[0] + size * cos, center[1] + size * sin].map(|x| (x * 1e4).round() / 1e4)
        };
        (0..count).map(corner).collect()
    };
    let count = 1 + dice.below(2_u32);
    Machine {
        lengths: [0.25, 0.2],
        width: 0.03,
        limits: [[-2.7, 2.7], [-2.5, 2.5]],
        motor: dice.chance(0.3).then(|| [dice.within(-2.8, -1.5), dice.within(1.5, 2.8)]),
        obstacles: (0..count).map(|_| obstacle(dice)).collect(),
    }
}

/// Returns a program that draws some strokes at random places, in random modes.
fn program(dice: &mut Dice) -> String {
    let is_inch = dice.chance(0.3);
    let (unit, decimals) = if is_inch { (0.0254, 5) } else { (1e-3, 3) };
    let mut text = format!("{} G90\n", if is_inch { "G20" } else { "G21" });
    let mut at = [0.0_f64; 2];
    let mut is_relative = false;
    let round = |p: Point| p.map(|x| (x / unit * 10_f64.powi(decimals)).round() / 10_f64.powi(decimals));
    for stroke in 0..2 + dice.below(3_u32) {
        let (angle, away) = (dice.within(-1.8, 1.8), dice.within(0.17, 0.42));
        let place = round([away * angle.cos(), away * angle.sin()]);
        if stroke > 0 && dice.chance(0.3) {
            is_relative = !is_relative;
            text.push_str(if is_relative { "G91\n" } else { "G90\n" });
        }
        let mut to = |kind: &str, place: Point, more: &str| {
            let shown = if is_relative { [0, 1].map(|k| place[k] - at[k]) } else { place };
            let decimals = decimals as usize;
            writeln!(text, "{kind} X{:.decimals$} Y{:.decimals$}{more}", shown[0], shown[1]).unwrap();
            at = place;
        };
        to("G0", place, " ; travel");
        let mut here = place;
        for _ in 0..1 + dice.below(3_u32) {
            let by = [dice.within(-0.03, 0.03), dice.within(-0.03, 0.03)];
            let there = round([0, 1].map(|k| here[k] * unit + by[k]));
            if dice.chance(0.3) {
                // Half a circle, whose centre is in the middle.
                let [i, j] = [0, 1].map(|k| (there[k] - here[k]) / 2.0);
                to(if dice.chance(0.5) { "G2" } else { "G3" }, there, &format!(" I{i:.6} J{j:.6}"));
            } else {
                to("G1", there, "");
            }
            here = there;
        }
    }
    text
}

/// Returns the lines of a program that do not belong to travels.
fn without_travels(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.starts_with("G0") && !line.contains("cplan:")).collect()
}

/// Checks that the machine can play the written program, which differs from the original in the stated travels only.
fn is_safe(machine: &Machine, original: &str, written: &str, result: &Value, is_marlin: bool) {
    let is_left = result["elbow"] == "left";
    let required = result["clearance"].as_f64().unwrap();
    assert_eq!(without_travels(original), without_travels(written));
    let [before, after] = [original, written].map(moves);
    let drawn = |moves: &[Move]| moves.iter().filter(|own| own.kind > 0).cloned().collect::<Vec<_>>();
    for (one, two) in drawn(&before).iter().zip(drawn(&after)) {
        let off = [0.0, 0.3, 1.0].map(|u| distance(one.at(u), two.at(u)));
        assert!(off.iter().all(|off| *off < 1e-9), "{one:?} {two:?}");
    }
    let mut last: Option<Point> = None;
    for own in &after {
        let (ends, least) = machine.play(own, is_left).unwrap_or_else(|stop| panic!("{stop:?} {own:?}\n{written}"));
        assert!(least >= required, "{least} {own:?}\n{written}");
        assert!(last.is_none_or(|last| distance(last, ends[0]) < 1e-6), "{own:?} jumps");
        assert!(own.kind > 0 || !is_marlin || machine.straight(ends) > required, "{own:?}");
        last = Some(ends[1]);
    }
    // Only travels that the machine cannot play safely are replaced.
    let replaced: Vec<u64> =
        result["lines"]["replaced"].as_array().unwrap().iter().map(|own| own["line"].as_u64().unwrap()).collect();
    for line in &replaced {
        let own = before.iter().find(|own| own.line as u64 == *line).unwrap();
        let is_unsafe = match machine.play(own, is_left) {
            Err(_) => true,
            Ok((ends, least)) => {
                let near = required + NEAR;
                least < near || (is_marlin && machine.straight(ends) < near)
            }
        };
        assert!(own.kind == 0 && is_unsafe, "{own:?}");
    }
    let is_kept = |line: &&str| written.lines().any(|other| other == *line);
    let kept = original.lines().zip(1_u64..).filter(|(_, number)| !replaced.contains(number));
    assert!(kept.map(|(line, _)| line).all(|line| is_kept(&line)), "{written}");
}

/// Checks a fault that the answer calls proven.
fn holds(machine: &Machine, original: &str, failed: &Value, is_left: bool, required: f64) {
    let place = [0, 1].map(|k| failed["place"][k].as_f64().unwrap());
    let q = machine.solve(place, is_left);
    let holds = match failed["cause"].as_str().unwrap() {
        "out_of_reach" => q.is_none(),
        "joint_limit" | "motor_range" => q.is_none_or(|q| machine.turned(q).is_none()),
        "collision" | "joint_motion" => q.is_some_and(|q| machine.clearance(q) < required + ROUNDING),
        "no_travel" => {
            let line = failed["line"].as_u64().unwrap() as usize;
            let own = moves(original).into_iter().find(|own| own.line == line).unwrap();
            let ends = [own.from, own.to].map(|p| machine.solve(p, is_left).and_then(|q| machine.turned(q)));
            let [Some(from), Some(to)] = ends else { panic!("{failed}") };
            !machine.joins(from, to, required)
        }
        cause => panic!("{cause}"),
    };
    assert!(holds, "{failed}\n{original}");
}

#[test]
fn written_programs_are_safe_and_proven_faults_hold() {
    let place = Place::new();
    let mut counts = [0; 5];
    for case in 0..cplan_cases::times(60) {
        let mut dice = dice(0x9c0d_e000 + case);
        let (machine, text) = (machine(&mut dice), program(&mut dice));
        place.write("arm.urdf", machine.urdf());
        place.write("world.toml", machine.world());
        place.write("job.gcode", &text);
        let is_marlin = dice.chance(0.5);
        let clearance = if dice.chance(0.3) { 0.004 } else { 0.0 };
        let dialect = if is_marlin { "marlin" } else { "klipper" };
        let options = format!("--output safe.gcode --json --dialect {dialect} --clearance {clearance}");
        let done = place.run(&["gcode", "arm.urdf", "world.toml", "job.gcode"], &options);
        let result = done.json();
        let lines = &result["lines"];
        match done.code {
            0 => {
                is_safe(&machine, &text, &place.read("safe.gcode"), &result, is_marlin);
                let replaced = lines["replaced"].as_array().unwrap().len();
                counts[if replaced > 0 { 1 } else { 0 }] += 1;
                let done = place.run(&["gcode", "arm.urdf", "world.toml", "safe.gcode"], "--check --quiet");
                assert!(done.code == 0 || !is_marlin, "{}", done.stderr);
            }
            3 => {
                let sides =
                    [(&result["elbow"], &lines["failed"]), (&result["other"]["elbow"], &result["other"]["failed"])];
                for (elbow, failed) in sides {
                    let failed = failed.as_array().unwrap();
                    assert!(failed.iter().any(|failed| failed["proven"] == true), "{result}");
                    for failed in failed.iter().filter(|failed| failed["proven"] == true) {
                        holds(&machine, &text, failed, elbow == "left", clearance);
                        counts[3] += usize::from(failed["cause"] == "no_travel");
                    }
                }
                counts[2] += 1;
            }
            4 => counts[4] += 1,
            code => panic!("exit code {code}: {}", done.stderr),
        }
    }
    if cplan_cases::uses_default_cases() {
        let [untouched, repaired, infeasible, ..] = counts;
        assert!(untouched > 3 && repaired > 8 && infeasible > 8 && counts[4] < 3, "{counts:?}");
    }
}

/// A wall separates both places for one side of the elbow, so the travel between them is proven impossible.
#[test]
fn a_travel_that_does_not_exist_is_proven() {
    let machine = Machine {
        lengths: [0.25, 0.2],
        width: 0.03,
        limits: [[-2.7, 2.7], [-2.5, 2.5]],
        motor: None,
        obstacles: vec![vec![[0.06, -0.01], [0.6, -0.01], [0.6, 0.01], [0.06, 0.01]]],
    };
    let place = Place::new().with("arm.urdf", machine.urdf()).with("world.toml", machine.world());
    let text = "G21 G90\nG0 X0 Y300\nG1 X10\nG0 X0 Y-300\nG1 X10\n";
    place.write("job.gcode", text);
    let done = place.run(&["gcode", "arm.urdf", "world.toml", "job.gcode"], "--output safe.gcode --json").exits(3);
    let result = done.json();
    assert!(!place.path("safe.gcode").exists());
    for (elbow, failed) in
        [(&result["elbow"], &result["lines"]["failed"]), (&result["other"]["elbow"], &result["other"]["failed"])]
    {
        let [failed] = failed.as_array().unwrap().as_slice() else { panic!("{result}") };
        assert_eq!(
            (&failed["line"], &failed["cause"], &failed["proven"]),
            (&4.into(), &"no_travel".into(), &true.into())
        );
        assert!(failed["reason"].as_str().unwrap().contains("no safe travel exists"), "{failed}");
        holds(&machine, text, failed, elbow == "left", 0.0);
    }
}

#[test]
fn the_shipped_labels_get_safe_travels() {
    let place = Place::new();
    let files = ["robots/scara.urdf", "workspaces/gcode/labels.toml", "workspaces/gcode/labels.gcode"].map(shipped);
    let [robot, world, job] = &files;
    let run = |job: &str, options: &str| -> Done { place.run(&["gcode", robot, world, job], options) };
    assert_eq!(run(job, "--output safe.gcode --json").json()["lines"]["replaced"].as_array().unwrap().len(), 3);
    let (original, written) = (std::fs::read_to_string(job).unwrap(), place.read("safe.gcode"));
    // The pen never leaves the side of the bar: y is below 0.24 where a travel passes it.
    let passing = moves(&written).into_iter().filter(|own| own.kind == 0 && own.from[0] * own.to[0] < 0.0);
    let heights: Vec<f64> =
        passing.map(|own| own.from[1] + own.from[0] / (own.from[0] - own.to[0]) * (own.to[1] - own.from[1])).collect();
    assert!(heights.len() == 3 && heights.iter().all(|y| *y < 0.235), "{heights:?}");
    assert_eq!(without_travels(&original), without_travels(&written));
    assert_eq!((run(job, "--check").code, run("safe.gcode", "--check").code), (3, 0));
    let again = run("safe.gcode", "--output again.gcode");
    assert_eq!((again.code, place.read("again.gcode")), (0, written), "a safe program stays as it is");
}

/// The oracle itself sees a collision, a limit and the end of the reach.
#[test]
fn the_machine_of_the_tests_stops() {
    let machine = Machine {
        lengths: [0.25, 0.2],
        width: 0.03,
        limits: [[-2.0, 2.0], [-2.5, 2.5]],
        motor: None,
        obstacles: vec![vec![[0.3, 0.0], [0.33, 0.0], [0.33, 0.05], [0.3, 0.05]]],
    };
    let stop = |text: &str| machine.play(&moves(text)[0], true).map(|_| ());
    assert_eq!(stop("G0 X315 Y-100\nG1 X315 Y100\n"), Err(Stop::Near(0.0)));
    assert_eq!(stop("G0 X0 Y-300\nG1 X0 Y-500\n"), Err(Stop::OutOfReach));
    assert_eq!(stop("G0 X0 Y300\nG1 X-200 Y200\n"), Err(Stop::Limit));
    assert_eq!(stop("G0 X100 Y-300\nG1 X200 Y-300\n"), Ok(()));
}
