//! `cplan verify`: checks whether a recorded motion is free of collisions and within the limits, and whether a recorded
//! task is the task of the world.

mod cell;
mod cell_proof;
mod cell_steps;
mod settings;
mod text;

pub use settings::{JudgedRecording, RecordingSource, Settings, judge};

use super::exit::{DONE, REFUTED, UNKNOWN};
use super::failure::Failure;
use super::files::Files;
use super::headings::OUTPUT;
use super::outputs::{Outputs, drawn, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::sinks;
use super::theme::ThemeArgs;
use crate::engine::certificate_of_recording;
use crate::engine::findings::{Judgement, MotionFindings, PlanFinding};
use crate::input::{self, Digests, LoadedRecording, LoadedScene, Rules};
use crate::model::TimedScene;
use crate::output::{contours, title_of};
use crate::space::Recording;
use crate::view::{Picture, View};
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Judge a motion from any source: all of it, not only samples.
///
/// The motion is a joint path, a trajectory, or a recorded task. In a cell of two arms, both motions are judged on one
/// clock.
#[derive(Debug, Args)]
#[command(override_usage = "cplan verify [OPTIONS] <URDF> <WORLD> <TRAJECTORY>
       cplan verify [OPTIONS] <CELL.toml> <TRAJECTORY> <TRAJECTORY>
       cplan verify [OPTIONS] <CELL.toml> <CELL.json>")]
#[command(after_help = "\
The format of the file determines the motion between its samples:
  positions, velocities, accelerations   quintic (ROS 2 JointTrajectory)
  positions and velocities               cubic
  positions alone                        straight lines in joint space
  a result of cplan (.json)              the motion that the file states

The motion must lead from the world's start to its goal. All values that a
result of cplan states about the motion must be true. CSV columns are named
after the joints: elbow, elbow_velocity and so on in radians or metres, and time
in seconds.

In a world with steps, the file must be a result of cplan for that world
(.json). Each step is judged: whether it is a step of the world, its motion
(with the payload, and with objects where they are at that time), grasps,
places, turns of the wrist, and rests.

With --plan, the report states the greatest distance of the motion from the
plan, in joint space and for the tip. Times are not compared.

With a cell file (.toml) instead of a robot, two files have the motions of both
arms, in the order of the cell, or one file is the result of `cplan cell`. Each
motion is judged among the obstacles, and both between the arms. If the result
is that no motions exist, its proof is judged.

Examples:
  cplan verify robots/planar_2r.urdf workspaces/shelf.toml recorded.csv
  cplan verify robots/planar_2r.urdf workspaces/shelf.toml recorded.csv \\
    --plan planned.csv
  cplan verify robots/planar_2r_continuous.urdf workspaces/wrap_around.toml \\
    turns.csv --unwrap --clearance 0.01
  cplan verify robots/scara.urdf workspaces/tasks/kitting_cell.toml kit.json
  cplan verify workspaces/cells/crossing.toml left.csv right.csv --skew 0.05
  cplan verify workspaces/cells/crossing.toml cell.json

Exit codes: 0 free and within all limits, 1 bad input or a proof that does not
hold, 2 wrong command line, 3 refuted: a proven collision, a broken limit, a
wrong start or goal, another task than requested, or a false statement in the
file; or no motions exist, as the file proves; 4 undecided.")]
pub struct VerifyArgs {
    #[command(flatten)]
    pub files: Files,
    /// Motion: .json (a result of cplan), .csv, .yaml (ROS 2 JointTrajectory) or .mcap (ROS 2 recording).
    #[arg(value_name = "TRAJECTORY", value_hint = ValueHint::FilePath)]
    pub trajectory: Option<PathBuf>,
    /// For the motions of a cell: greatest difference of the two controllers' clocks, seconds [default: 0.02].
    #[arg(long, value_name = "SECONDS", value_parser = super::cell::skew)]
    pub skew: Option<f64>,
    #[command(flatten)]
    pub settings: Settings,
    /// Plan to compare with: .json (a result of cplan), .csv or .yaml. The report states the greatest distance of the
    /// motion from the plan, in joint space and for the tip.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub plan: Option<PathBuf>,
    /// Draw workspace and configuration space with the motion: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    /// Write the evidence that an accepted motion is free, and that a task completes all steps. `cplan-check URDF WORLD
    /// FILE` checks it in exact arithmetic.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub certificate: Option<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// Checks a recorded motion and reports the findings.
///
/// # Errors
/// Bad input and I/O, and options that do not fit the recording. A collision is no error, because it is a result of the
/// check.
pub fn run(args: &VerifyArgs) -> Result<u8, Failure> {
    if cell::is_cell(&args.files.urdf) {
        return cell::run(args);
    }
    let Some(trajectory) = &args.trajectory else {
        return Err(Failure::Usage("the motion is missing: cplan verify URDF WORLD TRAJECTORY".into()));
    };
    if args.skew.is_some() {
        return Err(Failure::Usage("--skew needs a cell: cplan verify CELL.toml TRAJECTORY TRAJECTORY".into()));
    }
    let outputs = Outputs::of_pictures(&args.picture, args.certificate.clone())?;
    let loaded = input::load_scene(args.files.robot(), &args.files.world)?;
    loaded.robot.warnings.iter().for_each(|w| args.print.print_status(&format!("warning: {w}")));
    let inputs: Vec<_> = loaded.files().into_iter().chain([trajectory.clone()]).chain(args.plan.clone()).collect();
    refuse_to_overwrite_inputs(outputs.paths(), &inputs)?;
    let source = RecordingSource::File(trajectory.clone());
    let JudgedRecording { loaded, recorded, mut findings } = judge(loaded, &source, &args.settings)?;
    if recorded.steps.is_some() && !args.picture.is_empty() {
        let message = "--picture cannot draw tasks, only single motions; `cplan plan` draws tasks";
        return Err(Failure::Usage(message.into()));
    }
    let scene = &loaded.scene;
    let recording = &recorded.recording;
    if let Some(plan) = &args.plan {
        let plan = input::load_recording(plan, &loaded)?.recording;
        findings.plan = Some(PlanFinding::new(scene.arm(), recording, &plan));
    }
    let mut files = Vec::new();
    if let Some(path) = &args.certificate {
        match certificate(args, &loaded, &recorded, findings.verdict)? {
            Ok(certificate) => files.push((path.clone(), certificate.into_bytes())),
            Err(why) => sinks::print_status(&format!("warning: {} is not written: {why}", path.display())),
        }
    }
    outputs.write_pictures(files, drawn(|| args.theme.apply(view(loaded.timed(), recording, &findings))))?;
    let code = match findings.verdict {
        Judgement::Free => DONE,
        Judgement::Undecided => UNKNOWN,
        Judgement::Collision | Judgement::Limits | Judgement::Task | Judgement::Ends | Judgement::Claims => REFUTED,
    };
    args.print.report(code, || sinks::pretty(&findings), || text::summary(scene.arm(), recording, &findings))?;
    Ok(code)
}

/// Returns the certificate of a motion, or the reason why it has none.
fn certificate(
    args: &VerifyArgs,
    loaded: &LoadedScene,
    recorded: &LoadedRecording,
    verdict: Judgement,
) -> Result<Result<String, String>, Failure> {
    if let Some(held) = recorded.held.first() {
        let joint = &held.joint.name;
        return Ok(Err(format!("joint \"{joint}\" moves, but certificates cover only the arm's two joints")));
    }
    if recorded.steps.is_none() && loaded.is_task() && !loaded.has_steps() {
        let why = "the world states values of the tool's joints, and a certificate for them needs a result in .json";
        return Ok(Err(why.into()));
    }
    if verdict != Judgement::Free {
        return Ok(Err("the motion is not accepted".into()));
    }
    let asked = args.settings.overrides();
    let about = Digests::of(&args.files.robot(), &args.files.world, &loaded.files())?;
    let (start, goals) = if args.settings.anywhere { (None, Vec::new()) } else { loaded.ends(&asked)? };
    let steps = recorded.steps.as_deref();
    let task = steps.map(|_| loaded.clone().resolve(&asked, Rules::Plan)).transpose()?;
    let steps = task.as_ref().and_then(|loaded| loaded.task.as_ref()).zip(steps);
    let (ends, recording) = ([start, goals.first().copied()], &recorded.recording);
    let certificate = certificate_of_recording(&loaded.scene, recording, steps, (&asked, &about), ends);
    Ok(certificate.map_err(|why| why.to_string()))
}

fn view(timed: TimedScene, recording: &Recording, findings: &MotionFindings) -> View {
    let (scene, path) = (timed.scene, recording.outline());
    // Show the arm at its collision.
    let shown = findings.collisions.first_contact.as_ref().map(|c| c.moment.configuration.into());
    View::of_picture(&Picture {
        title: vec![title_of(scene), format!("{} samples", findings.samples)],
        status: findings.verdict.word().into(),
        goals: &[shown.unwrap_or(path.goal()).into()],
        paths: vec![("motion".into(), &path)],
        c_obstacles: &contours(scene),
        ..Picture::new(timed, path.start())
    })
}
