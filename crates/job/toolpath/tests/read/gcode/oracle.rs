//! Compares random programs with the drawings of a small machine of its own, point by point.

use cplan_toolpath::{Format, Placement, read};
use proptest::prelude::*;
use std::fmt::Write;

/// Number of points that are compared on each move.
const POINTS: usize = 16;

/// The contents of a line of a program, as random numbers.
#[derive(Debug, Clone)]
enum Step {
    Move { to: [i32; 2], has: [bool; 2], is_travel: bool },
    Arc { center: [i32; 2], turn: f64 },
    Relative(bool),
    AbsoluteCenters(bool),
    Shift([Option<i32>; 2]),
    Unshift,
    Inches(bool),
}

fn step() -> impl Strategy<Value = Step> {
    let number = -2_000_000..2_000_000_i32;
    let pair = prop::array::uniform2(number.clone());
    let arc = (pair.clone(), prop_oneof![0.01..6.2_f64, -6.2..-0.01_f64]);
    prop_oneof![
        4 => (pair, any::<[bool; 2]>(), prop::bool::weighted(0.2)).prop_map(|(to, has, is_travel)| Step::Move { to, has, is_travel }),
        4 => arc.prop_map(|(center, turn)| Step::Arc { center, turn }),
        1 => any::<bool>().prop_map(Step::Relative),
        1 => any::<bool>().prop_map(Step::AbsoluteCenters),
        2 => prop::array::uniform2(prop::option::of(number)).prop_map(Step::Shift),
        1 => Just(Step::Unshift),
        1 => any::<bool>().prop_map(Step::Inches),
    ]
}

/// A machine that counts in units of a file, from the place where a program begins.
struct Machine {
    at: [f64; 2],
    origin: [f64; 2],
    is_relative: bool,
    has_absolute_centers: bool,
    /// Metres per unit.
    unit: f64,
    text: String,
    /// The points of each move that draws, metres.
    drawn: Vec<Vec<[f64; 2]>>,
}

impl Machine {
    /// Returns the number that a file has for a coordinate, in steps of 0.0001 units, and the coordinate in metres.
    fn written(&self, k: usize, place: f64) -> (String, f64) {
        let base = if self.is_relative { self.at[k] } else { self.origin[k] };
        let number = ((place - base) / self.unit * 1e4).round() / 1e4;
        (format!("{number:.4}"), base + number * self.unit)
    }

    fn run(&mut self, step: &Step) {
        match *step {
            Step::Relative(is_on) => {
                self.is_relative = is_on;
                self.text += if is_on { "G91\n" } else { "G90\n" };
            }
            Step::AbsoluteCenters(is_on) => {
                self.has_absolute_centers = is_on;
                self.text += if is_on { "G90.1\n" } else { "G91.1\n" };
            }
            Step::Inches(is_on) => {
                self.unit = if is_on { 0.0254 } else { 0.001 };
                self.text += if is_on { "G20\n" } else { "G21\n" };
            }
            Step::Unshift => {
                self.origin = [0.0; 2];
                self.text += "G92.1\n";
            }
            Step::Shift([None, None]) => {}
            Step::Shift(values) => {
                self.text += "G92";
                for (k, letter) in [(0, 'X'), (1, 'Y')] {
                    let Some(value) = values[k] else { continue };
                    let value = f64::from(value) / 1e4;
                    write!(self.text, " {letter}{value}").unwrap();
                    self.origin[k] = self.at[k] - value * self.unit;
                }
                self.text.push('\n');
            }
            Step::Move { to, has, is_travel } => {
                let wanted = [0, 1].map(|k| if has[k] { f64::from(to[k]) * 1e-7 } else { self.at[k] });
                self.text += if is_travel { "G0" } else { "G1" };
                let mut end = self.at;
                for (k, letter) in [(0, 'X'), (1, 'Y')] {
                    if has[k] {
                        let (text, place) = self.written(k, wanted[k]);
                        write!(self.text, " {letter}{text}").unwrap();
                        end[k] = place;
                    }
                }
                self.text.push('\n');
                self.line(end);
            }
            Step::Arc { center, turn } => self.arc(center, turn),
        }
    }

    fn line(&mut self, end: [f64; 2]) {
        let from = self.at;
        let point = |i: usize| [0, 1].map(|k| from[k] + (end[k] - from[k]) * i as f64 / POINTS as f64);
        self.drawn.push((0..=POINTS).map(point).collect());
        self.at = end;
    }

    /// Draws by small rotations, and checks no angles: the last rotation ends where the file says.
    fn arc(&mut self, center: [i32; 2], turn: f64) {
        let offset = [0, 1].map(|k| (f64::from(center[k]) * 1e-7 / self.unit * 1e4).round() / 1e4 * self.unit);
        if offset[0].hypot(offset[1]) < 0.01 {
            return;
        }
        let mut center = [0, 1].map(|k| self.at[k] + offset[k]);
        let mut numbers = offset;
        if self.has_absolute_centers {
            let round = |k: usize| ((center[k] - self.origin[k]) / self.unit * 1e4).round() / 1e4 * self.unit;
            numbers = [0, 1].map(round);
            center = [0, 1].map(|k| self.origin[k] + numbers[k]);
        }
        let first = [0, 1].map(|k| self.at[k] - center[k]);
        let rotated = |[x, y]: [f64; 2], by: f64| [x * by.cos() - y * by.sin(), x * by.sin() + y * by.cos()];
        let wanted = rotated(first, turn);
        let ends = [0, 1].map(|k| self.written(k, center[k] + wanted[k]));
        let last = [0, 1].map(|k| ends[k].1 - center[k]);
        // The rest of the turn after the wanted one is small.
        let cross = wanted[0] * last[1] - wanted[1] * last[0];
        let turn = turn + (cross / (wanted[0].powi(2) + wanted[1].powi(2))).asin();
        let growth = last[0].hypot(last[1]) / first[0].hypot(first[1]) - 1.0;
        let point = |i: usize| {
            let share = i as f64 / POINTS as f64;
            let [x, y] = rotated(first, turn * share);
            [center[0] + x * (1.0 + growth * share), center[1] + y * (1.0 + growth * share)]
        };
        self.drawn.push((0..=POINTS).map(point).collect());
        let word = if turn > 0.0 { "G3" } else { "G2" };
        let [i, j] = numbers.map(|number| number / self.unit);
        writeln!(self.text, "{word} X{} Y{} I{i:.4} J{j:.4}", ends[0].0, ends[1].0).unwrap();
        self.at = [ends[0].1, ends[1].1];
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(256))]

    /// Compares the line of a random program with the machine's drawing. It has shifted origins, relative moves and arcs.
    #[test]
    fn random_programs_are_what_a_machine_draws(steps in prop::collection::vec(step(), 1..30)) {
        let text = "G21 G90\nG0 X0 Y0\nG1 X1\n".to_owned();
        let (at, drawn) = ([0.001, 0.0], vec![(0..=POINTS).map(|i| [0.001 * i as f64 / POINTS as f64, 0.0]).collect()]);
        let mut machine =
            Machine { at, origin: [0.0; 2], is_relative: false, has_absolute_centers: false, unit: 0.001, text, drawn };
        steps.iter().for_each(|step| machine.run(step));
        machine.run(&Step::Move { to: [3, 3], has: [true; 2], is_travel: false });
        let path = read(machine.text.as_bytes(), Format::GCode, &Placement::default());
        let path = path.map_err(|error| TestCaseError::fail(format!("{error} in {}", machine.text)))?;
        let is_long = |points: &&Vec<[f64; 2]>| points.windows(2).any(|pair| pair[0] != pair[1]);
        let drawn: Vec<&Vec<[f64; 2]>> = machine.drawn.iter().filter(is_long).collect();
        prop_assert_eq!(drawn.len(), path.pieces().len(), "{}", &machine.text);
        for (points, piece) in drawn.iter().zip(path.pieces()) {
            for (i, point) in points.iter().enumerate() {
                let found = piece.curve.at(i as f64 / POINTS as f64);
                let off = (found[0] - point[0]).hypot(found[1] - point[1]);
                prop_assert!(off < 1e-10, "{off} at {i} of {piece:?} in {}", &machine.text);
            }
        }
    }
}
