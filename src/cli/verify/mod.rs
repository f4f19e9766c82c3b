//! `cplan verify`: whether a recorded motion is free of collision and within the limits.

mod findings;
mod text;

use super::args::VerifyArgs;
use super::failure::Failure;
use super::output::{self, Sink};
use super::summary::value;
use super::{DONE, REFUTED, UNKNOWN};
use crate::certify::{limits_kept, passage};
use crate::draw::Picture;
use crate::input::{self, LoadedRecording};
use crate::model::Scene;
use crate::space::Recording;
use findings::{Findings, Verdict};

/// Checks and reports.
///
/// # Errors
/// Bad input and I/O. A motion that collides is no error: finding that out is the job.
pub fn run(args: &VerifyArgs) -> Result<u8, Failure> {
    let sinks = output::sinks(&[], &args.picture)?;
    let mut loaded = input::load_scene(&args.files.urdf, &args.files.world)?;
    if let Some(clearance) = args.clearance {
        loaded.scene.workspace.clearance = input::clearance(clearance).map_err(input::InputError::from)?;
    }
    if !args.quiet {
        loaded.robot.warnings.iter().for_each(|w| eprintln!("warning: {w}"));
    }
    let LoadedRecording { mut recording, mut notes } = input::load_recording(&args.trajectory, &loaded)?;
    let scene = &loaded.scene;
    if args.unwrap {
        recording = recording.unwrapped(&scene.arm.topology());
    }
    notes.extend(turns(scene, &recording));
    let passage = passage(scene, &recording, scene.workspace.clearance);
    let broken = limits_kept(&scene.arm.joints, &recording);
    let findings = Findings::new(scene, &recording, &passage, &broken, notes);
    for sink in &sinks {
        if let Sink::Picture(format, path) = sink {
            draw(scene, &recording, &findings, *format, path)?;
        }
    }
    if args.json {
        let json = serde_json::to_string_pretty(&findings).map_err(|e| Failure::Option(e.to_string()))?;
        output::print(&(json + "\n"))?;
    } else if !args.quiet {
        output::print(&text::summary(&loaded, &recording, &passage, &broken, &findings))?;
    }
    Ok(match findings.verdict {
        Verdict::Free => DONE,
        Verdict::Undecided => UNKNOWN,
        Verdict::Collision | Verdict::Limits => REFUTED,
    })
}

/// Steps that look like a seam in wrapped angles.
fn turns(scene: &Scene, recording: &Recording) -> Option<String> {
    let turns = recording.turns(&scene.arm.topology());
    let &(sample, k) = turns.first()?;
    let joint = &scene.arm.joints[k];
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
    format: output::PictureFormat,
    file: &std::path::Path,
) -> Result<(), Failure> {
    let contours = output::contours(scene);
    let path = recording.outline();
    // The arm is shown where it hits.
    let shown = findings.first_contact.as_ref().map(|c| c.moment.configuration.into());
    let goals = [shown.unwrap_or(path.goal())];
    let picture = Picture {
        title: vec![output::title_of(scene), format!("{} samples", findings.samples)],
        status: findings.verdict.word().into(),
        scene,
        start: path.start(),
        goals: &goals,
        paths: vec![("motion".into(), &path)],
        trace: None,
        c_obstacles: &contours,
        proof: &[],
    };
    output::save_picture(format, file, &picture)
}
