//! The findings of `verify` as text.

use crate::check::Limit;
use crate::engine::findings::{
    CollisionFinding, EncounterFinding, FarthestFinding, Judgement, LimitFinding, MomentFinding, MotionFindings,
    PlanFinding, StepFinding,
};
use crate::model::Arm;
use crate::output::{Line, StepLine, configuration, format_columns, step_lines};
use crate::space::Recording;
use crate::text::{chosen_length, counted, fixed, format_distinct, length, length_down, length_unlike};

/// Depth of a contact, in metres, up to which it is attributed to rounding.
const TOUCHING_DEPTH: f64 = 1e-9;

/// Returns the findings as text.
pub(super) fn summary(arm: &Arm, recording: &Recording, findings: &MotionFindings) -> String {
    let mut lines = vec![("result", result(findings))];
    lines.extend(collisions(arm, &findings.collisions, findings.verdict));
    lines.extend(findings.margins.iter().filter_map(|margins| Some(("margin", margins.describe()?))));
    lines.extend(findings.steps.iter().flatten().filter_map(turn));
    lines.extend(findings.limits_broken.iter().map(|limit| ("limit", broken(arm, limit))));
    let exceeds = |limit| {
        ("assumed", format!("{}; this does not count, because the files state no such limit", broken(arm, limit)))
    };
    lines.extend(findings.assumed_exceeded.iter().map(exceeds));
    let of = if findings.steps.is_some() { "task" } else { "fault" };
    lines.extend(findings.faults.iter().map(|fault| (of, fault.clone())));
    if !findings.not_judged.is_empty() {
        lines.push(("not judged", format!("the file's values of {}", findings.not_judged.join(", "))));
    }
    lines.extend(findings.plan.iter().flat_map(plan));
    let duration = findings.duration.map_or("no times".into(), |d| format!("{d:.3} s"));
    lines.push(("motion", format!("{} samples, {duration}", findings.samples)));
    let positions = recording.positions();
    lines.push(("from", configuration(arm, positions[0])));
    lines.push(("to", configuration(arm, positions[findings.samples - 1])));
    lines.extend(findings.steps.iter().flat_map(|steps| rows(steps)).map(|row| ("step", row)));
    lines.push(("arm", format!("{} ({})", arm.name, arm.kind())));
    lines.extend(findings.notes.iter().map(|note| ("note", note.clone())));
    format_columns(&lines)
}

/// Describes the time or the place of a moment in words.
fn format_moment(m: &MomentFinding) -> String {
    match (m.time, m.waypoint) {
        (Some(time), _) => format!("at {time:.6} s (sample {})", m.sample),
        (None, waypoint) => format!("at waypoint {:.4}", waypoint.unwrap_or_default()),
    }
}

/// Returns lines about the greatest distances from the plan.
fn plan(PlanFinding { joints, tip }: &PlanFinding) -> [Line; 2] {
    let farthest = |distance: String, place: &FarthestFinding| {
        format!("at most {distance} from the plan, {}", format_moment(&place.moment))
    };
    [
        ("plan", farthest(format!("{} in joint space", fixed(joints.distance, 6)), joints)),
        ("", format!("tip {}", farthest(format!("{} mm", fixed(1e3 * tip.distance, 3)), tip))),
    ]
}

/// Returns lines about the collisions along the motion, and about its clearance.
fn collisions(arm: &Arm, collisions: &CollisionFinding, verdict: Judgement) -> Vec<Line> {
    let place = |e: &EncounterFinding| {
        format!("{} {}, {}", e.pair, format_moment(&e.moment), configuration(arm, e.moment.configuration.into()))
    };
    let depth = |e: &EncounterFinding| match e.depth {
        d if (0.0..TOUCHING_DEPTH).contains(&d) => "just touching".into(),
        d if d >= 0.0 => format!("{} deep", length(d)),
        d => format!("{} apart", length(-d)),
    };
    let mut lines = Vec::new();
    match (collisions.clearance, &collisions.nearest) {
        (Some(proven), Some(nearest)) => {
            let seen =
                format!("{} proven; least seen {}: {}", length_down(proven), length(-nearest.depth), place(nearest));
            lines.push(("clearance", seen));
        }
        (Some(clearance), None) => lines.push(("clearance", format!("{} proven", length_down(clearance)))),
        (None, None) if verdict != Judgement::Collision && collisions.undecided.is_none() => {
            lines.push(("clearance", "no obstacle within reach".into()));
        }
        _ => {}
    }
    if let Some(first) = &collisions.first_contact {
        let key = if first.depth < 0.0 { "too near" } else { "contact" };
        lines.push((key, format!("{}, {}", place(first), depth(first))));
        lines.extend(collisions.free_until.map(|until| match first.moment.time {
            Some(_) => ("", format!("proven free before {until:.6} s")),
            None => ("", format!("proven free before waypoint {until:.4}")),
        }));
    }
    lines.extend(collisions.deepest.iter().map(|deepest| {
        (if deepest.depth < 0.0 { "nearest" } else { "deepest" }, format!("{}, {}", place(deepest), depth(deepest)))
    }));
    lines.extend(
        collisions.undecided.iter().map(|nearest| {
            ("undecided", format!("{}: {}, too near to decide", place(nearest), length(-nearest.depth)))
        }),
    );
    lines
}

fn broken(arm: &Arm, limit: &LimitFinding) -> String {
    let excess = &limit.excess;
    // A motor is described like the joint that it drives.
    let joint = arm.joints.get(excess.joint).unwrap_or(&arm.joints[1]);
    let unit = joint.unit();
    // The allowed value has no sign.
    let [size, allowed] = format_distinct([excess.value.abs(), excess.allowed], 6);
    let value = if excess.value < 0.0 { format!("-{size}") } else { size };
    let what = match excess.limit {
        Limit::Position => {
            let [value, allowed] = joint.format_distinct([excess.value, excess.allowed]);
            format!("position {value} beyond {allowed}")
        }
        Limit::Velocity => format!("velocity {value} {unit}/s, at most {allowed}"),
        Limit::Acceleration => format!("acceleration {value} {unit}/s2, at most {allowed}"),
        Limit::Jerk => format!("jerk {value} {unit}/s3, at most {allowed}"),
        Limit::Torque => format!("torque {value} {}, at most {allowed}", joint.effort_unit()),
        Limit::AccelerationJump => format!("acceleration jumps by {value} {unit}/s2"),
        Limit::RestAtStart => format!("starts at {value} {unit}/s, not at rest"),
        Limit::RestAtEnd => format!("ends at {value} {unit}/s, not at rest"),
    };
    format!("{}: {what}, {}", limit.joint, format_moment(&limit.moment))
}

/// Describes the turn of the wrist in which the payload hits an obstacle. `None` if it hits nothing.
fn turn(step: &StepFinding) -> Option<Line> {
    let contact = step.turn.as_ref()?.contact.as_ref()?;
    let object = step.object.as_deref().or(step.carried.as_deref()).unwrap_or_default();
    let what = format!("payload \"{object}\" and obstacle \"{}\"", contact.obstacle);
    Some(("turn", format!("{what} in {}, at {:.6} rad", step.name(), contact.angle)))
}

/// Returns one line per step.
fn rows(steps: &[StepFinding]) -> Vec<String> {
    let repeated = steps.iter().any(|step| step.cycle > 1);
    let line = |step: &StepFinding| {
        let cycle = if repeated { format!(" (cycle {})", step.cycle) } else { String::new() };
        let carried = step.carried.as_ref().map_or("empty-handed".into(), |object| format!("carrying \"{object}\""));
        let turn = step.turn.as_ref().map_or(String::new(), |turn| format!(", turn in {:.3} s", turn.seconds));
        let found = match (step.verdict, step.clearance()) {
            (Judgement::Free, Some(clearance)) => format!("clearance {}", length_down(clearance)),
            (Judgement::Free, None) => "no obstacle within reach".into(),
            (Judgement::Collision, _) if step.collisions.touches == Some(false) => "nearer than required".into(),
            (Judgement::Collision, _) => "collides".into(),
            (Judgement::Task | Judgement::Ends | Judgement::Claims, _) => "not as required".into(),
            (Judgement::Limits, _) => "breaks limits".into(),
            (Judgement::Undecided, _) => "undecided".into(),
        };
        let motion = format!("{:.3} s{turn}, {found}", step.seconds);
        let columns = [format!("{}{cycle}", step.step), step.action.clone(), carried, motion];
        StepLine { cycle: step.cycle, is_listed: step.verdict != Judgement::Free, columns }
    };
    step_lines(&steps.iter().map(line).collect::<Vec<_>>())
}

/// Describes a motion that collides, or comes nearer than the required clearance.
fn too_near(collisions: &CollisionFinding, required: f64) -> String {
    let (Some(deepest), Some(shortfall)) = (&collisions.deepest, collisions.shortfall) else {
        return "collision: proven".into();
    };
    let least = -deepest.depth;
    let is_near = || {
        let [by, least, required] = [length(shortfall), length_unlike(least, required), chosen_length(required)];
        format!("too near by {by} ({least} instead of the required {required}): proven")
    };
    match collisions.touches {
        Some(true) => "collision: proven".into(),
        Some(false) => format!("{}; no collision: proven", is_near()),
        None => format!("{}; whether the arm collides is undecided", is_near()),
    }
}

fn result(findings: &MotionFindings) -> String {
    let required = findings.required;
    let kept = if required > 0.0 { format!(" by {}", chosen_length(required)) } else { String::new() };
    let whole = match &findings.steps {
        Some(steps) => format!("the whole task, {}, ", counted(steps.len(), "step")),
        None => "the whole motion, ".into(),
    };
    match findings.verdict {
        Judgement::Free => format!("free{kept}: {whole}proven"),
        Judgement::Collision => too_near(&findings.collisions, required),
        Judgement::Task => "not the task of the world".into(),
        Judgement::Ends => "the motion does not lead from the start to the goal".into(),
        Judgement::Claims => "free, but values stated in the file are wrong".into(),
        Judgement::Limits => "limits are broken".into(),
        Judgement::Undecided => "undecided".into(),
    }
}
