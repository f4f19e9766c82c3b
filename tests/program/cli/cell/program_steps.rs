//! Programs with signals of cells whose arms have steps: a player runs them with random delays. It shares no code with cplan.

use super::super::controller_languages::{Statement, read_rapid};
use super::super::{Place, number};
use super::oracle::{Arm, Point, Solid, distance};
use super::{scara_with_quill, shipped};
use cplan_cases::dice::Dice;
use serde_json::Value;
use std::f64::consts::PI;

/// Greatest motion of a joint between two looks at the arms, degrees or millimetres.
const STEP: f64 = 1.0;

/// Time between two changes of the speeds, in steps.
const PHASE: usize = 40;

/// Distance between the tip and an object that is grasped, metres. Programs have three decimals.
const TOLERANCE: f64 = 1e-5;

/// Height by which objects are lifted, metres.
const LIFT: f64 = 0.1;

/// Radius of a disc within each object, metres, and the height of objects.
const OBJECT: [f64; 2] = [0.009, 0.01];

/// An arm that runs its program.
struct Runner<'a> {
    program: &'a [Statement],
    next: usize,
    /// Values of the first three joints, degrees and millimetres.
    at: [f64; 3],
    /// The object in the gripper.
    carried: Option<usize>,
    base: (Point, f64),
}

impl Runner<'_> {
    fn arm(&self) -> Arm {
        scara_with_quill(self.base.0, self.base.1, -1e-3 * self.at[2])
    }

    fn joints(&self) -> [f64; 2] {
        [self.at[0].to_radians(), self.at[1].to_radians()]
    }

    fn tip(&self) -> Point {
        self.arm().tip(self.joints())
    }

    /// Runs the program for a step of the arm. Returns false at its end, and while it waits.
    fn step(&mut self, by: f64, signals: &mut [bool], objects: &mut [Option<Point>]) -> bool {
        match self.program.get(self.next) {
            None => return false,
            Some(Statement::WaitForSignal(signal)) if !signals[*signal] => return false,
            Some(Statement::Move(to)) => {
                let left = [0, 1, 2].map(|k| to[k] - self.at[k]);
                let far = left.iter().fold(0.0_f64, |far, value| far.max(value.abs()));
                if far > by {
                    self.at = [0, 1, 2].map(|k| self.at[k] + left[k] * by / far);
                    return true;
                }
                self.at = [to[0], to[1], to[2]];
            }
            Some(Statement::SetSignal(signal)) => signals[*signal] = true,
            Some(Statement::Grip(closes)) => {
                assert!((self.at[2] + 1e3 * LIFT).abs() < 1e-9, "the gripper acts at the bottom");
                let tip = self.tip();
                let apart = |at: Point| (at[0] - tip[0]).hypot(at[1] - tip[1]);
                let lies = |object: &Option<Point>, within: f64| object.is_some_and(|at| apart(at) < within);
                if *closes {
                    let there = objects.iter().position(|object| lies(object, TOLERANCE)).expect("an object to grasp");
                    assert_eq!(self.carried.replace(there), None);
                    objects[there] = None;
                } else {
                    assert!(!objects.iter().any(|object| lies(object, 2.0 * OBJECT[0])), "the place is not free");
                    objects[self.carried.take().expect("an object to release")] = Some(tip);
                }
            }
            Some(Statement::WaitForSignal(_) | Statement::Speed(_) | Statement::Wait(_)) => {}
        }
        self.next += 1;
        true
    }

    /// Returns the arm with the object in its gripper.
    fn with_object(&self) -> Arm {
        let mut arm = self.arm();
        if self.carried.is_some() {
            let lower = LIFT + 1e-3 * self.at[2];
            arm.links[1].push(Solid::disc([arm.outer_length, 0.0], OBJECT[0], [lower, lower + OBJECT[1]]));
        }
        arm
    }
}

/// Runs both programs, each with random delays. Returns the least distance of the arms, and the places of all objects.
fn played(programs: [&[Statement]; 2], objects: &[Point], seed: u64) -> (f64, Vec<Point>) {
    let mut random = Dice::new(seed);
    let bases = [([0.0, 0.0], 0.0), ([0.8, 0.0], PI)];
    let mut runners = [0, 1].map(|k| {
        let first = programs[k].iter().find_map(|statement| match statement {
            Statement::Move(to) => Some([to[0], to[1], to[2]]),
            _ => None,
        });
        Runner { program: programs[k], next: 0, at: first.expect("a start"), carried: None, base: bases[k] }
    });
    let mut objects: Vec<Option<Point>> = objects.iter().copied().map(Some).collect();
    let mut signals = vec![false; 64];
    let (mut speeds, mut least, mut idle) = ([1.0; 2], f64::INFINITY, 0);
    for step in 0.. {
        if step % PHASE == 0 {
            speeds = [0, 1].map(|_| if random.chance(0.4) { 0.0 } else { random.within(0.1, 1.0) });
        }
        let is_moving = [0, 1].map(|k| {
            let by = STEP * speeds[k];
            speeds[k] > 0.0 && runners[k].step(by, &mut signals, &mut objects)
        });
        least =
            least.min(distance(&runners.each_ref().map(Runner::with_object), runners.each_ref().map(Runner::joints)));
        if runners.iter().all(|runner| runner.next == runner.program.len()) {
            break;
        }
        idle = if is_moving == [false; 2] { idle + 1 } else { 0 };
        assert!(idle < 100 * PHASE, "seed {seed}: the programs wait for each other");
    }
    (least, objects.into_iter().map(|object| object.expect("nothing is carried at the end")).collect())
}

/// Checks the programs of a shipped cell: for all delays, the objects get from the first places to the last ones.
fn check(name: &str, first: &[Point], last: &[Point]) {
    let place = Place::new();
    let cell = shipped(&format!("workspaces/cells/{name}.toml"));
    place
        .run(&["cell", &cell], "--quiet --template rapid --output left.mod --output right.mod --output cell.json")
        .exits(0);
    let answer: Value = serde_json::from_str(&place.read("cell.json")).unwrap();
    let programs = ["left.mod", "right.mod"].map(|file| read_rapid(&place.read(file)));
    super::programs::check_signals(&programs, &answer);
    let [clearance, signals] = [number(&answer["clearance"]), answer["interlocks"].as_array().unwrap().len() as f64];
    assert!(clearance > 0.0 && signals > 0.0, "{name}");
    for seed in 0..4 {
        let (least, places) = played(programs.each_ref().map(Vec::as_slice), first, seed);
        assert!(least > 0.9 * clearance, "{name}, seed {seed}: {least}, {clearance}");
        for (is, asked) in places.iter().zip(last) {
            assert!(
                (is[0] - asked[0]).hypot(is[1] - asked[1]) < 2.0 * TOLERANCE,
                "{name}, seed {seed}: {is:?} {asked:?}"
            );
        }
    }
    // Without the waits, some delays lead to a collision, or the gripper finds no object.
    let without = super::programs::without_waits(&programs);
    let is_safe = |seed: u64| {
        let run = || played(without.each_ref().map(Vec::as_slice), first, seed).0 > 0.0;
        std::panic::catch_unwind(run).unwrap_or(false)
    };
    assert!(!(0..8).all(is_safe), "{name}: the signals are superfluous");
}

#[test]
fn handovers_are_safe_for_all_delays() {
    check("handover", &[[0.05, -0.3], [0.12, -0.3]], &[[0.75, 0.3], [0.85, 0.3]]);
}

#[test]
fn shared_objects_reach_their_places_for_all_delays() {
    let feeders = [[0.3, 0.2], [0.36, 0.28], [0.5, 0.2], [0.3, -0.2], [0.44, -0.28], [0.5, -0.2]];
    let tray = [[0.36, 0.04], [0.36, -0.04], [0.44, 0.04], [0.4, -0.04], [0.44, -0.04], [0.4, 0.04]];
    check("kitting", &feeders, &tray);
}
