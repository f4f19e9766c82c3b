//! Warnings, with hints, about properties that are probably unintended: wrong units, placeholders, missing axes.

use super::limits::key;
use super::reduction::Reduction;
use crate::quantity::find;
use cplan_geometry::Point;
use cplan_model::space::JointRange;
use cplan_model::{Arm, Joint};
use cplan_text::{counted, short};

/// Greatest plausible top speed of a revolute joint, in rad/s. The fastest axes of robots reach 45 rad/s.
const MAX_PLAUSIBLE_TURN_SPEED: f64 = 60.0;

/// Greatest plausible top speed of a prismatic joint, in m/s.
const MAX_PLAUSIBLE_SLIDE_SPEED: f64 = 20.0;

/// Greatest plausible length of arms, strokes and shapes, in metres. Only cranes are longer.
const MAX_PLAUSIBLE_LENGTH: f64 = 50.0;

/// Greatest plausible distance of an arm's shapes from its joints, as a multiple of the arm's length.
const MAX_PLAUSIBLE_OUTREACH: f64 = 20.0;

/// Shapes within this distance of the joints, in metres, are not compared with the arm's length, because the joints may almost
/// coincide.
const MIN_COMPARED_OUTREACH: f64 = 5.0;

/// Returns warnings about an arm, one per line.
pub(super) fn warnings(reduction: &Reduction, arm: &Arm) -> Vec<String> {
    let mut warnings = Vec::new();
    for (&index, joint) in reduction.chain.joints.iter().zip(&arm.joints) {
        warnings.extend(missing_axis(reduction, index));
        warnings.extend(speed(reduction, index, joint));
        warnings.extend(slide(joint));
    }
    warnings.extend(length(arm).or_else(|| outreach(arm)));
    warnings
}

/// Returns the warning about a joint without an axis.
pub(super) fn missing_axis(reduction: &Reduction, index: usize) -> Option<String> {
    let name = &reduction.document.robot.joints[index].name;
    reduction.document.joints[index].axis.is_none().then(|| {
        format!(
            "joint \"{name}\" has no <axis>, so the x axis of its frame is used; if the axis is z, write <axis xyz=\"0 0 1\"/>"
        )
    })
}

/// Returns the warning about a top speed that no drive reaches.
fn speed(reduction: &Reduction, index: usize, joint: &Joint) -> Option<String> {
    let Reduction { document, settings, .. } = reduction;
    let name = &joint.name;
    if !document.joints[index].has_velocity || find(&settings.table.velocity, name).is_some() {
        return None;
    }
    let velocity = document.robot.joints[index].limit.velocity;
    let turns = joint.joint_type.is_revolute();
    let (fastest, unit, example) =
        if turns { (MAX_PLAUSIBLE_TURN_SPEED, "rad", "2.0") } else { (MAX_PLAUSIBLE_SLIDE_SPEED, "m", "0.5") };
    let given = format!("joint \"{name}\": velocity=\"{velocity}\" in the URDF");
    let help = format!("state the top speed in the world file: [robot] velocity = {{ {} = {example} }}", key(name));
    if velocity == 0.0 {
        return Some(format!("{given} counts as missing; {help}"));
    }
    let degrees = if turns { format!(" ({} deg/s)", short(velocity.to_degrees())) } else { String::new() };
    (velocity > fastest).then(|| {
        format!("{given} means {velocity} {unit}/s{degrees}, faster than any drive, so times are too short; {help}")
    })
}

/// Returns the warning about a prismatic joint whose limits seem to be in millimetres.
fn slide(joint: &Joint) -> Option<String> {
    let JointRange::Interval { lower, upper } = joint.range else { return None };
    (!joint.joint_type.is_revolute() && upper - lower > 2.0 * MAX_PLAUSIBLE_LENGTH).then(|| {
        format!(
            "joint \"{}\" slides from {lower} to {upper} m; if the limits are in millimetres, divide them by 1000",
            joint.name
        )
    })
}

/// Returns the warning about an arm whose lengths seem to be in millimetres.
fn length(arm: &Arm) -> Option<String> {
    let [first, second] = lengths(arm);
    (first + second > MAX_PLAUSIBLE_LENGTH).then(|| {
        format!(
            "the arm is very long: {} m from joint to joint, {} m from joint to tip; if these are millimetres, divide them by 1000, because lengths in a URDF are in metres",
            short(first),
            short(second)
        )
    })
}

/// Returns the warning about shapes that reach far beyond the arm's joints.
fn outreach(arm: &Arm) -> Option<String> {
    let usual = (MAX_PLAUSIBLE_OUTREACH * lengths(arm).iter().sum::<f64>()).max(MIN_COMPARED_OUTREACH);
    let reach = |part: &cplan_model::Part| part.shape.reach_from(Point::zeros());
    let parts: Vec<_> = arm.links.iter().flat_map(|link| &link.parts).filter(|part| reach(part) > usual).collect();
    let first = parts.first()?;
    let farthest = parts.iter().map(|part| reach(part)).fold(0.0, f64::max);
    let mut bodies: Vec<&str> = parts.iter().map(|part| part.body.as_str()).collect();
    bodies.dedup();
    let others = if bodies.len() > 1 { format!(" (and {})", counted(bodies.len() - 1, "link")) } else { String::new() };
    Some(format!(
        "the shape of link \"{}\"{others} extends {} m from its joint, far more than the arm is long; write sizes in metres, and scale=\"0.001 0.001 0.001\" for a mesh in millimetres",
        first.body,
        short(farthest)
    ))
}

/// Returns the distance between the joints, and the distance from the second joint to the tip, in metres.
fn lengths(arm: &Arm) -> [f64; 2] {
    [arm.offset.norm(), arm.tip.norm()]
}
