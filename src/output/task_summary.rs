//! The summary of a task for people.

use super::step_lines::{StepLine, step_lines};
use super::summary::{Line, arm_lines, configuration, field, named, non_empty, notes};
use crate::engine::task::{Leg, TaskAnswer, TaskReport};
use crate::engine::{Plan, TaskPlan, percent};
use crate::model::Task;
use crate::text::counted;

/// What was found, a line a step.
pub(super) fn lines(whole: &Plan, plan: &TaskPlan) -> Vec<Line> {
    let TaskPlan { task, answer, report } = plan;
    let mut lines = arm_lines(&task.arm);
    lines.extend(notes(whole));
    let things = [counted(task.workspace.obstacles.len(), "obstacle"), counted(task.objects.len(), "object")];
    lines.push(("world", format!("{}, {}", non_empty(&task.workspace.name), things.join(", "))));
    lines.push(("start", configuration(&task.arm, task.start)));
    let (motions, states) = (counted(answer.motions, "motion"), counted(answer.expanded, "state"));
    lines.push(("planner", format!("{}: {motions} planned, {states} seen", report.planner())));
    lines.extend(field(whole.options()));
    lines.extend(steps(task, answer).into_iter().map(|step| ("step", step)));
    lines.extend(outcome(answer, report));
    lines.extend(clearance(answer, report));
    lines
}

/// What a page says of it: arm and outcome.
pub(super) fn facts(plan: &TaskPlan) -> Vec<[String; 2]> {
    let TaskPlan { task, answer, report } = plan;
    named(arm_lines(&task.arm).into_iter().chain(outcome(answer, report)).chain(clearance(answer, report)))
}

/// A line a step, those of later cycles in one.
fn steps(task: &Task, answer: &TaskAnswer) -> Vec<String> {
    let repeated = answer.legs.iter().any(|leg| leg.step.cycle > 1);
    let line = |leg: &Leg| StepLine { cycle: leg.step.cycle, matters: false, columns: row(task, leg, repeated) };
    step_lines(&answer.legs.iter().map(line).collect::<Vec<_>>())
}

/// Number, action, what is carried, and the motion of a step.
fn row(task: &Task, leg: &Leg, repeated: bool) -> [String; 4] {
    let objects = &task.objects;
    let cycle = if repeated { format!(" (cycle {})", leg.step.cycle) } else { String::new() };
    let carried = leg.carried.map_or("empty-handed".into(), |object| format!("carrying \"{}\"", objects[object].name));
    let seconds = leg.timed.trajectory.duration();
    let turn = leg.turn.map_or(String::new(), |(_, seconds)| format!(", turn in {seconds:.3} s"));
    let clearance = match leg.clearance() {
        clearance if clearance.is_finite() => format!("clearance {clearance:.4} m"),
        _ => "nothing can be hit".into(),
    };
    let number = format!("{}{cycle}", leg.step.number);
    [number, leg.step.action.describe(objects), carried, format!("{seconds:.3} s{turn}, {clearance}")]
}

/// The verdict, and what is proven of the time, or why it fails.
fn outcome(answer: &TaskAnswer, report: &TaskReport) -> Vec<Line> {
    let count = counted(answer.legs.len(), "step");
    let (duration, lower) = report.seconds();
    let Some(duration) = duration else {
        let mut lines = vec![("result", report.reason().unwrap_or_default().to_owned())];
        let reasons = report.failed().into_iter().flat_map(|failed| failed.reasons.iter().cloned());
        lines.extend(reasons.map(|reason| ("why", reason)));
        lines.push(("before it", format!("{count} can be done, in {:.3} s", answer.duration())));
        return lines;
    };
    let samples = report.trajectory().map_or(0, |trajectory| trajectory.time.len());
    let still: f64 = answer.legs.iter().map(Leg::rest).sum();
    let still = if still > 0.0 { format!(", {still:.3} s of it standing still") } else { String::new() };
    let proven = match (lower, report.gap()) {
        (Some(lower), Some(gap)) => format!(
            "proven: no sequence of motions takes less than {lower:.3} s, so at most {} longer than the fastest",
            percent(gap)
        ),
        _ => "nothing is proven of the fastest".into(),
    };
    let choice = if answer.exact {
        "no other postures, turns and order are faster with the motions of this planner"
    } else {
        "a good choice of postures, turns and order; not all were looked at"
    };
    vec![
        ("result", format!("done and certified: {count}")),
        ("motion", format!("{duration:.3} s{still}, {samples} samples")),
        ("optimum", proven),
        ("optimum", choice.into()),
    ]
}

/// What is kept all the time, and in which step it comes nearest.
fn clearance(answer: &TaskAnswer, report: &TaskReport) -> Option<Line> {
    report.trajectory()?;
    let least = answer.legs.iter().min_by(|a, b| a.clearance().total_cmp(&b.clearance()))?;
    let (step, cycle) = (least.step.number, least.step.cycle);
    let cycle = if cycle > 1 { format!(" of cycle {cycle}") } else { String::new() };
    let curve = &least.timed.curve;
    let closest = match (least.turn, curve.nearest()) {
        (Some((turn, _)), _) if turn.clearance < curve.clearance() => "the object that is turned".to_owned(),
        (_, Some(nearest)) => least.scene.describe(nearest.contact.pair),
        (_, None) => return Some(("clearance", "nothing can be hit".into())),
    };
    Some(("clearance", format!("{:.6} m proven; closest: {closest} in step {step}{cycle}", least.clearance())))
}
