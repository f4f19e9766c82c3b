//! Describes why a configuration is outside the limits or blocked, and why no IK solution reaches a point.

use super::World;
use cplan_geometry::Point;
use cplan_model::space::{Configuration, JointRange, Segment};
use cplan_model::{Freedom, Inverse, Obstruction, Scene, equivalent_values};
use cplan_text::{fixed, format_distinct, joined};
use std::f64::consts::TAU;
use std::ops::Range;

/// Returns the IK solutions of `solved` that are within the joint limits, shifted by every whole turn that keeps them there. Also
/// returns a reason for each solution outside the limits.
pub(super) fn within_limits(scene: &Scene, solved: &Inverse) -> (Vec<Segment>, Vec<String>) {
    let joints = &scene.arm().joints;
    let outside = |branch: &Configuration| {
        let counts = |i: usize| solved.free.is_none_or(|free| free == Freedom::Joint(1 - i));
        let copies = [0, 1].map(|i| equivalent_values(joints[i].range, joints[i].joint_type.is_revolute(), branch[i]));
        let alone = || Inverse { branches: vec![*branch], free: solved.free }.solutions(scene.arm());
        let beyond = (0..2).any(|i| counts(i) && copies[i].is_empty())
            || scene.arm().topology().sum.is_some() && alone().is_empty();
        // A joint that is free at this point has allowed values, so the message may show any value.
        let shown = Configuration::from_fn(|i, _| match joints[i].range {
            JointRange::Interval { lower, upper } if !counts(i) => branch[i].clamp(lower, upper),
            _ => copies[i].first().copied().unwrap_or(branch[i]),
        });
        beyond.then(|| format!("({}): {}", describe(scene, shown), beyond_limits(scene, shown).join("; ")))
    };
    (solved.solutions(scene.arm()), solved.branches.iter().filter_map(outside).collect())
}

/// Formats joint values: `shoulder -0.9 rad, elbow 0.4 rad`.
pub(super) fn describe(scene: &Scene, q: Configuration) -> String {
    let value = |i: usize| format!("{} {} {}", scene.arm().joints[i].name, rounded(q[i]), scene.arm().joints[i].unit());
    format!("{}, {}", value(0), value(1))
}

/// Formats the values of a joint along a segment: `shoulder 1 rad, elbow from -2.5 to 2.5 rad`.
pub(super) fn describe_segment(scene: &Scene, segment: &Segment) -> String {
    let [from, to] = segment.ends();
    let value = |i: usize| {
        let (name, unit) = (&scene.arm().joints[i].name, scene.arm().joints[i].unit());
        if from[i] == to[i] {
            format!("{name} {} {unit}", rounded(from[i]))
        } else {
            format!("{name} from {} to {} {unit}", rounded(from[i]), rounded(to[i]))
        }
    };
    format!("{}, {}", value(0), value(1))
}

/// Rounds to six decimals, which suffice for messages.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6 + 0.0
}

/// Describes the joints whose values are outside their limits.
pub(super) fn beyond_limits(scene: &Scene, q: Configuration) -> Vec<String> {
    let mut outside = Vec::new();
    for (joint, value) in scene.arm().joints.iter().zip(q.iter()) {
        if let JointRange::Interval { lower, upper } = joint.range
            && !joint.range.contains(*value)
        {
            let unit = joint.unit();
            // A rounded value could be within the limits although the value is not.
            let shown = if joint.range.contains(rounded(*value)) { *value } else { rounded(*value) };
            outside.push(format!(
                "joint \"{}\" at {shown} {unit} exceeds its limits [{lower}, {upper}] {unit}",
                joint.name
            ));
        }
    }
    if let Some(sum) = scene.arm().topology().sum
        && !sum.contains(q)
    {
        let [value, lower, upper] = [sum.of(q), sum.lower, sum.upper].map(rounded);
        let turns = match sum.ratio {
            1.0 => "the sum of both joint values".into(),
            ratio => format!("{ratio} times the value of joint 1 plus that of joint 2"),
        };
        outside
            .push(format!("{turns} is {value} rad, outside the limits of the elbow's motor, [{lower}, {upper}] rad"));
    }
    outside
}

/// Notation of two joint values in the input.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Notation {
    /// True in the world file, where values in degrees are strings.
    pub in_file: bool,
    /// True for each value in degrees.
    pub in_degrees: [bool; 2],
}

impl Notation {
    /// Returns the notation of the joint values in a part of the world file.
    pub fn in_world(world: &World, at: &Range<usize>) -> Self {
        let is_inside = |value: &Range<usize>| at.start <= value.start && value.end <= at.end;
        let is_in_degrees =
            |i: usize| world.in_degrees.iter().filter_map(|pair| pair.degrees[i].as_ref()).any(is_inside);
        Self { in_file: true, in_degrees: [0, 1].map(is_in_degrees) }
    }
}

/// Returns the hint about a configuration outside the limits.
pub(super) fn help_for_limits(scene: &Scene, q: Configuration, notation: Notation) -> String {
    hint_for_degrees(scene, q, notation).unwrap_or_else(|| HELP_FOR_LIMITS.to_owned())
}

/// Returns the hint that degrees may be meant, if a value in radians is more than a turn and outside the limits, but would be
/// within them in degrees. Otherwise `None`.
pub(super) fn hint_for_degrees(scene: &Scene, q: Configuration, notation: Notation) -> Option<String> {
    let quote = if notation.in_file { "\"" } else { "" };
    let degrees = |i: usize| {
        let (joint, value) = (&scene.arm().joints[i], q[i]);
        let is_meant = !notation.in_degrees[i]
            && joint.joint_type.is_revolute()
            && value.abs() > TAU
            && !joint.range.contains(value)
            && joint.range.contains(value.to_radians());
        is_meant.then(|| format!("{quote}{value}deg{quote}"))
    };
    let meant: Vec<String> = (0..2).filter_map(degrees).collect();
    (!meant.is_empty()).then(|| format!("angles are in radians; if degrees are meant, write {}", joined(&meant)))
}

/// Hint to change the limits.
macro_rules! change_limits {
    () => {
        "change the limits in the world file: of joints in [robot] limits, of motors in [robot] drives"
    };
}

/// Hint about a configuration outside the limits.
pub(super) const HELP_FOR_LIMITS: &str = concat!("choose values within the limits, or ", change_limits!());

/// Hint about a tip position outside the limits.
pub(super) const HELP_FOR_TIP: &str = concat!("choose another point, or ", change_limits!());

/// Explains why `q` is blocked: the worst pair of shapes for each link and obstacle.
pub(super) fn obstructions(scene: &Scene, q: Configuration) -> Vec<String> {
    scene.obstructions(q).iter().map(|obstruction| scene.explain(obstruction)).collect()
}

/// Returns the hint about a blocked configuration. If only links of the robot hit each other, names them and the line of the
/// world file that lets them touch.
pub(super) fn help_at(scene: &Scene, q: Configuration) -> String {
    let (mut shapes, mut links) = (Vec::new(), Vec::new());
    for Obstruction { contact, .. } in scene.obstructions(q) {
        let Some(own) = scene.self_obstacle(contact.pair.obstacle) else {
            return help_for_contact(scene, "configuration");
        };
        let (part, fixed) = (&scene.link(contact.pair).parts[contact.pair.part], &own.obstacle.name);
        let [of_fixed, of_part] = [own.number + 1, part.number + 1];
        shapes.push(format!("shape {of_part} of \"{}\" and shape {of_fixed} of \"{fixed}\"", part.body));
        links.push(format!("[\"{fixed}\", \"{}\"]", part.body));
    }
    if links.is_empty() {
        return help_for_contact(scene, "configuration");
    }
    let (shapes, links) = (shapes.join(", "), links.join(", "));
    format!(
        "choose another configuration; or, if these parts do not touch in reality ({shapes}), write [robot] ignore_contact = [{links}]"
    )
}

/// Returns the hint about a target at which the arm touches an obstacle, or nearly does. `target` names its kind: a
/// configuration, or a point for the tip.
fn help_for_contact(scene: &Scene, target: &str) -> String {
    let clearance = scene.workspace().clearance;
    if clearance > scene.arm().reach() {
        format!("the clearance is in metres; if {clearance} mm are meant, write {clearance}mm")
    } else if clearance > 0.0 {
        format!("choose a {target} farther from the obstacle, or require less clearance")
    } else {
        format!("choose a {target} away from the obstacle (touching counts as contact)")
    }
}

/// Returns the hint for a target without a usable IK solution. `outside` is true if some solutions are outside the limits, and
/// `blocked` if some are blocked.
pub(super) fn help_for_ik_solutions(scene: &Scene, outside: bool, blocked: bool) -> String {
    let contact = help_for_contact(scene, "point");
    match (outside, blocked) {
        (true, false) => HELP_FOR_TIP.to_owned(),
        (true, true) => format!("{contact}, or {}", change_limits!()),
        (false, _) => contact,
    }
}

/// Explains that no IK solution reaches `point`. The sentence starts with `what`.
pub(super) fn describe_out_of_reach(scene: &Scene, what: &str, point: Point) -> String {
    let arm = scene.arm();
    let from_joint = (point - arm.base).norm();
    let [distance, reach] = if arm.only_turns() {
        let (upper, lower) = (arm.offset.norm(), arm.tip.norm());
        let [distance, least, most] = format_distinct([from_joint, (upper - lower).abs(), upper + lower], 4);
        [distance, format!(", and the tip reaches from {least} to {most} m")]
    } else {
        [fixed(from_joint, 4), String::new()]
    };
    format!(
        "{what} ({}, {}) m is out of reach of the tip \"{}\" even without joint limits: {distance} m from joint \"{}\"{reach}",
        point.x, point.y, arm.tip_name, arm.joints[0].name,
    )
}

/// Returns the hint about a point out of reach.
pub(super) fn help_for_reach(scene: &Scene, point: Point) -> String {
    let arm = scene.arm();
    let (upper, lower) = (arm.offset.norm(), arm.tip.norm());
    let is_inside = arm.only_turns() && (point - arm.base).norm() < (upper - lower).abs();
    let place = if is_inside { "farther from joint 1" } else { "nearer to joint 1" };
    format!("choose a point {place}; coordinates are metres in the arm's plane")
}
