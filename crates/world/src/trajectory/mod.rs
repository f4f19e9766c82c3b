//! Joint paths and trajectories from files: cplan's own JSON and CSV, anyone's CSV, and ROS 2 messages in YAML.
//!
//! Names decide which column is which joint, not their order. Every reader makes [`Samples`]; what holds for all of
//! them (the arm's joints are there, what the held joints do can be judged, times increase) is checked once, here.

mod claims;
mod columns;
mod csv;
mod document;
#[cfg(feature = "mcap")]
mod mcap;
mod other_joints;
mod records;
mod steps;
mod units;

use super::LoadedScene;
use cplan_core::model::JointType;
use cplan_core::space::Configuration;
use cplan_handling::{Claims, HeldJoint, HeldMotion, Interpolation, RecordedStep, Recording, RecordingError};
use cplan_robot::{Diagnostic, InputError, Source, quoted};
use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;

/// What to say of accelerations that do not join samples.
const STATED: &str = "accelerations in the file are held to the limits, but do not change the motion: positions and velocities \
                      imply it";

/// A recorded motion and how it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedRecording {
    /// The arm's two joints, base to tip.
    pub recording: Recording,
    /// What other joints do that the world holds still, if they move.
    pub held: Vec<HeldMotion>,
    /// The steps of a task: of a result of cplan's for a world that has steps.
    pub steps: Option<Vec<RecordedStep>>,
    /// What a result of cplan's says besides the samples.
    pub claims: Option<Claims>,
    /// Whether it has torques.
    pub has_torques: bool,
    /// What the user should know: what was ignored, and which rule joins the samples.
    pub notes: Vec<String>,
}

/// What a file holds of one joint.
#[derive(Debug, Default)]
struct Series {
    name: String,
    position: Vec<f64>,
    velocity: Option<Vec<f64>>,
    acceleration: Option<Vec<f64>>,
}

/// What a file holds.
#[derive(Debug, Default)]
struct Samples {
    time: Option<Vec<f64>>,
    joints: Vec<Series>,
    /// What the file holds of joints at other times than the samples', with positions alone.
    aside: Vec<Series>,
    /// How samples are joined that have accelerations, if these do it; see [`Interpolation`].
    joined: Option<Interpolation>,
    /// Samples after which nothing is joined: the arm stands until the next.
    rests: Vec<usize>,
    has_torques: bool,
    /// How the file calls sample `k`: this, with `k` in brackets.
    what: Cow<'static, str>,
    /// Where in the text each sample is, if the reader knows.
    places: Vec<Range<usize>>,
    notes: Vec<String>,
}

/// Reads a joint path or trajectory; the file's extension tells the format: `.json`, `.csv`, `.yaml`, `.yml` or `.mcap`.
///
/// - JSON: a result of cplan's own (its trajectory, else its path), with the steps if it and the world have any; or a ROS 2
///   message;
/// - CSV: a header of names, then a sample a line. A column is a joint's position if its name is the joint's, or the
///   joint's with `position` before or after it; velocities likewise; `time`, `t`, `time_from_start` or `__time` are seconds. A unit may
///   follow in brackets: `elbow [deg]`;
/// - MCAP (a feature): what ROS 2 recorded on the one topic of type `trajectory_msgs/msg/JointTrajectory` that has both of the
///   arm's joints, else on the one of type `sensor_msgs/msg/JointState`; see [`load_topic`] for recordings with several;
/// - YAML: `trajectory_msgs/msg/JointTrajectory`, also as a member `joint_trajectory` or `trajectory`.
///
/// # Errors
/// Files that cannot be read, are no such format, have steps that are none, lack a joint, move a held joint otherwise than along the plane's normal or about it, or whose samples
/// are no motion; with the place in the file and what to do about it.
pub fn load_recording(path: &Path, scene: &LoadedScene) -> Result<LoadedRecording, InputError> {
    load(path, None, scene)
}

/// Reads what was recorded on one topic of an MCAP file.
///
/// # Errors
/// As for [`load_recording`], and for files of other formats, which have no topics.
pub fn load_topic(path: &Path, topic: &str, scene: &LoadedScene) -> Result<LoadedRecording, InputError> {
    load(path, Some(topic), scene)
}

fn load(path: &Path, topic: Option<&str>, scene: &LoadedScene) -> Result<LoadedRecording, InputError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    if !matches!(extension.as_deref(), Some("json" | "csv" | "yaml" | "yml" | "mcap")) {
        return Err(Diagnostic::new(path.display().to_string(), "cannot tell the format of this file")
            .help("name it .json (cplan), .csv, .yaml (ROS 2 JointTrajectory), or .mcap (ROS 2 recording)")
            .into());
    }
    if extension.as_deref() == Some("mcap") {
        return recorded(path, topic, &Names::of(scene));
    }
    if topic.is_some() {
        let diagnostic =
            Diagnostic::new(path.display().to_string(), "has no topics: only recordings of ROS 2 (.mcap) have");
        return Err(diagnostic.help("leave --topic out").into());
    }
    read_recording(&Source::read_recording(path)?, scene)
}

/// The same from a text: its name's extension tells the format, JSON where it is none of the others.
///
/// # Errors
/// As for [`load_recording`].
pub fn read_recording(source: &Source, scene: &LoadedScene) -> Result<LoadedRecording, InputError> {
    let names = Names::of(scene);
    let extension = source.path().extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let (samples, steps, claims) = match extension.as_deref() {
        Some("csv") => (csv::read(source, &names)?, None, None),
        Some("yaml" | "yml") => (document::yaml(source)?, None, None),
        _ => {
            let samples = document::json(source)?;
            let steps = if scene.has_steps() { steps::json(source, &samples)? } else { None };
            (samples, steps, claims::json(source, names.arm)?)
        }
    };
    Ok(LoadedRecording { steps, claims, ..names.recording(source, samples)? })
}

/// A recording of topics.
#[cfg(feature = "mcap")]
fn recorded(path: &Path, topic: Option<&str>, names: &Names) -> Result<LoadedRecording, InputError> {
    let bytes = cplan_robot::read_recorded(path)?;
    let source = Source::in_memory(path, "");
    Ok(names.recording(&source, mcap::read(&source, &bytes, topic, names)?)?)
}

/// A recording of topics.
#[cfg(not(feature = "mcap"))]
fn recorded(path: &Path, _: Option<&str>, _: &Names) -> Result<LoadedRecording, InputError> {
    let diagnostic = Diagnostic::new(path.display().to_string(), "this program was built without MCAP");
    Err(diagnostic.help("verify a .json, .csv or .yaml, or build with --features mcap").into())
}

/// The joints that a file can speak of.
struct Names<'a> {
    arm: [&'a str; 2],
    /// Whether each of the arm's joints turns, or slides.
    turns: [bool; 2],
    held: &'a [HeldJoint],
    /// Why no motion of the held joints can be judged, if so.
    rigid: Option<&'static str>,
    /// Whether the world has steps, in which a wrist turns and a quill goes up and down.
    has_steps: bool,
}

impl<'a> Names<'a> {
    fn of(scene: &'a LoadedScene) -> Self {
        Self {
            arm: scene.scene.arm().joints.each_ref().map(|j| j.name.as_str()),
            turns: scene.scene.arm().joints.each_ref().map(|j| matches!(j.joint_type, JointType::Revolute { .. })),
            held: &scene.robot.held_joints,
            rigid: other_joints::rigid(&scene.scene),
            has_steps: scene.has_steps(),
        }
    }

    fn all(&self) -> impl Iterator<Item = &str> {
        self.arm.iter().copied().chain(self.held.iter().map(|joint| joint.name.as_str()))
    }

    /// The arm's two joints of what was read.
    fn recording(&self, source: &Source, mut samples: Samples) -> Result<LoadedRecording, Diagnostic> {
        let mut notes = std::mem::take(&mut samples.notes);
        let mut chosen = Vec::new();
        for name in self.arm {
            match samples.joints.iter().position(|s| s.name == name) {
                Some(index) => chosen.push(samples.joints.swap_remove(index)),
                None => {
                    let others = samples.joints.iter().chain(&chosen).map(|s| &s.name);
                    let message = format!("holds no positions of joint \"{name}\"; it holds {}", quoted(others));
                    let help = format!("the arm's joints are {}: name the positions so", quoted(self.arm));
                    return Err(source.diagnostic(message).help(help));
                }
            }
        }
        let Ok([one, two]) = <[Series; 2]>::try_from(chosen) else {
            return Err(source.diagnostic("two joints are needed").help("name the positions of both"));
        };
        let both = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| Configuration::new(*a, *b)).collect();
        let mut rows = |what: &str, a: &Option<Vec<f64>>, b: &Option<Vec<f64>>| match (a, b) {
            (Some(a), Some(b)) => Some(both(a, b)),
            (None, None) => None,
            _ => {
                notes.push(format!("{what} of only one joint: not used"));
                None
            }
        };
        let velocity = rows("velocities", &one.velocity, &two.velocity);
        let acceleration = rows("accelerations", &one.acceleration, &two.acceleration);
        let position = both(&one.position, &two.position);
        let recording = Recording::new(position, samples.time.take(), velocity).and_then(|recording| {
            let rule = samples.joined.unwrap_or(recording.interpolation());
            let recording = match acceleration {
                Some(acceleration) => recording.accelerated(acceleration, rule)?,
                None => recording,
            };
            Ok(recording.resting_after(&samples.rests))
        });
        let recording = recording.map_err(|d| misplaced(source, &samples, &d))?;
        let held = self.moved(source, &samples, &recording, &mut notes)?;
        notes.push(rule(&recording).into());
        notes.extend((recording.accelerations().is_some() && samples.joined.is_none()).then(|| STATED.into()));
        Ok(LoadedRecording { recording, held, steps: None, claims: None, has_torques: samples.has_torques, notes })
    }
}

impl Samples {
    /// A diagnostic of one sample.
    fn diagnostic(&self, source: &Source, sample: usize, message: &str) -> Diagnostic {
        match self.places.get(sample) {
            Some(place) => source.diagnostic_at(place.clone(), message),
            None => source.diagnostic(format!("{}[{sample}]: {message}", self.what)),
        }
    }
}

fn misplaced(source: &Source, samples: &Samples, diagnostic: &RecordingError) -> Diagnostic {
    let message = diagnostic.to_string();
    let placed = match diagnostic.sample() {
        Some(sample) => samples.diagnostic(source, sample, &message),
        None => source.diagnostic(message),
    };
    match diagnostic {
        RecordingError::Empty => placed.help("record at least one sample"),
        RecordingError::Count { .. } => placed.help("give every sample all of its values"),
        RecordingError::VelocityWithoutTime => placed.help("add the times, in seconds, or leave the velocities out"),
        RecordingError::AccelerationWithoutVelocity => {
            placed.help("add the velocities, or leave the accelerations out: no controller joins samples without them")
        }
        RecordingError::Value { what, .. } => {
            placed.help(format!("a {what} is a finite number: radians or metres, and seconds"))
        }
        RecordingError::Time { .. } => placed.help("sort the samples by time and drop repeated ones"),
    }
}

/// How the samples are joined, in words.
fn rule(recording: &Recording) -> &'static str {
    match (recording.interpolation(), recording.times()) {
        (Interpolation::Cubic, _) => "between samples: the cubic that positions and velocities imply",
        (Interpolation::Quartic, _) => {
            "between samples: the polynomial of the fourth degree that the file's `interpolation` says"
        }
        (Interpolation::Quintic, _) => {
            "between samples: the polynomial of the fifth degree that positions, velocities and accelerations imply, as \
             ROS 2's joint_trajectory_controller joins them"
        }
        (Interpolation::Linear, Some(_)) => {
            "between samples: straight in joint space at constant velocity; without velocities in the file, \
             accelerations and rest at the ends cannot be judged"
        }
        (Interpolation::Linear, None) => {
            "between waypoints: straight in joint space; without times in the file, velocities and accelerations cannot \
             be judged"
        }
    }
}
