//! The summary for people.

use super::task_summary;
use crate::check::CertifiedCurve;
use crate::engine::{Bound, Made, MotionPlan, Options, Plan, Verdict, percent};
use crate::model::{Arm, Joint, Scene};
use crate::space::{Configuration, JointRange, Metric, Segment};
use crate::text::{Columns, counted};
use std::time::Duration;

/// A joint's value with its unit, angles in both units: `0.3491 rad (20.00 deg)`.
pub fn value(joint: &Joint, value: f64) -> String {
    if joint.joint_type.is_revolute() {
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
    match joint.range {
        JointRange::Circle => "continuous".into(),
        JointRange::Interval { lower, upper } => format!("{} to {}", value(joint, lower), value(joint, upper)),
    }
}

impl Plan {
    /// What was found, in some ten lines for people; of a task a line a step.
    #[must_use]
    pub fn summary(&self) -> String {
        self.summary_with(&[], &[])
    }

    /// The same with the files that were written and the stages, in milliseconds, that came after planning.
    #[must_use]
    pub(crate) fn summary_with(&self, files: &[String], after: &[(&'static str, Duration)]) -> String {
        let mut lines = match self.made() {
            Made::Motion(plan) => motion_lines(self, plan),
            Made::Task(plan) => task_summary::lines(self, plan),
        };
        lines.extend(files.iter().map(|file| ("file", file.clone())));
        let stages = self.timings().iter().chain(after);
        let stages: Vec<String> =
            stages.map(|(name, time)| format!("{name} {:.1}", time.as_secs_f64() * 1e3)).collect();
        lines.push(("time", format!("{} ms", stages.join(", "))));
        laid_out(&lines)
    }
}

fn motion_lines(whole: &Plan, plan: &MotionPlan) -> Vec<Line> {
    let (problem, scene) = (&plan.problem, plan.problem.scene());
    let arm = scene.arm();
    let mut lines = arm_lines(arm);
    lines.extend(notes(whole));
    let obstacles = counted(scene.workspace().obstacles.len(), "obstacle");
    lines.push(("world", format!("{}, {obstacles}", non_empty(&scene.workspace().name))));
    lines.push(("start", configuration(arm, problem.start())));
    lines.extend(problem.goals().pieces().iter().map(|goals| ("goal", segment(arm, goals))));
    lines.extend(outcome(plan, whole.options()));
    lines
}

/// How robot and world were read.
pub(super) fn notes(plan: &Plan) -> impl Iterator<Item = Line> + '_ {
    plan.problem().robot().notes.iter().chain(plan.problem().notes()).map(|note| ("", note.clone()))
}

/// What a page says of it: arm and outcome.
pub(super) fn facts(plan: &MotionPlan, options: &Options) -> Vec<[String; 2]> {
    named(arm_lines(plan.problem.scene().arm()).into_iter().chain(outcome(plan, options)))
}

/// Lines for a page.
pub(super) fn named(lines: impl IntoIterator<Item = Line>) -> Vec<[String; 2]> {
    lines.into_iter().map(|(key, text)| [key.to_owned(), text]).collect()
}

/// What the planner did and found.
fn outcome(plan: &MotionPlan, options: &Options) -> Vec<Line> {
    let MotionPlan { problem, answer, curve, report } = plan;
    let mut lines = Vec::new();
    let search = report.search.as_ref().map(|used| format!(" ({}, {} neighbours)", used.search, used.neighbors));
    let space = report.space.map(|space| format!(", {space}"));
    let how = search.unwrap_or_default() + &space.unwrap_or_default();
    lines.push(("planner", format!("{}{how}: {}", answer.method, answer.run.size)));
    lines.extend(answer.run.note.map(|note| ("planner", note.to_string())));
    lines.extend(field(options));
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
pub(super) fn arm_lines(arm: &Arm) -> Vec<Line> {
    let mut lines = vec![("arm", format!("{} ({}), tip \"{}\"", arm.name, arm.kind(), arm.tip_name))];
    for joint in &arm.joints {
        let unit = joint.unit();
        let jerk = joint.jerk.map(|jerk| format!(", {jerk} {unit}/s3")).unwrap_or_default();
        let speeds = format!("at most {} {unit}/s, {} {unit}/s2{jerk}", joint.velocity, joint.acceleration);
        lines.push(("joint", format!("{}: {}; {speeds}", joint.name, range(joint))));
    }
    lines
}

/// The field that was asked for.
pub(super) fn field(options: &Options) -> Option<Line> {
    options.planner.field().map(|field| ("field", field.to_string()))
}

/// Lines in two columns.
pub fn laid_out(lines: &[Line]) -> String {
    let mut columns = Columns::default();
    lines.iter().for_each(|(key, line)| columns.add(key, line));
    columns.into_text()
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
pub(super) fn non_empty(name: &str) -> &str {
    if name.is_empty() { "(no name)" } else { name }
}
