//! `cplan verify`: whether a recorded motion is free of collision and within the limits, or a recorded task is that and the one
//! that the world asks for.

mod findings;
mod task;
mod text;

use super::args::VerifyArgs;
use super::failure::Failure;
use super::sinks::{self, Sink};
use super::{DONE, REFUTED, UNKNOWN};
use crate::check::{ENDS_WITHIN, check_collision, claims_kept, ends_kept, limits_kept, replay};
use crate::draw::{Picture, View};
use crate::input::{self, LoadedRecording, LoadedScene, LoadedTask, Overrides};
use crate::model::{Claims, RecordedStep, Scene};
use crate::output::{PictureFormat, contours, title_of, value};
use crate::space::Recording;
use findings::{Findings, Verdict};

/// Checks and reports.
///
/// # Errors
/// Bad input and I/O, and options that do not go with what is judged. A motion that collides is no error: finding that out
/// is the job.
pub fn run(args: &VerifyArgs) -> Result<u8, Failure> {
    let sinks = sinks::sinks(&[], &args.picture)?;
    let loaded = input::load_scene(&args.files.urdf, &args.files.world)?.keeping(args.clearance)?;
    loaded.robot.warnings.iter().for_each(|w| args.print.say(&format!("warning: {w}")));
    let LoadedRecording { mut recording, steps, claims, notes: read } =
        input::load_recording(&args.trajectory, &loaded)?;
    let mut notes = [loaded.world.notes.clone(), read].concat();
    sinks::spare_inputs(sinks.iter().map(Sink::path))?;
    if args.unwrap {
        recording = recording.unwrapped(&loaded.scene.arm().topology());
    }
    notes.extend(turns(&loaded.scene, &recording));
    let scene = loaded.scene.clone();
    let findings = match steps {
        Some(steps) => judge_task(args, loaded, &recording, &steps, &claims.unwrap_or_default(), notes)?,
        None => judge_motion(args, &loaded, &recording, &claims.unwrap_or_default(), notes)?,
    };
    for sink in &sinks {
        if let Sink::Picture(format, path) = sink {
            draw(&scene, &recording, &findings, *format, path)?;
        }
    }
    args.print.tell(|| sinks::pretty(&findings), || text::summary(scene.arm(), &recording, &findings))?;
    Ok(match findings.verdict {
        Verdict::Free => DONE,
        Verdict::Undecided => UNKNOWN,
        Verdict::Collision | Verdict::Limits | Verdict::Task | Verdict::Ends | Verdict::Claims => REFUTED,
    })
}

/// Judges the recording as one motion.
fn judge_motion(
    args: &VerifyArgs,
    loaded: &LoadedScene,
    recording: &Recording,
    claims: &Claims,
    mut notes: Vec<String>,
) -> Result<Findings, Failure> {
    if loaded.has_steps() {
        notes.push(
            "the world has steps, the file none: judged as one motion, empty-handed, with all objects where they lie at \
             first; for the steps verify a task's result in .json"
                .into(),
        );
    }
    let scene = &loaded.scene;
    let (start, goal) = if args.anywhere { (None, None) } else { loaded.ends(&overrides(args))? };
    notes.push(match (start.is_some(), goal.is_some()) {
        (true, true) => format!("from the start to the goal: both are met within {ENDS_WITHIN}, or that is a fault"),
        (true, false) => {
            format!("from the start, which is met within {ENDS_WITHIN}, or that is a fault; there is no goal")
        }
        (false, true) => {
            format!("to the goal, which is met within {ENDS_WITHIN}, or that is a fault; there is no start")
        }
        (false, false) => "where it begins and ends is not judged".into(),
    });
    let collision_check = check_collision(scene, recording, scene.workspace().clearance);
    let broken = limits_kept(&scene.arm().joints, recording);
    let findings = Findings::new(scene, recording, &collision_check, &broken, notes);
    let misses = ends_kept(scene.arm(), recording, start, goal);
    let false_claims = claims_kept(scene, recording, claims, &collision_check);
    Ok(findings.but(Verdict::Ends, misses).but(Verdict::Claims, false_claims).leaving(claims))
}

/// Judges the recording as the task of the world.
fn judge_task(
    args: &VerifyArgs,
    loaded: LoadedScene,
    recording: &Recording,
    steps: &[RecordedStep],
    claims: &Claims,
    mut notes: Vec<String>,
) -> Result<Findings, Failure> {
    if !args.picture.is_empty() {
        let message = "--picture shows one motion, not a task; the main job draws tasks";
        return Err(Failure::Usage(message.into()));
    }
    if args.anywhere {
        return Err(Failure::Usage("--anywhere is for motions; a task begins at its start".into()));
    }
    let LoadedTask { task, scene, .. } = loaded.recorded_task(&overrides(args))?;
    notes.push(
        "step by step: that the steps are the world's in an order that it allows, each motion with what is carried and \
         objects where they lie then, limits, grasps, places, turns and rests; and what the file says of steps and events"
            .into(),
    );
    Ok(task::judged(&task, &scene, recording, steps, replay(&task, recording, steps), claims, notes).leaving(claims))
}

fn overrides(args: &VerifyArgs) -> Overrides {
    Overrides { start: args.start, goal: args.goal, goal_tip: args.goal_tip, clearance: args.clearance }
}

/// Steps that look like a seam in wrapped angles.
fn turns(scene: &Scene, recording: &Recording) -> Option<String> {
    let turns = recording.turns(&scene.arm().topology());
    let &(sample, k) = turns.first()?;
    let joint = &scene.arm().joints[k];
    let step = recording.positions()[sample + 1][k] - recording.positions()[sample][k];
    let others = match turns.len() {
        1 => String::new(),
        n => format!(" ({} such steps more)", n - 1),
    };
    Some(format!(
        "from sample {sample} to {} joint \"{}\" turns by {} and is checked so{others}; if the file's angles are kept \
         within one turn, say --unwrap",
        sample + 1,
        joint.name,
        value(joint, step)
    ))
}

fn draw(
    scene: &Scene,
    recording: &Recording,
    findings: &Findings,
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
