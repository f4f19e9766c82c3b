//! `cplan verify`: whether a recorded motion is free of collision and within the limits.

use super::args::VerifyArgs;
use super::failure::Failure;
use super::output::{self, Sink};
use super::summary::{configuration, value};
use super::{DONE, REFUTED, UNKNOWN};
use crate::certify::{Encounter, Excess, Limit, Moment, Passage, limits_kept, passage};
use crate::draw::Picture;
use crate::input::{self, LoadedRecording, LoadedScene};
use crate::model::{Joint, Scene};
use crate::space::Recording;
use serde::Serialize;
use std::fmt::Write;

/// What there is to say about a motion.
#[derive(Debug, Serialize)]
struct Findings {
    /// `free`, `collision`, `limits` (free, but beyond a limit) or `undecided`.
    verdict: &'static str,
    joints: [String; 2],
    units: [&'static str; 2],
    samples: usize,
    /// Seconds from the first to the last sample.
    #[serde(skip_serializing_if = "Option::is_none")]
    duration: Option<f64>,
    /// The distance to keep, metres.
    required: f64,
    /// Proven lower bound on the distance to every obstacle, metres; only of a free motion that could hit something.
    #[serde(skip_serializing_if = "Option::is_none")]
    clearance: Option<f64>,
    /// Where a free motion comes nearest.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest: Option<EncounterFinding>,
    #[serde(skip_serializing_if = "Option::is_none")]
    first_contact: Option<EncounterFinding>,
    /// The motion before this is proven free, on the clock of `first_contact`.
    #[serde(skip_serializing_if = "Option::is_none")]
    free_until: Option<f64>,
    /// The least distance seen on a motion that collides.
    #[serde(skip_serializing_if = "Option::is_none")]
    deepest: Option<EncounterFinding>,
    /// Where it could not be decided.
    #[serde(skip_serializing_if = "Option::is_none")]
    undecided: Option<EncounterFinding>,
    limits_broken: Vec<LimitFinding>,
    notes: Vec<String>,
}

#[derive(Debug, Serialize)]
struct EncounterFinding {
    #[serde(flatten)]
    moment: MomentFinding,
    link: String,
    body: String,
    obstacle: String,
    /// Penetration depth, metres; negative is a distance.
    depth: f64,
}

#[derive(Debug, Serialize)]
struct MomentFinding {
    /// Seconds on the file's clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<f64>,
    /// Without a clock: number of the waypoint, counted from 0, and the share of the way to the next.
    #[serde(skip_serializing_if = "Option::is_none")]
    waypoint: Option<f64>,
    /// The sample at or before it, counted from 0.
    sample: usize,
    configuration: [f64; 2],
}

#[derive(Debug, Serialize)]
struct LimitFinding {
    joint: String,
    limit: &'static str,
    value: f64,
    allowed: f64,
    #[serde(flatten)]
    moment: MomentFinding,
}

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
    let findings = findings(scene, &recording, &passage, &broken, notes);
    for sink in &sinks {
        if let Sink::Picture(format, path) = sink {
            draw(scene, &recording, &findings, *format, path)?;
        }
    }
    if args.json {
        let json = serde_json::to_string_pretty(&findings).map_err(|e| Failure::Option(e.to_string()))?;
        output::print(&(json + "\n"))?;
    } else if !args.quiet {
        output::print(&text(&loaded, &recording, &passage, &broken, &findings))?;
    }
    Ok(match findings.verdict {
        "free" => DONE,
        "undecided" => UNKNOWN,
        _ => REFUTED,
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

fn findings(
    scene: &Scene,
    recording: &Recording,
    passage: &Passage,
    broken: &[Excess],
    notes: Vec<String>,
) -> Findings {
    let timed = recording.times().is_some();
    let encounter = |e: &Encounter| encounter(scene, e, timed);
    let joints = &scene.arm.joints;
    let verdict = match passage {
        Passage::Collision { .. } => "collision",
        _ if !broken.is_empty() => "limits",
        Passage::Free { .. } => "free",
        Passage::Undecided(_) => "undecided",
    };
    let mut findings = Findings {
        verdict,
        joints: joints.each_ref().map(|j| j.name.clone()),
        units: joints.each_ref().map(Joint::unit),
        samples: recording.positions().len(),
        duration: recording.duration(),
        required: scene.workspace.clearance,
        clearance: None,
        nearest: None,
        first_contact: None,
        free_until: None,
        deepest: None,
        undecided: None,
        limits_broken: broken.iter().map(|excess| limit(joints, excess, timed)).collect(),
        notes,
    };
    match passage {
        Passage::Free { clearance, nearest } => {
            findings.clearance = Some(*clearance).filter(|c| c.is_finite());
            findings.nearest = nearest.as_ref().map(encounter);
        }
        Passage::Collision { first, free_until, deepest } => {
            findings.first_contact = Some(encounter(first));
            findings.free_until = Some(*free_until);
            findings.deepest = Some(encounter(deepest));
        }
        Passage::Undecided(nearest) => findings.undecided = Some(encounter(nearest)),
    }
    findings
}

fn encounter(scene: &Scene, e: &Encounter, timed: bool) -> EncounterFinding {
    let pair = e.contact.pair;
    let link = &scene.arm.links[pair.link];
    EncounterFinding {
        moment: moment(&e.moment, timed),
        link: link.name.clone(),
        body: link.parts[pair.part].body.clone(),
        obstacle: scene.workspace.obstacles[pair.obstacle].name.clone(),
        depth: -e.contact.separation.distance,
    }
}

fn moment(m: &Moment, timed: bool) -> MomentFinding {
    MomentFinding {
        time: timed.then_some(m.time),
        waypoint: (!timed).then_some(m.time),
        sample: m.sample,
        configuration: [m.at[0], m.at[1]],
    }
}

fn limit(joints: &[Joint; 2], excess: &Excess, timed: bool) -> LimitFinding {
    LimitFinding {
        joint: joints[excess.joint].name.clone(),
        limit: match excess.limit {
            Limit::Position => "position",
            Limit::Velocity => "velocity",
            Limit::Acceleration => "acceleration",
            Limit::RestAtStart => "rest at start",
            Limit::RestAtEnd => "rest at end",
        },
        value: excess.value,
        allowed: excess.allowed,
        moment: moment(&excess.moment, timed),
    }
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
        status: findings.verdict.into(),
        scene,
        start: path.start(),
        goals: &goals,
        paths: vec![("motion".into(), &path)],
        trace: None,
        c_obstacles: &contours,
    };
    output::save_picture(format, file, &picture)
}

/// When, in words.
fn when(m: &Moment, recording: &Recording) -> String {
    match recording.times() {
        Some(_) => format!("at {:.6} s (sample {})", m.time, m.sample),
        None => format!("at waypoint {:.4}", m.time),
    }
}

fn text(
    loaded: &LoadedScene,
    recording: &Recording,
    passage: &Passage,
    broken: &[Excess],
    findings: &Findings,
) -> String {
    let scene = &loaded.scene;
    let arm = &scene.arm;
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key:<10} {value}");
    };
    line("arm", format!("{} ({})", arm.name, arm.kind()));
    let duration = findings.duration.map_or("no times".into(), |d| format!("{d:.3} s"));
    line("motion", format!("{} samples, {duration}", findings.samples));
    findings.notes.iter().for_each(|note| line("", note.clone()));
    line("from", configuration(arm, recording.positions()[0]));
    line("to", configuration(arm, recording.positions()[findings.samples - 1]));
    let place = |e: &Encounter| {
        let pair = scene.describe(e.contact.pair);
        format!("{pair} {}, {}", when(&e.moment, recording), configuration(arm, e.moment.at))
    };
    let depth = |e: &Encounter| match -e.contact.separation.distance {
        d if d >= 0.0 => format!("{d:.6} m deep"),
        d => format!("{:.6} m apart", -d),
    };
    match passage {
        Passage::Free { clearance, nearest: Some(nearest) } => {
            line("clearance", format!("{clearance:.6} m proven; least seen {} m: {}", apart(nearest), place(nearest)));
        }
        Passage::Free { nearest: None, .. } => line("clearance", "nothing can be hit".into()),
        Passage::Collision { first, free_until, deepest } => {
            line("contact", format!("{}, {}", place(first), depth(first)));
            let free = match recording.times() {
                Some(_) => format!("proven free before {free_until:.6} s"),
                None => format!("proven free before waypoint {free_until:.4}"),
            };
            line("", free);
            line("deepest", format!("{}, {}", place(deepest), depth(deepest)));
        }
        Passage::Undecided(nearest) => {
            line("undecided", format!("{}: {} m, too near to be told apart", place(nearest), apart(nearest)));
        }
    }
    for (excess, finding) in broken.iter().zip(&findings.limits_broken) {
        let joint = &arm.joints[excess.joint];
        let unit = joint.unit();
        let what = match excess.limit {
            Limit::Position => {
                format!("position {} beyond {}", value(joint, excess.value), value(joint, excess.allowed))
            }
            Limit::Velocity => format!("velocity {:.6} {unit}/s, at most {:.6}", excess.value, excess.allowed),
            Limit::Acceleration => format!("acceleration {:.6} {unit}/s2, at most {:.6}", excess.value, excess.allowed),
            Limit::RestAtStart => format!("starts at {:.6} {unit}/s, not at rest", excess.value),
            Limit::RestAtEnd => format!("ends at {:.6} {unit}/s, not at rest", excess.value),
        };
        line("limit", format!("{}: {what}, {}", finding.joint, when(&excess.moment, recording)));
    }
    let required = findings.required;
    let kept = if required > 0.0 { format!(" by {required} m") } else { String::new() };
    let result = match findings.verdict {
        "free" => format!("free{kept}: the whole motion, proven"),
        "collision" if required > 0.0 => "collision, or nearer than the clearance to keep: proven".into(),
        "collision" => "collision: proven".into(),
        "limits" => "limits are broken".into(),
        _ => "undecided".into(),
    };
    line("result", result);
    text
}

/// The distance of a pair that is apart.
fn apart(e: &Encounter) -> String {
    format!("{:.6}", e.contact.separation.distance)
}
