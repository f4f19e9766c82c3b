//! Settings of a judgement, for a recording and for the lines of `cplan batch`.

use crate::cli::failure::Failure;
use crate::engine::findings::{MotionFindings, verify};
use crate::input::{
    self, CalibrationTable, JointValues, LoadedRecording, LoadedScene, Overrides, Source, TipPoint, read_recording,
};
use crate::model::Elbow;
use crate::options::word;
use clap::Args;
use std::path::PathBuf;

/// Settings for reading and judging a recording.
#[derive(Debug, Args)]
pub struct Settings {
    /// Topic to judge in an .mcap recording, if several contain both joints of the arm.
    #[arg(long, value_name = "NAME")]
    pub topic: Option<String>,
    /// Least distance to keep from every obstacle, metres or as in 20mm, instead of the world's.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub clearance: Option<f64>,
    /// Errors within which the answer holds, instead of the world's, such as
    /// "base=0.5mm,0.05deg; links=0.2mm; zeros=0.02deg; obstacles=1mm".
    #[arg(long, value_name = "KEY=VALUE,..")]
    pub calibration: Option<CalibrationTable>,
    /// Required start configuration instead of the world's, such as 0.3,-1 or 20deg,-60deg.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with = "anywhere")]
    pub start: Option<JointValues>,
    /// Required goal configuration instead of the world's.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with_all = ["goal_tip", "anywhere"])]
    pub goal: Option<JointValues>,
    /// Required final position of the tip instead of the world's goal, metres.
    #[arg(long, value_name = "x,y", allow_hyphen_values = true, conflicts_with = "anywhere")]
    pub goal_tip: Option<TipPoint>,
    /// Required side of the elbow at --goal-tip, seen from joint 1 towards the tip. By default, both sides are allowed.
    #[arg(long, value_name = "SIDE", requires = "goal_tip", conflicts_with = "goal", value_parser = word(Elbow::ALL.map(|own| (own, own.name(), ""))))]
    pub elbow: Option<Elbow>,
    /// Ignore the world's start and goal: the motion may begin and end anywhere.
    #[arg(long)]
    pub anywhere: bool,
    /// Assume that continuous joints take the shorter direction between samples. Use this for angles that were recorded
    /// within one turn.
    #[arg(long)]
    pub unwrap: bool,
    /// Check the joints' torques against the effort limits of the URDF or the world, even if the world does not require
    /// this. Files with torques are always checked.
    #[arg(long)]
    pub torque: bool,
}

impl Settings {
    /// Returns the values that replace those of the world.
    pub fn overrides(&self) -> Overrides {
        let &Self { start, goal, goal_tip, elbow, clearance, calibration, .. } = self;
        Overrides { start, goal, goal_tip, elbow, clearance, calibration }
    }
}

/// A recording that has not been read yet.
pub enum RecordingSource {
    /// A file.
    File(PathBuf),
    /// A text in the format of JSON files.
    Text(String),
}

/// A judged recording.
pub struct JudgedRecording {
    /// The robot and the world with the settings.
    pub loaded: LoadedScene,
    /// The recording.
    pub recorded: LoadedRecording,
    /// The findings about it.
    pub findings: MotionFindings,
}

/// Reads and judges a recording.
///
/// # Errors
/// Bad input, and settings that do not fit the recording. A collision is a result, not an error.
pub fn judge(loaded: LoadedScene, source: &RecordingSource, settings: &Settings) -> Result<JudgedRecording, Failure> {
    let mut loaded = loaded.with_margins(settings.clearance, settings.calibration)?;
    let mut recorded = match (source, &settings.topic) {
        (RecordingSource::File(file), None) => input::load_recording(file, &loaded)?,
        (RecordingSource::File(file), Some(topic)) => input::load_topic(file, topic, &loaded)?,
        (RecordingSource::Text(text), _) => read_recording(&Source::in_memory("verify", text.clone()), &loaded)?,
    };
    if settings.torque || recorded.has_torques {
        loaded = loaded.keeping_efforts()?;
    }
    if settings.unwrap {
        recorded.recording = recorded.recording.unwrapped(&loaded.scene.arm().topology());
    }
    if recorded.steps.is_some() && settings.anywhere {
        return Err(Failure::Usage("--anywhere does not apply to tasks, which must begin at the start".into()));
    }
    let findings = verify(&loaded, &recorded, &settings.overrides(), settings.anywhere)?;
    Ok(JudgedRecording { loaded, recorded, findings })
}
