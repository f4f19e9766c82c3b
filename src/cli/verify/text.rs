//! What `verify` found, for people.

use super::findings::{Findings, Verdict};
use crate::certify::{Encounter, Excess, Limit, Moment, Passage};
use crate::cli::summary::{configuration, value};
use crate::input::LoadedScene;
use crate::space::Recording;
use std::fmt::Write;

/// When, in words.
fn when(m: &Moment, recording: &Recording) -> String {
    match recording.times() {
        Some(_) => format!("at {:.6} s (sample {})", m.time, m.sample),
        None => format!("at waypoint {:.4}", m.time),
    }
}

/// The findings for people.
pub(super) fn summary(
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
            Limit::Jerk => format!("jerk {:.6} {unit}/s3, at most {:.6}", excess.value, excess.allowed),
            Limit::AccelerationJump => format!("acceleration jumps by {:.6} {unit}/s2", excess.value),
            Limit::RestAtStart => format!("starts at {:.6} {unit}/s, not at rest", excess.value),
            Limit::RestAtEnd => format!("ends at {:.6} {unit}/s, not at rest", excess.value),
        };
        line("limit", format!("{}: {what}, {}", finding.joint, when(&excess.moment, recording)));
    }
    let required = findings.required;
    let kept = if required > 0.0 { format!(" by {required} m") } else { String::new() };
    let result = match findings.verdict {
        Verdict::Free => format!("free{kept}: the whole motion, proven"),
        Verdict::Collision if required > 0.0 => "collision, or nearer than the clearance to keep: proven".into(),
        Verdict::Collision => "collision: proven".into(),
        Verdict::Limits => "limits are broken".into(),
        Verdict::Undecided => "undecided".into(),
    };
    line("result", result);
    text
}

/// The distance of a pair that is apart.
fn apart(e: &Encounter) -> String {
    format!("{:.6}", e.contact.separation.distance)
}
