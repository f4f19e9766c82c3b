//! Tip goals that are rectangles.

use super::{Arm, Goal, JointType, inverse};
use crate::space::{Configuration, GoalSet, Segment};
use cplan_geometry::Point;

impl Goal {
    /// Returns the goal in the form that suits the arm. A rectangle becomes a point, its middle, if it has no extent
    /// or if the arm does not slide along both axes.
    #[must_use]
    pub fn of_arm(self, arm: &Arm) -> Self {
        match self {
            Self::Area([low, high]) if low == high || !slides(arm) => Self::Tip((low + high) * 0.5),
            goal => goal,
        }
    }
}

/// Returns true if both joints are prismatic with different directions. Then the configurations with the tip in a
/// rectangle form a parallelogram.
fn slides(arm: &Arm) -> bool {
    match arm.joints.each_ref().map(|joint| joint.joint_type) {
        [JointType::Prismatic { direction: a }, JointType::Prismatic { direction: b }] => a.perp(&b) != 0.0,
        _ => false,
    }
}

/// Returns the goals for a tip rectangle, for an arm that slides along both axes. These are the parts of the
/// rectangle's rim within the limits, since every path from outside crosses the rim. If the tip is inside at the
/// start, the start is a goal, too.
pub fn area_goals(arm: &Arm, [low, high]: [Point; 2], start: Configuration) -> GoalSet {
    let corners = [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)];
    let places: Vec<Configuration> =
        corners.iter().filter_map(|&corner| inverse(arm, corner, start).branches.first().copied()).collect();
    let [first, second] = arm.joints.each_ref().map(|joint| joint.range.domain());
    let (lower, upper) = ([first.0, second.0], [first.1, second.1]);
    let sides = (0..places.len()).map(|k| Segment::new(places[k], places[(k + 1) % places.len()]));
    let rim = sides.filter_map(|side| side.within(lower, upper));
    let tip = arm.tip_at(start);
    let is_inside = (0..2).all(|k| (low[k]..=high[k]).contains(&tip[k]));
    rim.chain(is_inside.then(|| Segment::point(start))).collect()
}
