//! What a file holds, whatever its format.

use cplan_handling::{HeldJoint, Interpolation, RecordingError};
use cplan_robot::{Diagnostic, Source};
use std::borrow::Cow;
use std::ops::Range;

/// What a file holds of one joint.
#[derive(Debug, Default)]
pub(super) struct Series {
    pub name: String,
    pub position: Vec<f64>,
    pub velocity: Option<Vec<f64>>,
    pub acceleration: Option<Vec<f64>>,
}

/// What a file holds.
#[derive(Debug, Default)]
pub(super) struct Samples {
    pub time: Option<Vec<f64>>,
    pub joints: Vec<Series>,
    /// What the file holds of joints at other times than the samples', with positions alone.
    pub aside: Vec<Series>,
    /// How samples are joined that have accelerations, if these do it; see [`Interpolation`].
    pub joined: Option<Interpolation>,
    /// Samples after which nothing is joined: the arm stands until the next.
    pub rests: Vec<usize>,
    pub has_torques: bool,
    /// How the file calls sample `k`: this, with `k` in brackets.
    pub what: Cow<'static, str>,
    /// Where in the text each sample is, if the reader knows.
    pub places: Vec<Range<usize>>,
    pub notes: Vec<String>,
}

/// The joints that a file can speak of.
pub(super) struct Names<'a> {
    pub arm: [&'a str; 2],
    /// Whether each of the arm's joints turns, or slides.
    pub turns: [bool; 2],
    pub held: &'a [HeldJoint],
    /// Why no motion of the held joints can be judged, if so.
    pub rigid: Option<&'static str>,
    /// Whether the world has steps, in which a wrist turns and a quill goes up and down.
    pub has_steps: bool,
}

impl Names<'_> {
    pub fn all(&self) -> impl Iterator<Item = &str> {
        self.arm.iter().copied().chain(self.held.iter().map(|joint| joint.name.as_str()))
    }
}

impl Samples {
    /// A diagnostic of one sample.
    pub fn diagnostic(&self, source: &Source, sample: usize, message: &str) -> Diagnostic {
        match self.places.get(sample) {
            Some(place) => source.diagnostic_at(place.clone(), message),
            None => source.diagnostic(format!("{}[{sample}]: {message}", self.what)),
        }
    }
}

/// What is wrong with samples, at the one that it is about.
pub(super) fn misplaced(source: &Source, samples: &Samples, diagnostic: &RecordingError) -> Diagnostic {
    let message = diagnostic.to_string();
    let placed = match diagnostic.sample() {
        Some(sample) => samples.diagnostic(source, sample, &message),
        None => source.diagnostic(message),
    };
    match diagnostic {
        RecordingError::Empty => placed.help("record at least one sample"),
        RecordingError::Count { .. } => placed.help("give every sample all of its values"),
        RecordingError::VelocityWithoutTime => placed.help("add the times, in seconds, or leave the velocities out"),
        RecordingError::AccelerationWithoutVelocity => placed
            .help("add the velocities, or leave the accelerations out: no controller interpolates without velocities"),
        RecordingError::Value { what, .. } => {
            placed.help(format!("a {what} is a finite number: radians or metres, and seconds"))
        }
        RecordingError::Time { .. } => placed.help("sort the samples by time and drop repeated ones"),
    }
}
