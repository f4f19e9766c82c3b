//! The summary of a plan for people.

use super::motion_summary::{self, among_movers};
use super::picture::{is_tight, with_usual_clearance};
use super::task_summary;
use cplan_engine::{AllowedErrors, Detail, Plan};
use cplan_model::space::{Configuration, GoalSet, JointRange, Segment};
use cplan_model::{Arm, Joint, Status};
use cplan_motion::Trajectory;
use cplan_text::{Columns, chosen_length, counted, first_lines, length_down, short};
use std::time::Duration;

/// Returns the values of both joints by name.
pub fn configuration(arm: &Arm, q: Configuration) -> String {
    let [a, b] = &arm.joints;
    format!("{} {}, {} {}", a.name, a.format_value(q[0]), b.name, b.format_value(q[1]))
}

/// Returns the values of both joints by name along a segment. A joint that moves along the segment has its values at both ends.
pub fn segment(arm: &Arm, segment: &Segment) -> String {
    let [from, to] = segment.ends();
    let shown = |k: usize| {
        let joint = &arm.joints[k];
        match from[k] == to[k] {
            true => format!("{} {}", joint.name, joint.format_value(from[k])),
            false => {
                format!("{} any from {} to {}", joint.name, joint.format_value(from[k]), joint.format_value(to[k]))
            }
        }
    };
    format!("{}, {}", shown(0), shown(1))
}

/// Returns a line for each of the first few goals, and a line with the number of further goals.
pub fn goal_lines(arm: &Arm, goals: &GoalSet) -> Vec<Line> {
    let lines = goals.pieces().iter().map(|goal| segment(arm, goal)).collect();
    first_lines(lines, |more| format!("and {more} more")).into_iter().map(|line| ("goal", line)).collect()
}

/// Returns the range of a joint.
pub fn range(joint: &Joint) -> String {
    match joint.range {
        JointRange::Circle => "continuous".into(),
        JointRange::Interval { lower, upper } => {
            format!("{} to {}", joint.format_value(lower), joint.format_value(upper))
        }
    }
}

/// Keys of lines about the planner's work.
const DETAIL_KEYS: [&str; 5] = ["planner", "cells", "exact", "field", "nodes"];

/// Largest number of waits that the short summary lists.
const MAX_WAITS: usize = 3;

/// Returns the result in a few lines for people, the verdict first, with the written files and notes about assumed values. If
/// `is_verbose`, it also describes the planner's work, the problem, the arm, how the robot was read, and the times of all stages
/// in milliseconds, including those `after` planning.
pub fn summary_with(plan: &Plan, files: &[String], after: &[(&'static str, Duration)], is_verbose: bool) -> String {
    let SummaryLines { found: mut lines, asked } = summary_lines(plan);
    add_margin(plan, &mut lines);
    add_warning(plan, &mut lines);
    if let Some(blocked) = plan.motion().and_then(|(problem, answer)| motion_summary::blocked_by(problem, answer)) {
        lines.insert(1, blocked);
    }
    lines.retain(|(key, _)| is_verbose || !DETAIL_KEYS.contains(key));
    if !is_verbose {
        shorten_waits(&mut lines);
    }
    lines.extend(files.iter().map(|file| ("file", file.clone())));
    let robot = plan.problem().robot();
    let notes = robot.notes.iter().chain(plan.problem().notes()).map(|note| ("note", note.clone()));
    if !is_verbose {
        lines.extend(notes);
        return format_columns(&lines);
    }
    let stages = plan.timings().iter().chain(after);
    let stages: Vec<String> = stages.map(|(name, time)| format!("{name} {:.1}", time.as_secs_f64() * 1e3)).collect();
    lines.push(("time", format!("{} ms", stages.join(", "))));
    lines.extend(asked);
    lines.extend(arm_lines(plan.arm()));
    lines.extend(robot.geometry.iter().map(|fact| ("robot", fact.clone())));
    lines.extend(notes);
    format_columns(&lines)
}

/// Omits waits after the first few, and states their number.
fn shorten_waits(lines: &mut Vec<Line>) {
    let is_wait = |line: &Line| line.0 == "waits";
    let count = lines.iter().filter(|line| is_wait(line)).count();
    if count <= MAX_WAITS {
        return;
    }
    let mut seen = 0;
    let first_left_out = lines.iter().position(|line| {
        seen += usize::from(is_wait(line));
        seen > MAX_WAITS
    });
    if let Some(at) = first_left_out {
        lines[at].1 = format!("and {} more times (--verbose lists them)", count - MAX_WAITS);
        let mut index = 0;
        lines.retain(|line| {
            index += 1;
            index <= at + 1 || !is_wait(line)
        });
    }
}

/// Returns the verdict in words, the first line of the summary.
pub(super) fn verdict(plan: &Plan) -> String {
    summary_lines(plan).found.into_iter().next().map_or_else(String::new, |(_, text)| text)
}

/// Returns the facts for a page: outcome and arm.
pub(super) fn facts(plan: &Plan) -> Vec<[String; 2]> {
    let mut lines = summary_lines(plan).found;
    add_margin(plan, &mut lines);
    let lines = lines.into_iter().chain(arm_lines(plan.arm()));
    lines.map(|(key, text)| [key.to_owned(), text]).collect()
}

/// Adds a line about a clearance that no machine can keep, with the length of a path that keeps a usual one.
fn add_warning(plan: &Plan, lines: &mut Vec<Line>) {
    let Some(clearance) = plan.clearance().filter(|_| is_tight(plan)) else { return };
    let other = with_usual_clearance(plan).map_or_else(
        || "--clearance requires more".to_owned(),
        |[kept, length]| {
            let kept = chosen_length(kept);
            let length = plan.arm().format_length(length);
            format!("with --clearance {}, the path keeps {kept} and has length {length}", kept.replace(' ', ""))
        },
    );
    let at = lines.iter().rposition(|(key, _)| ["clearance", "margin"].contains(key)).map_or(lines.len(), |at| at + 1);
    let text = format!(
        "the arm passes within {} of an obstacle, because no clearance was required; {other}",
        length_down(clearance)
    );
    lines.insert(at, ("warning", text));
}

/// Adds the line about margins below that of the clearance.
fn add_margin(plan: &Plan, lines: &mut Vec<Line>) {
    let at = lines.iter().position(|(key, _)| *key == "clearance").filter(|_| plan.trajectory().is_some());
    let Some(at) = at else { return };
    let Some(words) = plan.margins().describe() else { return };
    lines.insert(at + 1, ("margin", words));
}

fn summary_lines(plan: &Plan) -> SummaryLines {
    let (problem, arm) = (plan.problem(), plan.arm());
    let moving = match problem.scene().loose_obstacles().len() {
        0 => String::new(),
        count => format!(", {count} moving"),
    };
    let (things, mut found, work, target) = match plan.detail() {
        Detail::Motion { problem, answer } => (
            counted(problem.scene().workspace().obstacles.len(), "obstacle"),
            motion_summary::result_lines(problem, answer),
            motion_summary::work_lines(plan, answer),
            goal_lines(arm, problem.goals()),
        ),
        Detail::Task { task, answer } => (
            counted(task.workspace.fixed.obstacles.len(), "obstacle") + ", " + &counted(task.objects.len(), "object"),
            task_summary::result_lines(plan, task, answer),
            task_summary::work_lines(plan, answer),
            task_summary::steps(task, answer),
        ),
    };
    if let Some(timing) = plan.timing() {
        found.extend(among_movers(arm, timing, plan.place_time().as_ref()));
    }
    found.extend(errors_line(plan));
    found.extend(work);
    found.extend(plan.options().planner.field().map(|field| ("field", field.to_string())));
    let name = non_empty(&problem.scene().workspace().name);
    let mut asked =
        vec![("world", format!("{name}, {things}{moving}")), ("start", configuration(arm, problem.query().start()))];
    asked.extend(target);
    SummaryLines { found, asked }
}

/// Describes the errors for which the motion must be free, and what the answer claims about them.
fn errors_line(plan: &Plan) -> Option<Line> {
    let AllowedErrors { robot, obstacles, .. } = plan.problem().errors()?;
    let angle = |radians: f64| format!("{} deg", short(radians.to_degrees()));
    let both = |length: f64, radians: f64| match (length > 0.0, radians > 0.0) {
        (true, true) => Some(format!("{} and {}", chosen_length(length), angle(radians))),
        (true, false) => Some(chosen_length(length)),
        (false, true) => Some(angle(radians)),
        (false, false) => None,
    };
    let stated = [
        ("base", both(robot.base_shift, robot.base_turn)),
        ("links", both(robot.links, 0.0)),
        ("zeros", both(robot.zero_slide, robot.zero_turn)),
        ("obstacles", both(*obstacles, 0.0)),
    ];
    let stated: Vec<String> = stated.into_iter().filter_map(|(of, size)| Some(format!("{of} {}", size?))).collect();
    let claim = plan.claim_about_errors().unwrap_or("no motion that is free for all of these errors was found");
    let drawn = match plan.status_as_drawn() {
        _ if plan.status() == Status::Found => "",
        Some(Status::Found) => "; without errors, there is one",
        Some(Status::Infeasible) => "; even without errors, there is none",
        Some(Status::Unknown) | None => "; whether there is one without errors is unknown",
    };
    Some(("errors", format!("{claim}: {}{drawn}", stated.join(", "))))
}

/// The lines of a summary about the result or the problem.
struct SummaryLines {
    /// Lines about the result, which pages show as well. The verdict comes first.
    found: Vec<Line>,
    /// Lines about the problem.
    asked: Vec<Line>,
}

/// A line of the summary: its key and its text. The key is empty if the line continues the one before.
pub type Line = (&'static str, String);

/// Describes the arm and its joints.
fn arm_lines(arm: &Arm) -> Vec<Line> {
    let mut lines = vec![("arm", format!("{} ({}), tip \"{}\"", arm.name, arm.kind(), arm.tip_name))];
    let dynamics = arm.dynamics.filter(|dynamics| dynamics.limits);
    for (k, joint) in arm.joints.iter().enumerate() {
        let unit = joint.unit();
        let mut speeds = format!("at most {} {unit}/s", joint.velocity);
        // Default accelerations are marked, because the user did not choose them.
        if dynamics.is_none_or(|dynamics| !dynamics.assumed[k]) {
            speeds += &format!(", {} {unit}/s2", joint.acceleration);
        }
        speeds += &joint.jerk.map(|jerk| format!(", {jerk} {unit}/s3")).unwrap_or_default();
        speeds += &dynamics.map(|d| format!(", {} {}", d.effort[k], joint.effort_unit())).unwrap_or_default();
        lines.push(("joint", format!("{}: {}; {speeds}", joint.name, range(joint))));
    }
    lines
}

/// Describes the greatest torques of a motion. `None` if the motion need not respect the effort limits of the joints.
pub(super) fn torque(arm: &Arm, trajectory: &Trajectory) -> Option<Line> {
    let dynamics = arm.dynamics.filter(|dynamics| dynamics.limits)?;
    let joint = |k: usize| {
        let greatest = trajectory.torque.iter().map(|torque| torque[k].abs()).fold(0.0, f64::max);
        let joint = &arm.joints[k];
        format!("{} {greatest:.2} of {} {}", joint.name, dynamics.effort[k], joint.effort_unit())
    };
    Some(("torque", format!("at most {}, {}", joint(0), joint(1))))
}

/// Formats lines in two columns.
pub fn format_columns(lines: &[Line]) -> String {
    let mut columns = Columns::default();
    lines.iter().for_each(|(key, line)| columns.add(key, line));
    columns.into_text()
}

/// Returns a title, or a placeholder if the title is empty.
fn non_empty(name: &str) -> &str {
    if name.is_empty() { "(no name)" } else { name }
}
