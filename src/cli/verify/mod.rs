//! `cplan verify`: whether a recorded motion is free of collision and within the limits, or a recorded task is that and the one
//! that the world asks for.

mod text;

use super::args::VerifyArgs;
use super::failure::Failure;
use super::sinks::{self, Sink};
use super::{DONE, REFUTED, UNKNOWN};
use crate::draw::{Picture, View};
use crate::engine::certificate_of_recording;
use crate::engine::findings::{Judgement, MotionFindings, verify};
use crate::input::{self, Digests, Overrides};
use crate::model::Scene;
use crate::motion::write_whole;
use crate::output::{PictureFormat, contours, title_of};
use crate::space::Recording;

/// Checks and reports.
///
/// # Errors
/// Bad input and I/O, and options that do not go with what is judged. A motion that collides is no error: finding that out
/// is the job.
pub fn run(args: &VerifyArgs) -> Result<u8, Failure> {
    let sinks = sinks::sinks_with(&[], &args.picture, args.certificate.as_deref())?;
    let mut loaded = input::load_scene(args.files.robot(), &args.files.world)?.keeping(args.clearance)?;
    let about = Digests::of(&args.files.robot(), &args.files.world)?;
    loaded.robot.warnings.iter().for_each(|w| args.print.say(&format!("warning: {w}")));
    let mut recorded = match &args.topic {
        None => input::load_recording(&args.trajectory, &loaded)?,
        Some(topic) => input::load_topic(&args.trajectory, topic, &loaded)?,
    };
    if args.torque || recorded.has_torques {
        loaded = loaded.keeping_efforts()?;
    }
    sinks::spare_inputs(sinks.iter().map(Sink::path))?;
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
            Sink::Picture(format, path) => draw(scene, recording, &findings, *format, path)?,
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
    scene: &Scene,
    recording: &Recording,
    findings: &MotionFindings,
    format: PictureFormat,
    file: &std::path::Path,
) -> Result<(), Failure> {
    let path = recording.outline();
    // The arm is shown where it hits.
    let shown = findings.way.first_contact.as_ref().map(|c| c.moment.configuration.into());
    let view = View::of_picture(&Picture {
        title: vec![title_of(scene), format!("{} samples", findings.samples)],
        status: findings.verdict.word().into(),
        goals: &[shown.unwrap_or(path.goal()).into()],
        paths: vec![("motion".into(), &path)],
        c_obstacles: &contours(scene),
        ..Picture::new(scene, path.start())
    });
    sinks::save_picture(format, file, &view)
}
