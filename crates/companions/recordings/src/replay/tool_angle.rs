//! The angle of the tool on recorded motions along a line.

use super::Fault;
use cplan_deviation::{Deviation, Kinematics, Line, ToolDeviation};
use cplan_handling::{FollowedLine, Recording, RecordingError, Task, Wrist, WristGuide, WristJoint};
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Joint, JointType};
use cplan_motion::recorded::{Limit, LimitViolation, limit_violations};

/// Returns the faults of the wrist along a line: it exceeds its limits, or the tool is not proven to keep the angle
/// that the line requires. `wrist` has the joint's value, velocity and acceleration at each sample of the motion.
pub(super) fn faults(
    task: &Task,
    motion: &Recording,
    followed: &FollowedLine,
    wrist: Option<&[[f64; 3]]>,
) -> Vec<Fault> {
    let Some(guide) = followed.wrist else { return Vec::new() };
    let Some((limits, joint)) = task.wrist.and_then(|limits| Some((limits, limits.joint?))) else {
        return vec![Fault::NoWrist];
    };
    let rows = wrist.filter(|rows| rows.len() == motion.positions().len());
    let Some((rows, wrist)) = rows.and_then(|rows| Some((rows, recording(motion, rows).ok()?))) else {
        return vec![Fault::NoWristMotion];
    };
    let mut faults: Vec<Fault> = limit_faults(limits, joint, &wrist).collect();
    let Ok(angles) = recording(motion, &angles(task, joint, motion, rows)) else { return vec![Fault::NoWristMotion] };
    faults.extend(angle_fault(task, guide, motion, &angles, followed));
    faults
}

/// Returns a recording whose first component is this value at the samples of a motion. It has the motion's interpolation.
fn recording(motion: &Recording, rows: &[[f64; 3]]) -> Result<Recording, RecordingError> {
    let column = |k: usize| rows.iter().map(|row| Configuration::new(row[k], 0.0)).collect::<Vec<_>>();
    let velocity = motion.velocities().map(|_| column(1));
    let values = Recording::new(column(0), motion.times().map(<[f64]>::to_vec), velocity)?;
    match motion.accelerations() {
        Some(_) => values.accelerated(column(2), motion.interpolation()),
        None => Ok(values),
    }
}

/// Returns angle, angular velocity and acceleration of the tool at the samples.
fn angles(task: &Task, joint: WristJoint, motion: &Recording, rows: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let turned =
        |of: Option<&[Configuration]>, k: usize| of.map_or(0.0, |of| WristJoint::link_2_angle(&task.arm, of[k].into()));
    let row = |(k, [value, rate, gain]): (usize, &[f64; 3])| {
        let angle = joint.tool_angle(&task.arm, motion.positions()[k].into(), *value);
        let [arm_rate, arm_gain] = [motion.velocities(), motion.accelerations()].map(|of| turned(of, k));
        [angle, arm_rate + joint.sign * rate, arm_gain + joint.sign * gain]
    };
    rows.iter().enumerate().map(row).collect()
}

fn angle_fault(
    task: &Task,
    guide: WristGuide,
    motion: &Recording,
    angles: &Recording,
    followed: &FollowedLine,
) -> Option<Fault> {
    let (kinematics, line) = (Kinematics::new(&task.arm), Line::new(&followed.path));
    let deviation = Deviation::of_line(&kinematics, &line, followed.tolerance);
    let bounds = ToolDeviation { deviation, guide }.of_pieces(&motion.pieces(), &angles.pieces());
    let (piece, off) = bounds.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let tolerance = guide.tolerance;
    (off > tolerance).then_some(Fault::ToolAngle { off, tolerance, piece })
}

/// Returns a fault for each limit that the wrist exceeds, and a fault if the wrist does not begin and end at rest.
fn limit_faults(limits: Wrist, joint: WristJoint, wrist: &Recording) -> impl Iterator<Item = Fault> {
    let own = Joint {
        joint_type: JointType::Revolute { sign: 1.0 },
        range: joint.range,
        ..Joint::turning("wrist", 0.0, 0.0).at_most(limits.velocity, limits.acceleration)
    };
    // The second component is always 0.
    let still = Joint { range: JointRange::Circle, ..own.clone() };
    limit_violations(&[own, still], wrist).into_iter().map(
        |LimitViolation { limit, allowed, value, moment, .. }| {
            let what = match limit {
                Limit::Position => "range",
                Limit::Velocity => "top speed",
                Limit::Acceleration => "greatest acceleration",
                Limit::RestAtStart | Limit::RestAtEnd => "rest at both ends of the line",
                Limit::Jerk | Limit::AccelerationJump | Limit::Torque => "limits",
            };
            Fault::WristAlongLine { what, value, allowed, sample: moment.sample }
        },
    )
}
