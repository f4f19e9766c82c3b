//! `cplan verify`: checks if a recorded motion is free of collision and within the limits, or if a recorded task is
//! also the one that the world describes.

mod text;

use super::exit::{DONE, REFUTED, UNKNOWN};
use super::failure::Failure;
use super::files::Files;
use super::headings::OUTPUT;
use super::outputs::{Outputs, drawn, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::sinks;
use super::theme::ThemeArgs;
use crate::engine::certificate_of_recording;
use crate::engine::findings::{Judgement, MotionFindings, PlanFinding, verify};
use crate::input::{
    self, CalibrationTable, Digests, JointValues, LoadedRecording, LoadedScene, Overrides, Rules, TipPoint,
};
use crate::model::{Elbow, TimedScene};
use crate::options::word;
use crate::output::{contours, title_of};
use crate::space::Recording;
use crate::view::{Picture, View};
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Judge a motion from any source: the whole motion, not only samples.
///
/// The motion is a joint path, a trajectory, or a recorded task.
#[derive(Debug, Args)]
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

In a world with steps, the file must be a result of cplan for that world (.json).
Each step is judged: whether it is a step of the world, its motion (with the
payload, and with objects where they are at that time), grasps, places, turns of
the wrist, and rests.

With --plan, the report states the greatest distance of the motion from the
plan, in joint space and for the tip. Times are not compared.

Examples:
  cplan verify robots/planar_2r.urdf workspaces/shelf.toml recorded.csv
  cplan verify robots/planar_2r.urdf workspaces/shelf.toml recorded.csv \\
    --plan planned.csv
  cplan verify robots/planar_2r_continuous.urdf workspaces/wrap_around.toml \\
    turns.csv --unwrap --clearance 0.01
  cplan verify robots/scara.urdf workspaces/tasks/kitting_cell.toml kit.json

Exit codes: 0 free and within all limits, 1 bad input, 2 wrong command line, 3
refuted: a proven collision, a broken limit, a wrong start or goal, another task
than requested, or a false statement in the file, 4 undecided.")]
pub struct VerifyArgs {
    #[command(flatten)]
    pub files: Files,
    /// Motion: .json (a result of cplan), .csv, .yaml (ROS 2 JointTrajectory) or .mcap (ROS 2 recording).
    #[arg(value_name = "TRAJECTORY", value_hint = ValueHint::FilePath)]
    pub trajectory: PathBuf,
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
    let outputs = Outputs::of_pictures(&args.picture, args.certificate.clone())?;
    let mut loaded =
        input::load_scene(args.files.robot(), &args.files.world)?.with_margins(args.clearance, args.calibration)?;
    loaded.robot.warnings.iter().for_each(|w| args.print.print_status(&format!("warning: {w}")));
    let mut recorded = match &args.topic {
        None => input::load_recording(&args.trajectory, &loaded)?,
        Some(topic) => input::load_topic(&args.trajectory, topic, &loaded)?,
    };
    if args.torque || recorded.has_torques {
        loaded = loaded.keeping_efforts()?;
    }
    let inputs: Vec<_> = loaded.files().into_iter().chain([args.trajectory.clone()]).chain(args.plan.clone()).collect();
    refuse_to_overwrite_inputs(outputs.paths(), &inputs)?;
    let scene = &loaded.scene;
    if args.unwrap {
        recorded.recording = recorded.recording.unwrapped(&scene.arm().topology());
    }
    if recorded.steps.is_some() && !args.picture.is_empty() {
        let message = "--picture cannot draw tasks, only single motions; `cplan plan` draws tasks";
        return Err(Failure::Usage(message.into()));
    }
    if recorded.steps.is_some() && args.anywhere {
        return Err(Failure::Usage("--anywhere does not apply to tasks, which must begin at the start".into()));
    }
    let mut findings = verify(&loaded, &recorded, &overrides(args), args.anywhere)?;
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
    let asked = overrides(args);
    let about = Digests::of(&args.files.robot(), &args.files.world, &loaded.files())?;
    let (start, goals) = if args.anywhere { (None, Vec::new()) } else { loaded.ends(&asked)? };
    let steps = recorded.steps.as_deref();
    let task = steps.map(|_| loaded.clone().resolve(&asked, Rules::Plan)).transpose()?;
    let steps = task.as_ref().and_then(|loaded| loaded.task.as_ref()).zip(steps);
    let (ends, recording) = ([start, goals.first().copied()], &recorded.recording);
    let certificate = certificate_of_recording(&loaded.scene, recording, steps, (&asked, &about), ends);
    Ok(certificate.map_err(|why| why.to_string()))
}

fn overrides(args: &VerifyArgs) -> Overrides {
    let &VerifyArgs { start, goal, goal_tip, elbow, clearance, calibration, .. } = args;
    Overrides { start, goal, goal_tip, elbow, clearance, calibration }
}

/// Returns the view of a recorded motion.
fn view(timed: TimedScene, recording: &Recording, findings: &MotionFindings) -> View {
    let (scene, path) = (timed.scene, recording.outline());
    // The picture shows the arm at its collision.
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
