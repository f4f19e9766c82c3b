//! The contents of a file with joint values, in any format.

use cplan_handling::{HeldJoint, Interpolation, RecordingError};
use cplan_robot::{Diagnostic, Source};
use std::borrow::Cow;
use std::ops::Range;

/// The values of one joint.
#[derive(Debug, Default)]
pub(super) struct Series {
    pub name: String,
    pub position: Vec<f64>,
    pub velocity: Option<Vec<f64>>,
    pub acceleration: Option<Vec<f64>>,
}

/// The samples of a file, and what the file states about them.
#[derive(Debug, Default)]
pub(super) struct Samples {
    pub time: Option<Vec<f64>>,
    pub joints: Vec<Series>,
    /// Positions of joints at other times than those of `time`.
    pub other_series: Vec<Series>,
    /// Interpolation of samples with accelerations. `None` if accelerations do not determine the motion between
    /// samples.
    pub joined: Option<Interpolation>,
    /// Indices of samples after which the arm stands still until the next sample.
    pub rests: Vec<usize>,
    pub has_torques: bool,
    /// The file's word for a sample. In messages, the sample's index in brackets follows it.
    pub what: Cow<'static, str>,
    /// Position of each sample in the text. Empty if the reader does not know the positions.
    pub places: Vec<Range<usize>>,
    pub notes: Vec<String>,
}

/// The joints that a file may name.
pub(super) struct Names<'a> {
    pub arm: [&'a str; 2],
    /// For each of the arm's joints, true if it is revolute.
    pub turns: [bool; 2],
    pub held: &'a [HeldJoint],
    /// The reason why motions of held joints cannot be checked. `None` if they can.
    pub rigid: Option<&'static str>,
    /// True if the world has steps. During steps, a wrist turns, and the tool's joint moves up and down.
    pub has_steps: bool,
}

impl Names<'_> {
    pub fn all(&self) -> impl Iterator<Item = &str> {
        self.arm.iter().copied().chain(self.held.iter().map(|joint| joint.name.as_str()))
    }
}

impl Samples {
    /// Creates a diagnostic about one sample.
    pub fn diagnostic(&self, source: &Source, sample: usize, message: &str) -> Diagnostic {
        match self.places.get(sample) {
            Some(place) => source.diagnostic_at(place.clone(), message),
            None => source.diagnostic(format!("{}[{sample}]: {message}", self.what)),
        }
    }
}

/// Converts the error of a recording to a diagnostic at the sample in question.
pub(super) fn misplaced(source: &Source, samples: &Samples, diagnostic: &RecordingError) -> Diagnostic {
    let message = diagnostic.to_string();
    let placed = match diagnostic.sample() {
        Some(sample) => samples.diagnostic(source, sample, &message),
        None => source.diagnostic(message),
    };
    match diagnostic {
        RecordingError::Empty => placed.help("record at least one sample"),
        RecordingError::Count { .. } => placed.help("write all values of each sample"),
        RecordingError::VelocityWithoutTime => placed.help("add the times, in seconds, or leave the velocities out"),
        RecordingError::AccelerationWithoutVelocity => placed
            .help("add the velocities, or leave the accelerations out: no controller interpolates without velocities"),
        RecordingError::Value { what, .. } => {
            placed.help(format!("write each {what} as a finite number, in radians or metres, and seconds"))
        }
        RecordingError::Time { .. } => placed.help("sort the samples by time and drop repeated ones"),
    }
}
