//! `cplan verify`: checks if a recorded motion is free of collision and within the limits, or if a recorded task is
//! also the one that the world describes.

mod text;

use super::exit::{DONE, REFUTED, UNKNOWN};
use super::failure::Failure;
use super::files::Files;
use super::print_args::PrintArgs;
use super::sinks::{self, Sink};
use crate::draw::{Picture, View};
use crate::engine::certificate_of_recording;
use crate::engine::findings::{Judgement, MotionFindings, verify};
use crate::input::{self, Digests, JointValues, Overrides, TipPoint};
use crate::model::TimedScene;
use crate::motion::write_whole;
use crate::output::{PictureFormat, contours, title_of};
use crate::space::Recording;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Check a joint path or trajectory, whoever made it: the whole motion, not samples of it.
#[derive(Debug, Args)]
#[command(after_help = "\
Between samples the motion is what the reader of the format makes of it: of a ROS 2 JointTrajectory a quintic where
accelerations are stated, of positions and velocities a cubic, of positions alone straight lines in joint space; cplan's JSON
says it itself. It has to lead from the world's start to its goal, and what a result of cplan's says of it has to be true. CSV
columns are named after the joints (elbow, elbow_velocity, ...; time in seconds), the values are radians or metres. In a world with steps a result of cplan's for it (.json) is judged step by step: that the steps are the world's,
each motion with what is carried and objects where they lie then, grasps, places, turns of the wrist and rests.

Examples:
  cplan verify robots/planar_2r.urdf workspaces/shelf.toml recorded.csv
  cplan verify robots/planar_2r_continuous.urdf workspaces/wrap_around.toml turns.csv --unwrap --clearance 0.01
  cplan verify robots/scara.urdf workspaces/tasks/kitting_cell.toml kit.json

Exit codes: 0 free and within all limits, 1 bad input, 2 wrong command line, 3 proven collision, limit broken, not from
start to goal, not the task asked for, or something false in the file, 4 undecided.")]
pub struct VerifyArgs {
    #[command(flatten)]
    pub files: Files,
    /// The motion: .json (a result of cplan), .csv, .yaml (ROS 2 JointTrajectory) or .mcap (ROS 2 recording).
    #[arg(value_name = "TRAJECTORY", value_hint = ValueHint::FilePath)]
    pub trajectory: PathBuf,
    /// Topic of an .mcap recording that is judged, if several have both of the arm's joints.
    #[arg(long, value_name = "NAME")]
    pub topic: Option<String>,
    /// Least distance to keep from every obstacle, metres, instead of the world's.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub clearance: Option<f64>,
    /// Where it is to begin instead of the world's start, such as 0.3,-1 or 20deg,-60deg.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with = "anywhere")]
    pub start: Option<JointValues>,
    /// Where it is to end instead of the world's goal.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with_all = ["goal_tip", "anywhere"])]
    pub goal: Option<JointValues>,
    /// Where the tip is to end instead of the world's goal, metres.
    #[arg(long, value_name = "x,y", allow_hyphen_values = true, conflicts_with = "anywhere")]
    pub goal_tip: Option<TipPoint>,
    /// Let a motion begin and end anywhere, whatever the world's start and goal.
    #[arg(long)]
    pub anywhere: bool,
    /// Let joints without limits go the short way from sample to sample: for angles recorded within one turn.
    #[arg(long)]
    pub unwrap: bool,
    /// Hold the joints' torques to the efforts that the URDF or the world gives, though the world does not say so; what has torques in it is
    /// held to them anyway.
    #[arg(long)]
    pub torque: bool,
    /// Draw workspace and configuration space with the motion: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    /// Write the evidence that an accepted motion is free, and of a task that it does all steps, which `cplan-check URDF WORLD FILE` checks in exact
    /// arithmetic.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub certificate: Option<PathBuf>,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// Checks and reports.
///
/// # Errors
/// Bad input and I/O, and options that do not fit the recording. A collision is no error, because finding it is the
/// job.
pub fn run(args: &VerifyArgs) -> Result<u8, Failure> {
    let sinks = sinks::sinks_with(&[], &args.picture, args.certificate.as_deref())?;
    let mut loaded = input::load_scene(args.files.robot(), &args.files.world)?.keeping(args.clearance)?;
    let about = Digests::of(&args.files.robot(), &args.files.world, &loaded.files())?;
    loaded.robot.warnings.iter().for_each(|w| args.print.say(&format!("warning: {w}")));
    let mut recorded = match &args.topic {
        None => input::load_recording(&args.trajectory, &loaded)?,
        Some(topic) => input::load_topic(&args.trajectory, topic, &loaded)?,
    };
    if args.torque || recorded.has_torques {
        loaded = loaded.keeping_efforts()?;
    }
    let inputs: Vec<_> = loaded.files().into_iter().chain([args.trajectory.clone()]).collect();
    sinks::spare_inputs(sinks.iter().map(Sink::path), &inputs)?;
    let scene = &loaded.scene;
    if args.unwrap {
        recorded.recording = recorded.recording.unwrapped(&scene.arm().topology());
    }
    if recorded.steps.is_some() && !args.picture.is_empty() {
        let message = "--picture shows one motion, not a task; the main job draws tasks";
        return Err(Failure::Usage(message.into()));
    }
    if recorded.steps.is_some() && args.anywhere {
        return Err(Failure::Usage("--anywhere is for motions; a task begins at its start".into()));
    }
    let findings = verify(&loaded, &recorded, &overrides(args), args.anywhere)?;
    let recording = &recorded.recording;
    for sink in &sinks {
        match sink {
            Sink::Picture(format, path) => draw(loaded.timed(), recording, &findings, *format, path)?,
            Sink::Certificate(path) if !recorded.held.is_empty() => {
                let joint = &recorded.held[0].joint.name;
                let why = format!("joint \"{joint}\" moves, and certificates are about the arm's two joints");
                sinks::say(&format!("warning: {} is not written: {why}", path.display()));
            }
            Sink::Certificate(path) if matches!(findings.verdict, Judgement::Free) => {
                let (start, goals) = if args.anywhere { (None, Vec::new()) } else { loaded.ends(&overrides(args))? };
                let (steps, asked) = (recorded.steps.as_deref(), (&overrides(args), &about));
                let task = steps.map(|_| loaded.clone().task(&overrides(args))).transpose()?;
                let steps = task.as_ref().map(|loaded| &loaded.task).zip(steps);
                match certificate_of_recording(scene, recording, steps, asked, [start, goals.first().copied()]) {
                    Ok(certificate) => write_whole(path, certificate.as_bytes())?,
                    Err(why) => sinks::say(&format!("warning: {} is not written: {why}", path.display())),
                }
            }
            Sink::Certificate(path) => {
                sinks::say(&format!("warning: {} is not written: the motion is not accepted", path.display()));
            }
            Sink::Result(..) | Sink::CSpace(..) => {}
        }
    }
    let code = match findings.verdict {
        Judgement::Free => DONE,
        Judgement::Undecided => UNKNOWN,
        Judgement::Collision | Judgement::Limits | Judgement::Task | Judgement::Ends | Judgement::Claims => REFUTED,
    };
    args.print.tell(code, || sinks::pretty(&findings), || text::summary(scene.arm(), recording, &findings))?;
    Ok(code)
}

fn overrides(args: &VerifyArgs) -> Overrides {
    Overrides { start: args.start, goal: args.goal, goal_tip: args.goal_tip, clearance: args.clearance }
}

fn draw(
    timed: TimedScene,
    recording: &Recording,
    findings: &MotionFindings,
    format: PictureFormat,
    file: &std::path::Path,
) -> Result<(), Failure> {
    let (scene, path) = (timed.scene, recording.outline());
    // The picture shows the arm at its collision.
    let shown = findings.way.first_contact.as_ref().map(|c| c.moment.configuration.into());
    let view = View::of_picture(&Picture {
        title: vec![title_of(scene), format!("{} samples", findings.samples)],
        status: findings.verdict.word().into(),
        goals: &[shown.unwrap_or(path.goal()).into()],
        paths: vec![("motion".into(), &path)],
        c_obstacles: &contours(scene),
        ..Picture::new(timed, path.start())
    });
    sinks::save_picture(format, file, &view)
}
