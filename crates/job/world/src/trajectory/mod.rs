//! Joint paths and trajectories from files: cplan's JSON and CSV, other programs' CSV, and ROS 2 messages.
//!
//! The name of a column, not its place, determines its joint. The reader of each format returns [`Samples`]. This module then
//! checks that the arm's joints are present, that motions of held joints can be judged, and that times increase.

mod all_joints;
mod claims;
mod columns;
mod csv;
mod document;
#[cfg(feature = "mcap")]
mod mcap;
mod other_joints;
mod records;
mod samples;
mod steps;
mod units;

use super::LoadedScene;
use cplan_handling::{Claims, HeldMotion, Interpolation, RecordedJoints, RecordedStep, Recording};
use cplan_model::JointType;
use cplan_model::space::Configuration;
use cplan_robot::{Diagnostic, InputError, Source, quoted};
use samples::{Names, Samples, Series, misplaced};
use std::path::Path;

/// Note about accelerations that do not determine the motion between samples.
const STATED_ACCELERATIONS_NOTE: &str =
    "positions and velocities determine the motion; accelerations in the file are only compared with the limits";

/// A recorded motion, and how it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedRecording {
    /// The motion of the arm's two joints, base to tip.
    pub recording: Recording,
    /// Motions of joints that are fixed in the world but move in the recording.
    pub held: Vec<HeldMotion>,
    /// Reasons why the motion of some joints cannot be judged if the file does not state a task's steps.
    pub unjudged: Vec<String>,
    /// The steps of a task. `None` unless the file is cplan's result for a world with steps.
    pub steps: Option<Vec<RecordedStep>>,
    /// The motion of all joints of the robot, which cplan's result of a task states.
    pub all_joints: Option<AllJoints>,
    /// The claims that a cplan result makes about the samples.
    pub claims: Option<Claims>,
    /// True if the recording has torques.
    pub has_torques: bool,
    /// Notes for the user about ignored parts, and about how samples are joined.
    pub notes: Vec<String>,
}

/// The motion of all joints of a robot, and how it would be read from a table.
#[derive(Debug, Clone, PartialEq)]
pub struct AllJoints {
    /// The motion.
    pub joints: RecordedJoints,
    /// Motions of joints that are fixed in the world. `None` if they cannot be judged.
    pub held: Option<Vec<HeldMotion>>,
}

/// Reads a recorded motion: a joint path or a trajectory. The file's extension determines the format: `.json`, `.csv`, `.txt`
/// (read like `.csv`), `.yaml`, `.yml` or `.mcap`.
///
/// - JSON: a result of cplan, or a ROS 2 message. From a result, cplan reads the trajectory, or the path if there is no
///   trajectory. It also reads the steps if both result and world have steps.
/// - CSV: a header with names of columns, then one line per sample. A joint's positions have the name of the joint, possibly with
///   `position` before or after it, and its velocities the name with `velocity`. `time`, `t`, `time_from_start` and `__time` are
///   seconds. A unit may follow in brackets: `elbow [deg]`.
/// - MCAP (a feature of the crate): a recording of ROS 2. It must have exactly one topic of type
///   `trajectory_msgs/msg/JointTrajectory` with both of the arm's joints, or otherwise exactly one of type
///   `sensor_msgs/msg/JointState`. See [`load_topic`] for recordings with several topics.
/// - YAML: a `trajectory_msgs/msg/JointTrajectory`, which may be a member `joint_trajectory` or `trajectory`.
///
/// # Errors
/// Files that cannot be read or have another format, invalid steps, a missing joint, and samples that are not a motion. A held
/// joint whose motion is neither along the plane's normal nor about it. Each error has the place in the file and a hint.
pub fn load_recording(path: &Path, scene: &LoadedScene) -> Result<LoadedRecording, InputError> {
    load(path, None, scene)
}

/// Reads the messages on one topic of an MCAP file.
///
/// # Errors
/// The errors of [`load_recording`], and files of other formats, which have no topics.
pub fn load_topic(path: &Path, topic: &str, scene: &LoadedScene) -> Result<LoadedRecording, InputError> {
    load(path, Some(topic), scene)
}

fn load(path: &Path, topic: Option<&str>, scene: &LoadedScene) -> Result<LoadedRecording, InputError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    if path.is_dir() || extension.as_deref() == Some("db3") {
        return Err(Diagnostic::new(path.display().to_string(), "recordings of ROS 2 are read from .mcap files only")
            .help("give the .mcap file of the recording; `ros2 bag convert` makes one of a recording in .db3")
            .into());
    }
    if !matches!(extension.as_deref(), Some("json" | "csv" | "txt" | "yaml" | "yml" | "mcap")) {
        return Err(Diagnostic::new(path.display().to_string(), "the format of this file is unknown")
            .help("name it .json (cplan), .csv, .yaml (ROS 2 JointTrajectory), or .mcap (ROS 2 recording)")
            .into());
    }
    if extension.as_deref() == Some("mcap") {
        return recorded(path, topic, &Names::of(scene));
    }
    if topic.is_some() {
        let diagnostic =
            Diagnostic::new(path.display().to_string(), "has no topics: only recordings of ROS 2 (.mcap) have topics");
        return Err(diagnostic.help("leave --topic out").into());
    }
    read_recording(&Source::read_recording(path)?, scene)
}

/// Reads a recording from a text. The extension of its name determines the format; without one, it is JSON.
///
/// # Errors
/// The errors of [`load_recording`].
pub fn read_recording(source: &Source, scene: &LoadedScene) -> Result<LoadedRecording, InputError> {
    let names = Names::of(scene);
    let extension = source.path().extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("csv" | "txt") => Ok(names.recording(source, csv::read(source, &names)?)?),
        Some("yaml" | "yml") => Ok(names.recording(source, document::yaml(source)?)?),
        _ => read_json(source, scene, &names),
    }
}

/// Reads a JSON file. If no steps are read, the motion of all joints takes precedence over that of the arm's two joints.
fn read_json(source: &Source, scene: &LoadedScene, names: &Names) -> Result<LoadedRecording, InputError> {
    let samples = document::json(source)?;
    let steps = if scene.is_task() { steps::json(source, &samples)? } else { None };
    let claims = claims::json(source, names.arm)?;
    let whole = if steps.is_none() { names.whole_motion(source)? } else { None };
    if let Some(whole) = whole {
        return Ok(LoadedRecording { claims, ..whole });
    }
    let all_joints = names.all_joints(source)?;
    Ok(LoadedRecording { steps, all_joints, claims, ..names.recording(source, samples)? })
}

#[cfg(feature = "mcap")]
fn recorded(path: &Path, topic: Option<&str>, names: &Names) -> Result<LoadedRecording, InputError> {
    let bytes = cplan_robot::read_recorded(path)?;
    let source = Source::in_memory(path, "");
    Ok(names.recording(&source, mcap::read(&source, &bytes, topic, names)?)?)
}

/// Refuses MCAP files, which this build of the program cannot read.
#[cfg(not(feature = "mcap"))]
fn recorded(path: &Path, _: Option<&str>, _: &Names) -> Result<LoadedRecording, InputError> {
    let diagnostic = Diagnostic::new(path.display().to_string(), "this program was built without MCAP");
    Err(diagnostic.help("verify a .json, .csv or .yaml, or build with --features mcap").into())
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

    /// Returns the recording of the arm's two joints.
    fn recording(&self, source: &Source, mut samples: Samples) -> Result<LoadedRecording, Diagnostic> {
        let mut notes = std::mem::take(&mut samples.notes);
        let mut chosen = Vec::new();
        for name in self.arm {
            match samples.joints.iter().position(|s| s.name == name) {
                Some(index) => chosen.push(samples.joints.swap_remove(index)),
                None => {
                    let others = samples.joints.iter().chain(&chosen).map(|s| &s.name);
                    let message = format!("holds no positions of joint \"{name}\", but those of {}", quoted(others));
                    let help = format!("name the positions after the arm's joints: {}", quoted(self.arm));
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
                notes.push(format!("{what} of only one joint are ignored"));
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
        let mut unjudged = Vec::new();
        let held = self.moved(source, &samples, &recording, &mut notes, &mut unjudged)?;
        notes.push(rule(&recording).into());
        notes.extend(
            (recording.accelerations().is_some() && samples.joined.is_none()).then(|| STATED_ACCELERATIONS_NOTE.into()),
        );
        let has_torques = samples.has_torques;
        Ok(LoadedRecording {
            recording,
            held,
            unjudged,
            steps: None,
            all_joints: None,
            claims: None,
            has_torques,
            notes,
        })
    }
}

/// Describes the interpolation of the samples.
fn rule(recording: &Recording) -> &'static str {
    match (recording.interpolation(), recording.times()) {
        (Interpolation::Cubic, _) => "between samples: the cubic that follows from positions and velocities",
        (Interpolation::Quartic, _) => "between samples: the quartic of the file's `interpolation`",
        (Interpolation::Quintic, _) => {
            "between samples: the polynomial of fifth degree that follows from positions, velocities and accelerations, as in ROS 2's joint_trajectory_controller"
        }
        (Interpolation::Linear, Some(_)) => {
            "between samples: straight in joint space at constant velocity; accelerations and rest at the ends are not judged, because the file has no velocities"
        }
        (Interpolation::Linear, None) => {
            "between waypoints: straight in joint space; velocities and accelerations are not judged, because the file has no times"
        }
    }
}
