//! The joints of the tool: a wrist, and a stroke that lowers it.

use super::Robot;
use super::pose::{cross, size};
use super::tree::{ReadResult, child, moves};
use crate::world::task::Task;
use cplan_check::arm::Arm;
use cplan_check::decimal::Decimal;
use cplan_check::interval::{BITS, Interval, Point, length, minus, sum};
use cplan_check::overlap::{Shape, overlap_by_more_than};
use cplan_check::shapes::{Body, CollisionShape};
use cplan_check::{CheckError, Input};
use num_bigint::{BigInt, Sign};
use roxmltree::Node;

/// Number of decimals of the greatest depth to which an object may press into its support, as a share of the arm's
/// reach: `10^-4`.
const PENETRATION_DECIMALS: u32 = 4;

/// Number of decimals of the maximum distance of the tip from the wrist's axis: `10^-6` m, for rounding in the URDF.
const ON_AXIS_DECIMALS: u32 = 6;

/// Number of decimals of the tolerance of axes along the normal. The cosine of the angle between axis and normal is at
/// least `1 - 10^-9`.
const UPRIGHT_DECIMALS: u32 = 9;

/// Returns a lower bound on the depth of a point in a shape, with a relative error of about `10^-12`. Returns 0 if the
/// point is not certainly inside.
fn depth(shape: &Shape, point: &Point) -> BigInt {
    let own = Shape { points: vec![point.clone()], radius: Interval::whole(0) };
    let mut depth = BigInt::ZERO;
    for halvings in 0..DEPTH_BITS {
        let deeper = &depth + (BigInt::from(1) << (BITS + MAX_DEPTH_BITS - halvings));
        if overlap_by_more_than(&own, shape, &deeper) {
            depth = deeper;
        }
    }
    depth
}

/// Binary logarithm of the greatest depth that the search finds, metres. It finds one binary digit after another.
const MAX_DEPTH_BITS: u32 = 10;
const DEPTH_BITS: u32 = 60;

/// Replaces both approximations of a shape by discs about a point. In all orientations, the outer disc covers the
/// shape, and the shape covers the inner disc.
///
/// # Errors
/// If the shape does not contain the point, because then there is no inner disc.
fn turn_about(counted: &mut CollisionShape, axis: &Point) -> ReadResult<()> {
    let off = |point: &Point| length(&minus(point, axis));
    let shape = &counted.around.shape;
    let farthest = shape.points.iter().map(|p| off(p).upper).max().expect("a shape has points");
    let deepest = depth(&counted.within.shape, axis);
    if deepest.sign() != Sign::Plus {
        let message = format!(
            "{counted} turns with the wrist, but does not contain the wrist's axis; use a shape that covers all angles"
        );
        return Err(CheckError::in_file(Input::Urdf, message));
    }
    let disc = |radius: BigInt| Shape { points: vec![axis.clone()], radius: Interval::exact(radius) };
    counted.around.shape = disc(farthest + &shape.radius.upper);
    counted.within.shape = disc(deepest);
    Ok(())
}

impl<'a> Robot<'a> {
    /// Checks the joints of the tool, and replaces the shapes that the wrist turns by discs.
    ///
    /// # Errors
    /// If a joint is not suitable for the tool, or if a shape does not contain the wrist's axis.
    pub(super) fn with_tool(&mut self, task: &Task) -> ReadResult<()> {
        if let Some(name) = task.wrist.as_ref().and_then(|wrist| wrist.joint.as_deref()) {
            let (joint, carried) = self.of_the_tool(name, "wrist")?;
            let [at, axis] = [&self.arm.base, &self.arm.offset];
            let axis = minus(&self.plane.flat(&self.tree.pose(carried)?.at), &sum(at, axis));
            let off = length(&minus(&axis, &self.arm.tip.shape.points[0])).upper;
            if off > Interval::from(&Decimal::power_of_ten(ON_AXIS_DECIMALS)).lower {
                let message = format!(
                    "the wrist's joint \"{name}\" moves the tip, because its axis does not pass through the tip"
                );
                return Err(CheckError::in_file(Input::World, message));
            }
            for k in 0..self.arm.shapes.len() {
                let link = self.tree.order.iter().find(|link| ***link == *self.arm.shapes[k].link);
                if link.map_or(Ok(Vec::new()), |link| self.tree.joints_above(link))?.contains(&joint) {
                    turn_about(&mut self.arm.shapes[k], &axis)?;
                }
            }
        }
        task.stroke.as_ref().map_or(Ok(()), |stroke| self.of_the_tool(&stroke.joint, "stroke").map(|_| ()))
    }

    /// Returns a joint of the tool, and the link that it carries. The joint must carry the tip, and its axis must be
    /// along the plane's normal. Joints that mimic it must carry neither shapes nor the tip.
    fn of_the_tool(&mut self, name: &str, what: &str) -> ReadResult<(Node<'a, 'a>, &'a str)> {
        let wrong = |why: &str| Err(CheckError::in_file(Input::World, format!("the {what}'s joint \"{name}\" {why}")));
        let found = self.tree.joints.iter().find(|(_, node)| node.attribute("name") == Some(name));
        let Some((&carried, &joint)) = found else { return wrong("does not exist in the robot") };
        let axis = self.tree.pose(carried)?.direction(&self.tree.axis(joint)?);
        let along = self.plane.height(&axis).abs();
        let least = &Decimal::whole(1) - &Decimal::power_of_ten(UPRIGHT_DECIMALS);
        let slides = joint.attribute("type") == Some("prismatic");
        let is_of_kind = moves(&joint) && slides == (what == "stroke") && child(joint, "mimic").is_none();
        if !is_of_kind || along.lower < Interval::from(&least).lower || self.moving_joint(carried)? != Some(1) {
            return wrong("does not move the tool along the normal of the plane, or about it");
        }
        if !self.tree.joints_above(self.tip_link)?.contains(&joint) {
            return wrong("does not carry the tip");
        }
        self.check_independence(&[joint])?;
        self.plane.off = size(&cross(&axis, &self.plane.normal)).upper.max(self.plane.off.clone());
        Ok((joint, carried))
    }

    /// Returns the joint of the stroke as an axis of heights.
    ///
    /// # Errors
    /// If the links do not form a tree.
    pub fn lift_axis(&self, joint: &str) -> ReadResult<LiftAxis> {
        let found = self.tree.joints.iter().find(|(_, node)| node.attribute("name") == Some(joint));
        let (carried, node) = found.expect("the reader of the robot has found this joint");
        let axis = self.tree.pose(carried)?.direction(&self.tree.axis(*node)?);
        let is_upward = self.plane.height(&axis).lower.sign() == Sign::Plus;
        Ok(LiftAxis { is_upward, raised: self.tree.values.get(joint).cloned().unwrap_or(Interval::whole(0)) })
    }

    /// Returns true if `joint`, which lowers the tool, carries a shape. It carries a bar if it carries the tip, at
    /// which the bar ends.
    ///
    /// # Errors
    /// If the links do not form a tree.
    pub fn lowers(&self, joint: &str, shape: &CollisionShape) -> ReadResult<bool> {
        let is_bar = shape.kind == "bar" && shape.around.link == 1;
        let link =
            self.tree.order.iter().find(|name| if is_bar { **name == self.tip_link } else { **name == shape.link });
        let above = link.map_or(Ok(Vec::new()), |link| self.tree.joints_above(link))?;
        Ok(above.iter().any(|node| node.attribute("name") == Some(joint)))
    }
}

/// Returns the depth to which objects may press into their supports: a share of the arm's reach. The reach is the
/// distance from the first joint to the second, plus the greatest distance of a shape or the tip from the second joint.
pub fn penetration_depth_allowed(arm: &Arm) -> Interval {
    let greatest = |link: usize, first: Interval| {
        let own = arm.shapes.iter().map(|shape| &shape.around).filter(|body| body.link == link);
        let all = own.flat_map(|body| body.shape.points.iter().map(|p| &length(p) + &body.shape.radius));
        all.fold(first, |a, b| if b.lower > a.lower { b } else { a })
    };
    let out = &length(&arm.offset) + &greatest(1, length(&arm.tip.shape.points[0]));
    let near = greatest(0, Interval::whole(0));
    &(if near.lower > out.lower { near } else { out }) * &Interval::from(&Decimal::power_of_ten(PENETRATION_DECIMALS))
}

/// The joint of a stroke, as an axis of heights.
pub struct LiftAxis {
    /// True if greater values of the joint raise the tool.
    is_upward: bool,
    /// Value of the joint with the tool raised.
    raised: Interval,
}

impl LiftAxis {
    /// Converts a displacement or a velocity of the joint to one along the plane's normal.
    pub fn upward(&self, along: &Interval) -> Interval {
        if self.is_upward { along.clone() } else { -along }
    }

    /// Returns the height of the tool above its raised position, at a value of the joint.
    pub fn height(&self, value: &Decimal) -> Interval {
        self.upward(&(&Interval::from(value) - &self.raised))
    }
}

/// Returns the least and the greatest height, relative to the raised tool, of a tool that is lowered by a length.
pub fn swept_heights(by: &Decimal) -> [Decimal; 2] {
    let [raised, lowered] = [Decimal::whole(0), -by];
    if lowered < raised { [lowered, raised] } else { [raised, lowered] }
}

/// Returns the least and the greatest height of a tool that moves between its raised position and a height. All heights
/// are relative to the raised position.
pub fn heights_to(height: &Interval) -> [Decimal; 2] {
    let zero = BigInt::ZERO;
    Interval { lower: height.lower.clone().min(zero.clone()), upper: height.upper.clone().max(zero) }.ends()
}

/// Extends the heights of a shape to all heights that it has while the tool is in a range above its raised position.
/// One end of a bar stays at its height, so a bar also keeps its own heights.
pub fn displaced(shape: &CollisionShape, [least, most]: &[Decimal; 2]) -> Body {
    let body = &shape.around;
    let zero = Decimal::whole(0);
    let is_bar = shape.kind == "bar";
    let least = Interval::from(if is_bar { least.min(&zero) } else { least });
    let most = Interval::from(if is_bar { most.max(&zero) } else { most });
    let heights = body.heights.as_ref().map(|[low, high]| [low + &least, high + &most]);
    Body { link: body.link, shape: body.shape.clone(), heights }
}
