//! Programs of both arms for their controllers, with signals between them.

use super::Content;
use super::files::named_arm;
use crate::cli::failure::Failure;
use crate::cli::outputs::Outputs;
use crate::cli::program_args::ProgramWriter;
use crate::input::{InputError, digest};
use crate::output::Line;
use crate::text::length_down;
use cplan_cell::{
    Cell, CellArm, Coordination, Interlock, ProgramSteps, SignalTargets, StepPart, StepTimes, check_delays,
};
use cplan_programs::{MovePart, Program, ProgramError, Signal, SignalPlace, SignalUse, Written};
use std::path::Path;

/// Difference of two times, seconds, below which they are equal.
const SAME_TIME: f64 = 1e-9;

/// The programs of both arms. They are certified as written, for any delay of either program.
pub struct CellPrograms {
    written: [Written; 2],
    summaries: [String; 2],
    /// The least distance of the arms, metres.
    clearance: f64,
    /// The targets of each signal.
    signals: Vec<SignalTargets>,
}

/// Reads the cell by `load`, which gets its clearance. If programs are requested, its clearance covers their tolerance.
///
/// # Errors
/// Bad input, and outputs that are not one program for each arm.
pub fn load(
    load: impl Fn(Option<f64>) -> Result<Cell, InputError>,
    clearance: Option<f64>,
    outputs: &Outputs<Content>,
    writer: Option<&mut ProgramWriter>,
) -> Result<Cell, Failure> {
    let cell = load(clearance)?;
    let Some(writer) = writer else { return Ok(cell) };
    check_names(&cell, outputs)?;
    if cell.has_steps() && cell.is_one_robot {
        let message = "the arms are one robot, and the program of one arm has no joints that move its tool";
        return Err(ProgramError::Unsuitable(format!("{message}\n  hint: write .json, .csv or .yaml files")).into());
    }
    cell.arms.iter().try_for_each(|arm| Program::check(&arm.problem))?;
    let rooms = cell.arms.each_ref().map(|arm| writer.tolerance.room(&arm.problem));
    let clearance = cell.arms[0].problem.scene().workspace().clearance;
    writer.widened(clearance, rooms.iter().sum(), |clearance| load(Some(clearance)))
}

/// Checks that each program is for one arm, and that each arm has a program.
fn check_names(cell: &Cell, outputs: &Outputs<Content>) -> Result<(), Failure> {
    let programs = outputs.results.iter().filter(|(_, content)| matches!(content, Content::Program));
    let [one, two] = cell.arms.each_ref().map(|arm| &arm.name);
    let mut has_program = [false; 2];
    for (path, _) in programs {
        let Some(arm) = named_arm(cell, path) else {
            let message = format!(
                "{}: a program is for one arm: let the file's name end with \"{one}\" or \"{two}\"",
                path.display()
            );
            return Err(Failure::Usage(message));
        };
        has_program[arm] = true;
    }
    match has_program.iter().position(|has| !has) {
        None => Ok(()),
        Some(arm) => {
            let name = &cell.arms[arm].name;
            Err(Failure::Usage(format!("--template needs a program for each arm: add --output \"{name}.EXT\"")))
        }
    }
}

impl CellPrograms {
    /// Returns the programs of found motions.
    ///
    /// # Errors
    /// Motions without signals, a defect of the template, and programs that are not certified as written.
    pub fn new(cell: &Cell, found: &Coordination, writer: &ProgramWriter) -> Result<Self, Failure> {
        let unsuitable = || {
            ProgramError::Unsuitable("cplan found no signals that keep the arms apart if one of them is late".into())
        };
        let interlocks = found.interlocks.as_ref().ok_or_else(unsuitable)?;
        let mut made = Vec::new();
        for (arm, CellArm { problem, .. }) in cell.arms.iter().enumerate() {
            let joints = cell.joints(arm);
            let program = match &found.planned {
                Some(planned) => {
                    let steps = (&planned[arm].task, &planned[arm].legs[..]);
                    Program::of_steps(problem, &joints, steps, writer.tolerance, writer.clearance)?
                }
                None => {
                    let curve = &found.motions[arm].curve;
                    let motion = (curve.curve().path(), curve.clearance());
                    Program::of_motion(problem, &joints, motion, writer.tolerance, writer.clearance)?
                }
            };
            let signals: Vec<Signal> =
                interlocks.iter().zip(1..).map(|(interlock, number)| signal(found, arm, interlock, number)).collect();
            let program = program.with_digests(digests(cell)?).with_signals(&signals, &cell.arms[1 - arm].name);
            let written = writer.template.write(&program)?;
            made.push((program, written));
        }
        let [(one, first), (two, second)] = <[(Program, Written); 2]>::try_from(made).expect("one for each arm");
        let target =
            |arm: usize, number: usize| [&one, &two][arm].signal_target(number).expect("a signal of both arms");
        let of_interlock = |(interlock, number): (&Interlock, usize)| SignalTargets {
            waits: interlock.waits,
            at: target(interlock.waits, number),
            set: target(1 - interlock.waits, number),
        };
        let signals: Vec<SignalTargets> = interlocks.iter().zip(1..).map(of_interlock).collect();
        let paths = [one.configurations(&first.targets)?, two.configurations(&second.targets)?];
        let rooms = cell.arms.each_ref().map(|arm| writer.tolerance.room_as_written(&arm.problem));
        let required = writer.clearance + rooms.iter().sum::<f64>();
        let parts = [&one, &two].map(step_parts);
        let steps = found.planned.as_ref().map(|planned| ProgramSteps {
            planned,
            parts: parts.each_ref().map(Vec::as_slice),
            height_tolerance: writer.tolerance.height_as_written(),
        });
        check_delays(cell, paths.each_ref().map(Vec::as_slice), &signals, required, steps)
            .map_err(ProgramError::NotCertified)?;
        let summaries = [one.summary(), two.summary()];
        Ok(Self { written: [first, second], summaries, clearance: writer.clearance, signals })
    }

    /// Returns the text for a file whose name ends in that of an arm.
    pub fn text(&self, cell: &Cell, path: &Path) -> Option<&str> {
        Some(&self.written[named_arm(cell, path)?].text)
    }

    /// Returns the number of the target at which an arm uses a signal. Both numbers begin with 1.
    pub fn target(&self, signal: usize, arm: usize) -> usize {
        self.signals[signal - 1].of(arm) + 1
    }

    /// Returns the lines of the summary.
    pub fn lines(&self, cell: &Cell) -> Vec<Line> {
        let of_arm = |(arm, summary): (&CellArm, &String)| ("program", format!("{}: {summary}", arm.name));
        let kept = match self.clearance > 0.0 {
            true => format!("keep {} apart", length_down(self.clearance)),
            false => "do not touch".to_owned(),
        };
        let both = format!("with the signals, the arms {kept}, whichever program is late: proven");
        cell.arms.iter().zip(&self.summaries).map(of_arm).chain([("programs", both)]).collect()
    }
}

/// Returns the signal of an interlock in the program of an arm.
fn signal(found: &Coordination, arm: usize, interlock: &Interlock, number: usize) -> Signal {
    let (usage, time) = match interlock.waits == arm {
        true => (SignalUse::Wait, interlock.at),
        false => (SignalUse::Set, interlock.set),
    };
    let (step, place) = signal_place(found, arm, time, usage);
    Signal { number, usage, step, place }
}

/// Returns the step of an arm in which it uses a signal at a time, and the place there. While the arm rests, a program waits at
/// the beginning of the rest, and sets signals at its end.
fn signal_place(found: &Coordination, arm: usize, time: f64, usage: SignalUse) -> (usize, SignalPlace) {
    let along = |begin: f64| SignalPlace::Along(found.travelled(arm, time) - found.travelled(arm, begin));
    let steps = &found.steps[arm];
    for (number, StepTimes { begin, arrival, end, .. }) in steps.iter().enumerate() {
        match time {
            // Before the departure, the tool may be raised.
            time if time < begin - SAME_TIME && usage == SignalUse::Wait && number > 0 => {
                return (number - 1, SignalPlace::End);
            }
            time if time <= begin + SAME_TIME => return (number, SignalPlace::Along(0.0)),
            time if time < arrival - SAME_TIME => return (number, along(*begin)),
            time if time <= arrival + SAME_TIME => return (number, SignalPlace::Arrival),
            time if time <= end + SAME_TIME => {
                let place = if usage == SignalUse::Wait { SignalPlace::Arrival } else { SignalPlace::End };
                return (number, place);
            }
            _ => {}
        }
    }
    match steps.len() {
        0 => (0, along(0.0)),
        count => (count - 1, SignalPlace::End),
    }
}

/// Returns the steps of a program's moves for the judgement between both arms.
fn step_parts(program: &Program) -> Vec<(usize, StepPart)> {
    let part = |(step, part)| {
        let part = match part {
            MovePart::Raising => StepPart::Raising,
            MovePart::Travel => StepPart::Motion,
            MovePart::Acts => StepPart::Acts,
        };
        (step, part)
    };
    program.parts().into_iter().map(part).collect()
}

/// Returns the names of the files of a cell, with their digests.
fn digests(cell: &Cell) -> Result<Vec<[String; 2]>, Failure> {
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    cell.files.iter().map(|path| Ok([name(path), digest(path)?])).collect()
}
