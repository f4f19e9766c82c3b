//! Programs of both arms with signals: a player runs them with random delays. It shares no code with cplan.

use super::super::controller_languages::{Statement, read_rapid, read_spel};
use super::super::{Place, number};
use super::oracle::{Arm, clearance, distance};
use super::random::Cell;
use super::{bars, column_arm, crossing_arms, shipped};
use cplan_cases::dice::Dice;
use serde_json::Value;
use std::f64::consts::PI;

/// Greatest motion of a joint between two looks at the arms, degrees.
const STEP: f64 = 0.5;

/// Time between two changes of the speeds, in steps.
const PHASE: usize = 40;

/// An arm that runs its program.
struct Runner<'a> {
    program: &'a [Statement],
    next: usize,
    at: [f64; 2],
}

impl<'a> Runner<'a> {
    fn new(program: &'a [Statement]) -> Self {
        let first = program.iter().position(|statement| matches!(statement, Statement::Move(_))).expect("a start");
        let Statement::Move(to) = &program[first] else { unreachable!() };
        Self { program, next: first + 1, at: [to[0], to[1]] }
    }

    /// Runs the program for a step of the arm. Returns false at its end, and while it waits.
    fn step(&mut self, by: f64, signals: &mut [bool]) -> bool {
        match self.program.get(self.next) {
            None => return false,
            Some(Statement::WaitForSignal(signal)) if !signals[*signal] => return false,
            Some(Statement::Move(to)) => {
                let left = [to[0] - self.at[0], to[1] - self.at[1]];
                let far = left[0].abs().max(left[1].abs());
                if far > by {
                    self.at = [0, 1].map(|k| self.at[k] + left[k] * by / far);
                    return true;
                }
                self.at = [to[0], to[1]];
            }
            Some(Statement::SetSignal(signal)) => signals[*signal] = true,
            Some(Statement::WaitForSignal(_) | Statement::Speed(_)) => {}
            Some(other) => panic!("{other:?}"),
        }
        self.next += 1;
        true
    }
}

/// Runs both programs, each with random delays, and returns the least distance of the arms.
fn least_distance(arms: &[Arm; 2], programs: [&[Statement]; 2], seed: u64) -> f64 {
    let mut random = Dice::new(seed);
    let mut runners = programs.map(Runner::new);
    let mut signals = vec![false; 32];
    let (mut speeds, mut least, mut idle) = ([1.0; 2], f64::INFINITY, 0);
    for step in 0.. {
        if step % PHASE == 0 {
            speeds = [0, 1].map(|_| if random.chance(0.4) { 0.0 } else { random.within(0.1, 1.0) });
        }
        let is_moving = [0, 1].map(|k| speeds[k] > 0.0 && runners[k].step(STEP * speeds[k], &mut signals));
        least = least.min(distance(arms, [0, 1].map(|k| runners[k].at.map(f64::to_radians))));
        if (0..2).all(|k| runners[k].next == programs[k].len()) {
            break;
        }
        idle = if is_moving == [false; 2] { idle + 1 } else { 0 };
        assert!(idle < 100 * PHASE, "seed {seed}: the programs wait for each other");
    }
    least
}

/// Writes the programs of a cell in RAPID, and returns them with the answer.
fn programs(place: &Place, cell: &str, options: &[&str]) -> Option<([Vec<Statement>; 2], Value)> {
    let words = ["cell", cell, "--json", "--quiet", "--boxes", "0", "--template", "rapid"];
    let outputs = ["--output", "left.mod", "--output", "right.mod"];
    let words: Vec<&str> = words.iter().chain(&outputs).chain(options).copied().collect();
    let done = place.run(&words, "");
    assert!([0, 3, 4].contains(&done.code), "{}", done.stderr);
    let answer = super::answer(&done);
    (done.code == 0).then(|| (["left.mod", "right.mod"].map(|file| read_rapid(&place.read(file))), answer))
}

/// Returns the number of the target, and the place, at which a program uses a signal.
fn target(program: &[Statement], used: &Statement) -> (usize, [f64; 2]) {
    let place = program.iter().position(|statement| statement == used).unwrap_or_else(|| panic!("no {used:?}"));
    let moves = program[..place].iter().filter_map(|statement| match statement {
        Statement::Move(to) => Some([to[0].to_radians(), to[1].to_radians()]),
        _ => None,
    });
    let moves: Vec<[f64; 2]> = moves.collect();
    (moves.len(), moves[moves.len() - 1])
}

/// Checks that the programs use the signals at the places that the answer states.
#[track_caller]
pub fn check_signals(programs: &[Vec<Statement>; 2], answer: &Value) {
    let name = |k: usize| answer["arms"][k]["name"].as_str().unwrap();
    let interlocks = answer["interlocks"].as_array().expect("interlocks");
    for interlock in interlocks {
        let signal = interlock["signal"].as_u64().unwrap() as usize;
        let waits = usize::from(interlock["waits"] != name(0));
        for (program, used, place) in [
            (&programs[waits], Statement::WaitForSignal(signal), &interlock["at"]),
            (&programs[1 - waits], Statement::SetSignal(signal), &interlock["after"]),
        ] {
            let (number_of, at) = target(program, &used);
            assert_eq!(place["target"], number_of, "{interlock}");
            assert!((0..2).all(|k| (at[k] - number(&place["position"][k])).abs() < 2e-6), "{at:?} {interlock}");
        }
    }
    let is_signal = |statement: &&Statement| matches!(statement, Statement::SetSignal(_) | Statement::WaitForSignal(_));
    assert_eq!(programs.iter().flatten().filter(is_signal).count(), 2 * interlocks.len());
}

/// Returns the programs without their waits.
pub fn without_waits(programs: &[Vec<Statement>; 2]) -> [Vec<Statement>; 2] {
    let kept = |statement: &&Statement| !matches!(statement, Statement::WaitForSignal(_));
    programs.each_ref().map(|program| program.iter().filter(kept).cloned().collect())
}

fn slices(programs: &[Vec<Statement>; 2]) -> [&[Statement]; 2] {
    programs.each_ref().map(Vec::as_slice)
}

#[test]
fn programs_with_signals_are_safe_for_all_delays() {
    let column = [[[0.2, 0.26], [0.13, 0.19], [0.05, 0.15]], [[0.3, 0.36], [0.13, 0.29], [0.05, 0.15]]];
    for (name, outputs, arms) in [
        ("crossing", ["left", "right"], crossing_arms()),
        ("relay", ["left", "right"], crossing_arms()),
        ("swap", ["left", "right"], [bars([-1.3, 0.0], 0.0), bars([1.3, 0.0], PI)]),
        ("column", ["lower", "upper"], column.map(column_arm)),
    ] {
        let place = Place::new();
        let text = super::read(shipped(&format!("workspaces/cells/{name}.toml")));
        let robots = format!("{}/", shipped("robots"));
        let text = text.replace("../../robots/", &robots);
        place.write(
            "cell.toml",
            outputs.iter().zip(["left", "right"]).fold(text, |text, (from, to)| {
                text.replace(&format!("name = \"{from}\""), &format!("name = \"{to}\""))
            }),
        );
        let (programs, answer) = programs(&place, "cell.toml", &[]).expect("motions");
        check_signals(&programs, &answer);
        let clearance = number(&answer["clearance"]);
        assert!(clearance > 0.0, "{name}");
        for seed in 0..8 {
            let least = least_distance(&arms, slices(&programs), seed);
            assert!(least > 0.9 * clearance, "{name}, seed {seed}: {least}, {clearance}");
        }
        let without = without_waits(&programs);
        assert!(
            (0..30).any(|seed| least_distance(&arms, slices(&without), seed) <= 0.0),
            "{name}: the signals are superfluous"
        );
    }
}

#[test]
fn programs_of_random_cells_are_safe_for_all_delays() {
    let (mut found, mut signals) = (0, 0);
    for seed in cplan_cases::seeds(30) {
        let cell = Cell::new(&mut Dice::new(seed));
        let place = cell.place();
        let Some((programs, answer)) = programs(&place, "cell.toml", &[]) else { continue };
        check_signals(&programs, &answer);
        for delays in 0..4 {
            let least = least_distance(&cell.arms, slices(&programs), delays);
            assert!(least > 0.0, "seed {seed}, delays {delays}");
        }
        for (program, arm) in programs.iter().zip(&cell.arms) {
            let corners: Vec<[f64; 2]> = super::super::controller_languages::targets(program)
                .iter()
                .map(|to| [to[0].to_radians(), to[1].to_radians()])
                .collect();
            for line in corners.windows(2) {
                for k in 0..=50 {
                    let share = f64::from(k) / 50.0;
                    let q = [0, 1].map(|j| line[0][j] + (line[1][j] - line[0][j]) * share);
                    assert!(clearance(arm, q, &[cell.post()]) > 0.0, "seed {seed}");
                }
            }
        }
        found += 1;
        signals += usize::from(!answer["interlocks"].as_array().unwrap().is_empty());
    }
    if cplan_cases::uses_default_cases() {
        assert!(found >= 15 && signals >= 5, "found {found}, with signals {signals}");
    }
}

#[test]
fn other_languages_have_the_signals_too() {
    let place = Place::new();
    let cell = shipped("workspaces/cells/relay.toml");
    let (rapid, answer) = programs(&place, &cell, &[]).expect("motions");
    let outputs = |extension: &str| ["left", "right"].map(|arm| format!("{arm}.{extension}"));
    let run = |template: &str, extension: &str, more: &str| {
        let [one, two] = outputs(extension);
        place.run(&["cell", &cell, "--template", template, "--output", &one, "--output", &two], more)
    };
    run("epson", "prg", "").exits(0).says(&["program    left: ", "whichever program is late: proven", ", target "]);
    let spel = outputs("prg").map(|file| read_spel(&place.read(&file)));
    for (one, other) in rapid.iter().flatten().zip(spel.iter().flatten()) {
        match (one, other) {
            (Statement::Move(one), Statement::Move(other)) => assert_eq!(one[..4], other[..4]),
            _ => assert_eq!(one, other),
        }
    }
    let own = "{% for move in moves %}{{ move.joints | join(\" \") }}\n{% for signal in move.signals %}\
               {{ signal.action }} {{ signal.number }} ! {{ signal.text }}\n{% endfor %}{% endfor %}";
    place.write("own.j2", own);
    run("own.j2", "job", "").exits(0);
    let interlock = &answer["interlocks"][0];
    let [waits, sets] = ["waits", "sets"].map(|key| place.read(&format!("{}.job", interlock[key].as_str().unwrap())));
    assert!(
        waits.contains("\nwait 1 ! wait for signal 1\n") && sets.contains("\nset 1 ! set signal 1\n"),
        "{waits}{sets}"
    );
    run("list", "txt", "").exits(0);
    assert!(place.read("left.txt").contains("grip,dwell [s],signals\n"), "{}", place.read("left.txt"));
    for (lacks, expected) in [
        (own.replace("{{ signal.number }}", ""), "the template does not write signal 1 after target "),
        (
            own.replace("{{ signal.text }}", "{{ signal.number }}"),
            "the template writes signal 1 in the wrong place: after target",
        ),
        (
            own.replace("{{ move.joints | join(\" \") }}\n", "")
                .replace("{% endfor %}{% endfor %}", "{% endfor %}{{ move.joints | join(\" \") }}\n{% endfor %}"),
            "the template writes signal 1 in the wrong place: after target",
        ),
    ] {
        place.write("own.j2", lacks);
        run("own.j2", "job", "--quiet").refused(1, &["own.j2", expected]);
    }
}

#[test]
fn each_arm_needs_its_own_program() {
    let cell = shipped("workspaces/cells/crossing.toml");
    for (options, expected) in [
        ("--output left.mod", "the format of \"left.mod\" is unknown"),
        ("--template rapid --output left.json", "--template needs an --output file"),
        ("--template rapid --output left.mod", "add --output \"right.EXT\""),
        ("--template rapid --output cell.mod --output right.mod", "let the file's name end with \"left\" or \"right\""),
    ] {
        Place::new().run(&["cell", &cell], options).refused(2, &[expected]);
    }
}
