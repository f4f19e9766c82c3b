//! The steps in a result of a task.

use super::samples::Samples;
use crate::parsers::json_diagnostic;
use cplan_handling::{RecordedOverlap, RecordedStep, RecordedTurn, RecordedWrist};
use cplan_robot::{Diagnostic, InputError, Source};
use serde::Deserialize;

/// Largest valid angle (radians) or time (seconds), as in recordings. Below it, doubles resolve a nanoradian.
const MAX_NUMBER: f64 = 1e6;

/// Largest valid velocity or acceleration of a wrist, radians and seconds.
const MAX_RATE: f64 = 1e12;

/// The members that are read. Other members are ignored.
#[derive(Deserialize)]
struct Document {
    steps: Option<Vec<StepMember>>,
}

/// A step of a cplan result.
#[derive(Deserialize)]
struct StepMember {
    step: usize,
    cycle: usize,
    first_sample: Option<usize>,
    last_sample: Option<usize>,
    turn: Option<TurnMember>,
    raising: Option<StrokeMember>,
    stroke: Option<StrokeMember>,
    wrist: Option<RecordedWrist>,
    wrist_motion: Option<WristMotionMember>,
}

#[derive(Deserialize)]
struct WristMotionMember {
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

#[derive(Deserialize)]
struct StrokeMember {
    lowered: Option<f64>,
    #[serde(default)]
    before_arrival: f64,
    #[serde(default)]
    after_departure: f64,
}

#[derive(Deserialize, Clone, Copy)]
struct TurnMember {
    from: f64,
    to: f64,
    seconds: f64,
    #[serde(default)]
    before_arrival: f64,
    #[serde(default)]
    after_departure: f64,
}

/// Reads the steps of a JSON file. `None` if it has none.
///
/// # Errors
/// Missing members, values that are not numbers, and samples that the file does not have. Also steps, if the samples lack times
/// or velocities.
pub(super) fn json(source: &Source, samples: &Samples) -> Result<Option<Vec<RecordedStep>>, InputError> {
    let document: Document = serde_json::from_str(source.text()).map_err(|error| {
        let help = "write steps as in a task's result of cplan: step, cycle, first_sample and last_sample";
        json_diagnostic(source, &error).help(help)
    })?;
    let Some(steps) = document.steps else { return Ok(None) };
    let count = samples.joints.first().map_or(0, |joint| joint.position.len());
    if samples.time.is_none() || samples.joints.iter().any(|joint| joint.velocity.is_none()) {
        let message = "has steps, but its trajectory lacks time, position or velocity";
        return Err(source.diagnostic(message).help("verify the result of a whole task, written by cplan").into());
    }
    let read = |(index, member): (usize, &StepMember)| member.read(source, index, count);
    Ok(Some(steps.iter().enumerate().map(read).collect::<Result<_, _>>()?))
}

impl StepMember {
    fn read(&self, source: &Source, index: usize, count: usize) -> Result<RecordedStep, Diagnostic> {
        let wrong = |message: &str, help: &str| source.diagnostic(format!("steps[{index}]: {message}")).help(help);
        let (Some(first), Some(last)) = (self.first_sample, self.last_sample) else {
            let message = "first_sample or last_sample is missing";
            return Err(wrong(message, "verify the result of a whole task, written by cplan"));
        };
        if first > last || last >= count {
            let help = "state the first and the last sample of the step, counted from 0";
            return Err(wrong(
                &format!("the samples of the step are {first} to {last}, but the trajectory has {count} samples"),
                help,
            ));
        }
        let overlap = |of: &str, before_arrival: f64, after_departure: f64| {
            let parts = [("before_arrival", before_arrival), ("after_departure", after_departure)];
            match parts.into_iter().find(|(_, value)| !(0.0..=MAX_NUMBER).contains(value)) {
                Some((what, value)) => {
                    Err(wrong(&format!("the {of}'s {what} is {value}"), "write the seconds of the overlap, 0 or more"))
                }
                None => Ok(RecordedOverlap { before_arrival, after_departure }),
            }
        };
        let finite = |of: &str, numbers: &[(&str, f64)], help: &str| match numbers
            .iter()
            .find(|(_, value)| value.is_nan() || value.abs() > MAX_NUMBER)
        {
            Some((what, value)) => Err(wrong(&format!("the {of}'s {what} is {value}"), help)),
            None => Ok(()),
        };
        let turn = match self.turn {
            None => None,
            Some(TurnMember { from, to, seconds, before_arrival, after_departure }) => {
                let help = "write the two angles of the turn in radians, and its duration in seconds";
                finite("turn", &[("from", from), ("to", to), ("seconds", seconds)], help)?;
                let overlap = overlap("turn", before_arrival, after_departure)?;
                Some(RecordedTurn { from, to, seconds, overlap })
            }
        };
        let raising = match &self.raising {
            None => 0.0,
            Some(StrokeMember { after_departure, .. }) => overlap("raising", 0.0, *after_departure)?.after_departure,
        };
        let overlap = match &self.stroke {
            None => RecordedOverlap::default(),
            Some(StrokeMember { before_arrival, after_departure, .. }) => {
                overlap("stroke", *before_arrival, *after_departure)?
            }
        };
        if let Some(RecordedWrist { from, to, begin, seconds }) = self.wrist {
            let help = "write the two values of the wrist's joint in radians, and the beginning and the duration of the turn in seconds";
            finite("wrist", &[("from", from), ("to", to), ("begin", begin), ("seconds", seconds)], help)?;
        }
        let wrist_motion = match &self.wrist_motion {
            None => None,
            Some(WristMotionMember { position, velocity, acceleration }) => {
                let columns = [position, velocity, acceleration];
                let help =
                    "write one position, velocity and acceleration of the wrist's joint for each sample of the step";
                if let Some(column) = columns.into_iter().find(|column| column.len() != last - first + 1) {
                    let message = format!(
                        "wrist_motion has {} values, but the step has {} samples",
                        column.len(),
                        last - first + 1
                    );
                    return Err(wrong(&message, help));
                }
                if let Some(value) = columns.into_iter().flatten().find(|x| x.is_nan() || x.abs() > MAX_RATE) {
                    return Err(wrong(&format!("a value of wrist_motion is {value}"), help));
                }
                Some((0..position.len()).map(|k| columns.map(|column| column[k])).collect())
            }
        };
        let lowered = [&self.raising, &self.stroke].map(|stroke| stroke.as_ref().and_then(|stroke| stroke.lowered));
        Ok(RecordedStep {
            number: self.step,
            cycle: self.cycle,
            samples: first..=last,
            turn,
            overlap,
            raising,
            lowered,
            wrist: self.wrist,
            wrist_motion,
        })
    }
}
