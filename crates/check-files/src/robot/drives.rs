//! Limits of motors, converted to limits of joints and of a sum of both joint values.

use crate::world::drives::Drives;
use cplan_check::arm::Joint;
use cplan_check::domain::{Axis, Range};
use cplan_check::joint_sum::JointSum;
use num_bigint::Sign;

/// Narrows the ranges of both joints to the limits of their motors. Returns the limits of the sum of both joint values, if
/// the elbow's motor is mounted on the base.
pub fn narrow(drives: &Drives, joints: &mut [Joint; 2]) -> Option<JointSum> {
    let [of_first, of_elbow] = drives.limits.clone()?;
    narrow_joint(&mut joints[0], of_first);
    if drives.ratio.sign() == Sign::NoSign {
        narrow_joint(&mut joints[1], of_elbow);
        return None;
    }
    let (Axis::Line(outer), Some(inner)) = (&joints[0].axis, &joints[0].within) else { return None };
    // The range of joint 2 contains all values with which the sum is allowed for some value of joint 1.
    let turned = |first: &Range| {
        let mut turned = first.each_ref().map(|q1| &drives.ratio * q1);
        turned.sort();
        turned
    };
    let ([least, most], [low, high]) = (turned(outer), turned(inner));
    let [lower, upper] = &of_elbow;
    let second = [[&lower[0] - &most, &lower[1] - &high], [&upper[0] - &low, &upper[1] - &least]];
    narrow_joint(&mut joints[1], second);
    Some(JointSum { ratio: drives.ratio.clone(), limits: of_elbow })
}

/// Narrows the range of a joint to limits, given as enclosures.
fn narrow_joint(joint: &mut Joint, [lower, upper]: [Range; 2]) {
    let ([least, low], [high, most]) = (lower, upper);
    let (outer, inner) = match (&joint.axis, &joint.within) {
        (Axis::Line([from, to]), Some([start, end])) => {
            ([from.clone().max(least), to.clone().min(most)], [start.clone().max(low), end.clone().min(high)])
        }
        _ => ([least, most], [low, high]),
    };
    (joint.axis, joint.within) = (Axis::Line(outer), Some(inner));
}
