//! Passages of moving objects through the reach of the arm.

use cplan_geometry::{Interval, Point};
use cplan_handling::{Object, ObstacleTrajectory, TrajectoryLeg};
use cplan_model::space::JointRange;
use cplan_model::{Arm, JointType};

/// Fraction by which radii are enlarged, to make up for rounding.
const RADIUS_ENLARGEMENT: f64 = 1e-9;

/// An interval of time in which an object may be within reach, on one leg of its trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Passage {
    pub times: Interval,
    /// True if the object does not move during the passage.
    pub is_still: bool,
}

/// Number of parts into which a passage is cut. The moments between the parts are tried.
const PARTS_PER_PASSAGE: usize = 24;

impl Passage {
    /// Returns moments throughout the passage, or a single one if the object does not move.
    pub fn moments(&self) -> Vec<f64> {
        let [from, to] = self.times;
        let parts = if self.is_still || from == to { 0 } else { PARTS_PER_PASSAGE };
        (0..=parts)
            .map(|k| from + if k == 0 { 0.0 } else { (to - from) * (k as f64 / PARTS_PER_PASSAGE as f64) })
            .collect()
    }
}

/// Returns the passages, in order, during which a moving object may be picked at its point `grasp`, not before the time
/// `from`. At all other times the point is certainly out of the arm's reach, or the object must not be picked. `when`
/// lists the allowed times; if it is empty, all times are allowed.
pub(super) fn passages(arm: &Arm, object: &Object, grasp: Point, when: &[Interval], from: f64) -> Vec<Passage> {
    let legs = object.trajectory.as_ref().map_or(&[][..], ObstacleTrajectory::legs);
    let reach = (tip_reach(arm) + grasp.norm()) * (1.0 + RADIUS_ENLARGEMENT);
    let any = [[0.0, f64::INFINITY]];
    let when = if when.is_empty() { &any[..] } else { when };
    let mut all = Vec::new();
    for leg in legs {
        let Some([first, last]) = times_in_disc(leg, arm.base, reach) else { continue };
        for [begins, ends] in when {
            let times = [first.max(*begins).max(from), last.min(*ends)];
            if times[0] <= times[1] {
                all.push(Passage { times, is_still: leg.is_still() });
            }
        }
    }
    all
}

/// Returns an upper bound on the distance of the tip from the base, in metres.
fn tip_reach(arm: &Arm) -> f64 {
    let extents = [arm.offset.norm(), arm.tip.norm()];
    let of = |(joint, extent): (usize, f64)| {
        let joint = &arm.joints[joint];
        match (joint.joint_type, joint.range) {
            (JointType::Revolute { .. }, _) => extent,
            (JointType::Prismatic { .. }, JointRange::Interval { lower, upper }) => {
                extent + lower.abs().max(upper.abs())
            }
            (JointType::Prismatic { .. }, JointRange::Circle) => f64::INFINITY,
        }
    };
    extents.into_iter().enumerate().map(of).sum()
}

/// Returns the times of a leg during which the origin of the object's frame is in a disc. `None` if there are none.
fn times_in_disc(leg: &TrajectoryLeg, center: Point, radius: f64) -> Option<Interval> {
    let (extent, speed) = (center - leg.start.at, leg.velocity.norm());
    if speed == 0.0 || radius == f64::INFINITY {
        return (extent.norm() <= radius).then_some([leg.from, leg.to]);
    }
    let along = leg.velocity.dot(&extent) / speed;
    let beside2 = extent.norm_squared() - along * along;
    let half = (radius * radius - beside2).max(0.0).sqrt();
    let times = [leg.from + (along - half) / speed, leg.from + (along + half) / speed];
    let both = [times[0].max(leg.from), times[1].min(leg.to)];
    (beside2 <= radius * radius && both[0] <= both[1]).then_some(both)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::Vector;

    #[test]
    fn a_belt_crosses_a_disc() {
        let trajectory = ObstacleTrajectory::conveyor([1.0, -3.0], [0.0, 0.5]).unwrap();
        let times = times_in_disc(&trajectory.legs()[0], Point::zeros(), 2.0_f64.sqrt()).unwrap();
        assert!((times[0] - 4.0).abs() < 1e-12 && (times[1] - 8.0).abs() < 1e-12, "{times:?}");
        assert_eq!(times_in_disc(&trajectory.legs()[0], Point::zeros(), 0.9), None);
        let away = ObstacleTrajectory::conveyor([1.0, 3.0], [0.0, 0.5]).unwrap();
        assert_eq!(times_in_disc(&away.legs()[0], Point::zeros(), 2.0), None);
    }

    #[test]
    fn resting_objects_stay_in_reach_for_ever() {
        let stop = |time, x| cplan_handling::Stop { time, at: Point::new(x, 0.0), angle: 0.0 };
        let trajectory = ObstacleTrajectory::new(vec![stop(0.0, 9.0), stop(8.0, 1.0)], Vector::zeros()).unwrap();
        let last = trajectory.legs()[1];
        assert_eq!(times_in_disc(&last, Point::zeros(), 2.0), Some([8.0, f64::INFINITY]));
    }
}
