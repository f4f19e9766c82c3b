//! The summary for people.

use super::output::Sink;
use super::planned::Planned;
use crate::check::CertifiedCurve;
use crate::engine::{Bound, Stages, Verdict, percent};
use crate::input::Loaded;
use crate::model::{Arm, Joint, Scene, plain_line};
use crate::space::{Axis, Configuration, Metric, Segment};
use std::fmt::Write;
use std::time::{Duration, Instant};

/// Time per stage.
pub struct Clock {
    last: Instant,
    stages: Vec<(String, Duration)>,
}

impl Clock {
    pub fn start() -> Self {
        Self { last: Instant::now(), stages: Vec::new() }
    }

    /// The time since the last stage ended was this one's.
    pub fn stage(&mut self, name: &str) {
        self.stages.push((name.into(), self.last.elapsed()));
        self.last = Instant::now();
    }

    /// The solver's own stages.
    pub fn stages(&mut self, stages: &Stages) {
        let Stages { build, query, certify, prove, bound } = *stages;
        for (name, time) in
            [("build", build), ("query", query), ("certify", certify), ("prove", prove), ("bound", bound)]
        {
            if !time.is_zero() {
                self.stages.push((name.into(), time));
            }
        }
        self.last = Instant::now();
    }

    pub fn milliseconds(&self) -> Vec<(String, f64)> {
        self.stages.iter().map(|(name, time)| (name.clone(), time.as_secs_f64() * 1e3)).collect()
    }
}

/// A joint's value with its unit, angles in both units: `0.3491 rad (20.00 deg)`.
pub fn value(joint: &Joint, value: f64) -> String {
    if joint.motion.is_revolute() {
        format!("{value:.4} rad ({:.2} deg)", value.to_degrees())
    } else {
        format!("{value:.4} m")
    }
}

/// Both joints' values by name.
pub fn configuration(arm: &Arm, q: Configuration) -> String {
    let [a, b] = &arm.joints;
    format!("{} {}, {} {}", a.name, value(a, q[0]), b.name, value(b, q[1]))
}

/// Both joints' values along a segment by name: of a joint that moves all along it, from where to where.
pub fn segment(arm: &Arm, segment: &Segment) -> String {
    let [from, to] = segment.ends();
    let shown = |k: usize| {
        let joint = &arm.joints[k];
        match from[k] == to[k] {
            true => format!("{} {}", joint.name, value(joint, from[k])),
            false => format!("{} any from {} to {}", joint.name, value(joint, from[k]), value(joint, to[k])),
        }
    };
    format!("{}, {}", shown(0), shown(1))
}

/// A joint's range.
pub fn range(joint: &Joint) -> String {
    match joint.axis {
        Axis::Circle => "continuous".into(),
        Axis::Interval { lower, upper } => format!("{} to {}", value(joint, lower), value(joint, upper)),
    }
}

/// What was found, in some ten lines.
pub fn text(loaded: &Loaded, planned: &Planned, sinks: &[Sink], clock: &Clock) -> String {
    let scene = planned.problem.scene();
    let arm = scene.arm();
    let mut lines = arm_lines(arm);
    lines.extend(loaded.robot.notes.iter().chain(&loaded.notes).map(|note| ("", note.clone())));
    let obstacles = counted(scene.workspace().obstacles.len(), "obstacle");
    lines.push(("world", format!("{}, {obstacles}", non_empty(&scene.workspace().name))));
    lines.push(("start", configuration(arm, planned.problem.start())));
    lines.extend(planned.problem.goals().pieces().iter().map(|goals| ("goal", segment(arm, goals))));
    lines.extend(outcome(planned));
    for sink in sinks.iter().filter(|sink| sink.is_filled_by(planned.report)) {
        lines.push(("file", sink.path().display().to_string()));
    }
    lines.push(time_line(clock));
    laid_out(&lines)
}

/// What a page says of it: arm and outcome.
pub fn facts(planned: &Planned) -> Vec<[String; 2]> {
    named(arm_lines(planned.problem.scene().arm()).into_iter().chain(outcome(planned)))
}

/// Lines for a page.
pub fn named(lines: impl IntoIterator<Item = Line>) -> Vec<[String; 2]> {
    lines.into_iter().map(|(key, text)| [key.to_owned(), text]).collect()
}

/// What the planner did and found.
fn outcome(planned: &Planned) -> Vec<Line> {
    let Planned { problem, answer, curve, report, field } = planned;
    let mut lines = Vec::new();
    let search = report.search.as_ref().map(|used| format!(" ({}, {} neighbours)", used.search, used.neighbors));
    lines.push(("planner", format!("{}{}: {}", answer.method, search.unwrap_or_default(), answer.run.size)));
    lines.extend(answer.run.note.map(|note| ("planner", note.to_string())));
    lines.extend(field.map(|field| ("field", field.to_string())));
    match &answer.verdict {
        Verdict::Found(certified) => {
            let path = certified.path();
            let segments = path.segments().count();
            let kind = if answer.method.has_own_path() { format!(", {} path", answer.path) } else { String::new() };
            let found = format!("found and certified: {segments} straight pieces, length {:.4}{kind}", path.length());
            lines.push(("result", found));
            if problem.goals().pieces().iter().any(|goals| !goals.is_point()) {
                lines.push(("reached", configuration(problem.scene().arm(), path.goal())));
            }
            if let Some(bound) = &answer.bound {
                lines.push(("optimum", optimum(bound)));
            }
        }
        Verdict::Infeasible(_) => {
            lines.push(("result", format!("there is no path; {}", report.reason.as_deref().unwrap_or_default())));
        }
        Verdict::Unknown(reason) => lines.push(("result", format!("unknown: {reason}"))),
    }
    if let (Some(curve), Some(trajectory)) = (curve, &report.trajectory) {
        lines.push(("clearance", clearance(problem.scene(), curve)));
        let (samples, corners) = (trajectory.time.len(), corners(curve));
        lines.push(("motion", format!("{:.3} s, {samples} samples{corners}", trajectory.duration())));
    }
    lines
}

/// A line of the summary: its key, empty if it goes on with what the line before is about, and its text.
pub type Line = (&'static str, String);

/// The arm and its joints.
pub fn arm_lines(arm: &Arm) -> Vec<Line> {
    let mut lines = vec![("arm", format!("{} ({}), tip \"{}\"", arm.name, arm.kind(), arm.tip_name))];
    for joint in &arm.joints {
        let unit = joint.unit();
        let jerk = joint.jerk.map(|jerk| format!(", {jerk} {unit}/s3")).unwrap_or_default();
        let speeds = format!("at most {} {unit}/s, {} {unit}/s2{jerk}", joint.velocity, joint.acceleration);
        lines.push(("joint", format!("{}: {}; {speeds}", joint.name, range(joint))));
    }
    lines
}

/// The time that each stage took.
pub fn time_line(clock: &Clock) -> Line {
    let stages: Vec<String> = clock.milliseconds().iter().map(|(name, ms)| format!("{name} {ms:.1}")).collect();
    ("time", format!("{} ms", stages.join(", ")))
}

/// Lines in two columns; a key that is the same as in the line before is not repeated.
pub fn laid_out(lines: &[Line]) -> String {
    let mut text = String::new();
    let mut before = "";
    for (key, line) in lines {
        let shown = if *key == before { "" } else { key };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{shown:<10} {}", plain_line(line));
        before = key;
    }
    text
}

/// A number of things: `1 obstacle`, `3 obstacles`.
pub fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// What the motion keeps, and where it comes nearest.
fn clearance(scene: &Scene, curve: &CertifiedCurve) -> String {
    match curve.nearest() {
        Some(nearest) => format!(
            "{:.6} m proven; closest: {} at {}",
            curve.clearance(),
            scene.describe(nearest.contact.pair),
            configuration(scene.arm(), nearest.at)
        ),
        None => "nothing can be hit".into(),
    }
}

/// What becomes of the path's corners, if it has any.
fn corners(curve: &CertifiedCurve) -> String {
    let radii = curve.curve().radii();
    let corners = radii.len().saturating_sub(2);
    let blended = radii.iter().filter(|radius| **radius > 0.0).count();
    match blended {
        _ if corners == 0 => String::new(),
        0 => format!("; stops at {corners} corners"),
        _ => {
            let largest = radii.iter().copied().fold(0.0, f64::max);
            format!("; {blended} of {corners} corners blended, radius up to {largest:.4}")
        }
    }
}

/// How near the path is to the optimum.
fn optimum(bound: &Bound) -> String {
    let Bound { metric, lower, upper } = *bound;
    let measure = match metric {
        Metric::Euclidean => format!("length {upper:.4}"),
        Metric::Weighted { weights: [a, b] } => format!("weighted length {upper:.4} (weights {a}, {b})"),
        Metric::Time { .. } => format!("{upper:.4} s at top speed"),
    };
    format!("{measure}; proven: none below {lower:.4}, so at most {} longer than the shortest", percent(bound.gap()))
}

/// A title, or words for none.
pub fn non_empty(name: &str) -> &str {
    if name.is_empty() { "(no name)" } else { name }
}
