//! The places that the tip can reach if joints have no limits.

use cplan_check::arm::{Arm, Motion};
use cplan_check::interval::{Interval, Point, length, minus, sum};

/// Returns true if the tip certainly stays farther than `near` metres from a place, for all joint values.
pub fn is_out_of_reach(arm: &Arm, place: &Point, near: &Interval) -> bool {
    let tip = &arm.tip.shape.points[0];
    let away = minus(place, &arm.base);
    let aside = |v: &Point, along: &Point| (&(&v[0] * &along[1]) - &(&v[1] * &along[0])).abs();
    let exceeds = |a: &Interval, b: &Interval| a.lower > b.upper;
    match arm.joints.each_ref().map(|joint| &joint.motion) {
        [Motion::Turn(_), Motion::Turn(_)] => {
            let (distance, [first, second]) = (length(&away), [&arm.offset, tip].map(length));
            exceeds(&distance, &(&(&first + &second) + near)) || exceeds(&(&first - &second).abs(), &(&distance + near))
        }
        [Motion::Turn(_), Motion::Slide(along)] => {
            exceeds(&aside(&sum(&arm.offset, tip), along), &(&length(&away) + near))
        }
        [Motion::Slide(along), Motion::Turn(_)] => {
            exceeds(&aside(&minus(&away, &arm.offset), along), &(&length(tip) + near))
        }
        [Motion::Slide(_), Motion::Slide(_)] => false,
    }
}
