//! The summary of a task for people.

use super::step_lines::{StepLine, step_lines};
use super::summary::{Line, torque};
use cplan_engine::Plan;
use cplan_handling::Task;
use cplan_legs::{FailedStep, Leg, TaskAnswer, TaskMotion};
use cplan_model::Outcome;
use cplan_text::{counted, length_down, percent, round_down, short};

/// Returns the lines about the result. The verdict comes first.
pub(super) fn result_lines(plan: &Plan, task: &Task, answer: &TaskAnswer) -> Vec<Line> {
    match &answer.outcome {
        Outcome::Found(motion) => motion_lines(task, answer, motion),
        Outcome::Infeasible(failed) | Outcome::Unknown(failed) => failure_lines(plan, answer, failed),
    }
}

/// Returns a line about the work of the planner.
pub(super) fn work_lines(plan: &Plan, answer: &TaskAnswer) -> Vec<Line> {
    let (motions, states) = (counted(answer.motions, "motion"), counted(answer.expanded, "state"));
    vec![("planner", format!("{}: {motions} planned, {states} examined", plan.options().planner.method()))]
}

/// Returns the lines of the steps. Late repetitions are merged.
pub(super) fn steps(task: &Task, answer: &TaskAnswer) -> Vec<Line> {
    let repeated = answer.legs.iter().any(|leg| leg.step.cycle > 1);
    let line = |leg: &Leg| StepLine { cycle: leg.step.cycle, is_listed: false, columns: row(task, leg, repeated) };
    let lines = step_lines(&answer.legs.iter().map(line).collect::<Vec<_>>());
    lines.into_iter().map(|step| ("step", step)).collect()
}

/// Returns number, action, payload and motion of a step.
fn row(task: &Task, leg: &Leg, repeated: bool) -> [String; 4] {
    let objects = &task.objects;
    let cycle = if repeated { format!(" (cycle {})", leg.step.cycle) } else { String::new() };
    let carried = leg.carried.map_or("empty-handed".into(), |object| format!("carrying \"{}\"", objects[object].name));
    let seconds = leg.timed.trajectory.duration();
    let turn = leg.turn.map_or(String::new(), |(_, seconds)| format!(", turn in {seconds:.3} s"));
    let wrist = leg.wrist.map_or(String::new(), |turn| format!(", wrist turned by {} rad", short(turn.angle)));
    let turn = turn + &strokes(leg) + &wrist;
    let clearance = match leg.clearance() {
        clearance if clearance.is_finite() => format!("clearance {}", length_down(clearance)),
        _ => "no obstacle within reach".into(),
    };
    let number = format!("{}{cycle}", leg.step.number);
    [number, leg.step.action.describe(objects), carried, format!("{seconds:.3} s{turn}, {clearance}")]
}

/// Describes the strokes at the beginning and the end of a motion, if the tool is lowered there.
fn strokes(leg: &Leg) -> String {
    let raising = leg.raising.map(|stroke| format!(", tool raised from {} m", short(stroke.lowered)));
    let lowered = leg.stroke.filter(|_| leg.event.is_none());
    let lowering = lowered.map(|stroke| format!(", tool lowered to {} m", short(stroke.lowered)));
    raising.into_iter().chain(lowering).collect()
}

/// Returns the step that fails, and why.
fn failure_lines(plan: &Plan, answer: &TaskAnswer, failed: &FailedStep) -> Vec<Line> {
    let mut lines = vec![("result", plan.reason().unwrap_or_default())];
    lines.extend(failed.reasons.iter().map(|reason| ("why", reason.clone())));
    let count = counted(answer.legs.len(), "step");
    lines.push(("before it", format!("{count} planned, {:.3} s", answer.duration())));
    lines
}

/// Returns the lines about the whole motion, with its duration and proven clearance.
fn motion_lines(task: &Task, answer: &TaskAnswer, motion: &TaskMotion) -> Vec<Line> {
    let count = counted(answer.legs.len(), "step");
    let trajectory = &motion.sequence.trajectory;
    let samples = trajectory.time.len();
    let still: f64 = answer.legs.iter().map(|leg| leg.rest() + leg.raising_at_rest()).sum();
    let still = if still > 0.0 { format!(", {still:.3} s of it at rest") } else { String::new() };
    let proven = match answer.gap() {
        Some(gap) => format!(
            "every sequence of motions takes at least {} s (proven), so at most {} longer than the fastest",
            round_down(answer.least_seconds(), 3),
            percent(gap)
        ),
        None => "no lower bound on the duration is known".into(),
    };
    let choice = if motion.exact {
        "with this planner's motions, no other IK solutions, wrist turns or order are faster"
    } else {
        "good IK solutions, wrist turns and order, not proven best: the search was not exhaustive"
    };
    let mut lines = vec![
        ("result", format!("found and certified: {count}")),
        ("motion", format!("{:.3} s{still}, {samples} samples", trajectory.duration())),
    ];
    lines.extend(torque(&task.arm, trajectory));
    lines.push(("optimum", proven));
    lines.extend(answer.legs.first().and_then(bounded_motions).map(|about| ("optimum", about)));
    lines.push(("optimum", choice.into()));
    lines.extend(clearance(answer));
    lines
}

/// Describes the motions for which the bound holds, unless it holds for all. If the tool is lowered at both ends of the first
/// motion, the rules of tasks raise it in between; the bound holds only for such motions.
fn bounded_motions(leg: &Leg) -> Option<String> {
    let (first, last) = leg.raising.zip(leg.stroke)?;
    let is_same_side = (first.lowered - first.raised) * (last.lowered - last.raised) > 0.0;
    is_same_side
        .then(|| format!("the bound holds for motions that raise the tool to {} m in between", short(first.raised)))
}

/// Returns a line with the clearance of the whole motion, and the step that comes nearest to an obstacle.
fn clearance(answer: &TaskAnswer) -> Option<Line> {
    let least = answer.legs.iter().min_by(|a, b| a.clearance().total_cmp(&b.clearance()))?;
    let (step, cycle) = (least.step.number, least.step.cycle);
    let cycle = if cycle > 1 { format!(" of cycle {cycle}") } else { String::new() };
    // Pictures number the steps in the order of execution.
    let is_in_order = answer.legs.is_sorted_by_key(|leg| (leg.step.cycle, leg.step.number));
    let file = if is_in_order { "" } else { " of the file" };
    let curve = &least.timed.curve;
    let closest = match (least.turn, curve.nearest()) {
        (Some((turn, _)), _) if turn.clearance < curve.clearance() => "the object that the wrist turns".to_owned(),
        (_, Some(nearest)) => least.scene.describe(nearest.contact.pair),
        (_, None) => return Some(("clearance", "no obstacle within reach".into())),
    };
    let kept = length_down(least.clearance());
    Some(("clearance", format!("{kept} proven; closest: {closest} in step {step}{file}{cycle}")))
}
