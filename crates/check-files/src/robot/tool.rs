//! The joints of the tool: a wrist, and one that lowers it.

use super::Robot;
use super::pose::{cross, size};
use super::tree::{Read, child, moves};
use crate::world::task::Task;
use cplan_check::arm::Arm;
use cplan_check::decimal::Decimal;
use cplan_check::interval::{BITS, Interval, Point, length, minus, sum};
use cplan_check::overlap::{Shape, overlap_by_more_than};
use cplan_check::shapes::{Body, Counted};
use cplan_check::{CheckError, Input};
use num_bigint::{BigInt, Sign};
use roxmltree::Node;

/// No object presses deeper than this share of the arm's reach into what supports it: `10^-4`.
const PRESSED: u32 = 4;

/// The tip is off the wrist's axis by no more than rounding, metres: `10^-6`.
const ON_AXIS: u32 = 6;

/// The cosine of the angle between the normal and what counts as along it is no smaller than 1 by more than `10^-9`.
const UPRIGHT: u32 = 9;

/// A bound on how deep a point is in a shape, to a part in some 10^12; 0 where it is not seen to be within.
fn depth(shape: &Shape, point: &Point) -> BigInt {
    let own = Shape { points: vec![point.clone()], radius: Interval::whole(0) };
    let mut depth = BigInt::ZERO;
    for halvings in 0..DIGITS {
        let deeper = &depth + (BigInt::from(1) << (BITS + DEEPEST - halvings));
        if overlap_by_more_than(&own, shape, &deeper) {
            depth = deeper;
        }
    }
    depth
}

/// Depths are looked for below `2^DEEPEST` metres, bit by bit.
const DEEPEST: u32 = 10;
const DIGITS: u32 = 60;

/// What it covers whichever way it is turned about a point, and what it covers at all angles.
///
/// # Errors
/// A shape that does not hold the point: it covers nothing at all angles.
fn turn_about(counted: &mut Counted, axis: &Point) -> Read<()> {
    let off = |point: &Point| length(&minus(point, axis));
    let shape = &counted.around.shape;
    let farthest = shape.points.iter().map(|p| off(p).upper).max().expect("a shape has points");
    let deepest = depth(&counted.within.shape, axis);
    if deepest.sign() != Sign::Plus {
        let message = format!(
            "{counted} turns with the wrist and does not hold its axis: give it a shape that covers it all round"
        );
        return Err(CheckError::in_file(Input::Urdf, message));
    }
    let disc = |radius: BigInt| Shape { points: vec![axis.clone()], radius: Interval::exactly(radius) };
    counted.around.shape = disc(farthest + &shape.radius.upper);
    counted.within.shape = disc(deepest);
    Ok(())
}

impl<'a> Robot<'a> {
    /// Sees to it that the joints of the tool are some, and that what the wrist turns is covered all round.
    ///
    /// # Errors
    /// Joints that are none, and shapes that do not hold the wrist's axis.
    pub(super) fn with_tool(&mut self, task: &Task) -> Read<()> {
        if let Some(name) = task.wrist.as_ref().and_then(|wrist| wrist.joint.as_deref()) {
            let (joint, carried) = self.of_the_tool(name, "wrist")?;
            let [at, axis] = [&self.arm.base, &self.arm.offset];
            let axis = minus(&self.plane.flat(&self.tree.pose(carried)?.at), &sum(at, axis));
            let off = length(&minus(&axis, &self.arm.tip.shape.points[0])).upper;
            if off > Interval::from(&Decimal::power_of_ten(ON_AXIS)).lower {
                let message = format!("the wrist's joint \"{name}\" moves the tip: its axis does not go through that");
                return Err(CheckError::in_file(Input::World, message));
            }
            for k in 0..self.arm.shapes.len() {
                let link = self.tree.order.iter().find(|link| ***link == *self.arm.shapes[k].link);
                if link.map_or(Ok(Vec::new()), |link| self.tree.above(link))?.contains(&joint) {
                    turn_about(&mut self.arm.shapes[k], &axis)?;
                }
            }
        }
        task.stroke.as_ref().map_or(Ok(()), |stroke| self.of_the_tool(&stroke.joint, "stroke").map(|_| ()))
    }

    /// A joint of the tool, and the link that it carries: it moves about the plane's normal or along it, and nothing that counts goes with it.
    fn of_the_tool(&mut self, name: &str, what: &str) -> Read<(Node<'a, 'a>, &'a str)> {
        let wrong = |why: &str| Err(CheckError::in_file(Input::World, format!("the {what}'s joint \"{name}\" {why}")));
        let found = self.tree.joints.iter().find(|(_, node)| node.attribute("name") == Some(name));
        let Some((&carried, &joint)) = found else { return wrong("is none of the robot's") };
        let axis = self.tree.pose(carried)?.direction(&self.tree.axis(joint)?);
        let along = self.plane.height(&axis).abs();
        let least = &Decimal::whole(1) - &Decimal::power_of_ten(UPRIGHT);
        let slides = joint.attribute("type") == Some("prismatic");
        let is_of_kind = moves(&joint) && slides == (what == "stroke") && child(joint, "mimic").is_none();
        if !is_of_kind || along.lower < Interval::from(&least).lower || self.moved_by(carried)? != Some(1) {
            return wrong("does not move the tool along the normal of the plane, or about it");
        }
        if !self.tree.above(self.tip_link)?.contains(&joint) {
            return wrong("does not carry the tip");
        }
        self.move_alone(&[joint])?;
        self.plane.off = size(&cross(&axis, &self.plane.normal)).upper.max(self.plane.off.clone());
        Ok((joint, carried))
    }

    /// Whether the joint that lowers the tool carries a shape: of a bar, which ends there, the tip.
    ///
    /// # Errors
    /// What is no tree.
    pub fn lowers(&self, joint: &str, shape: &Counted) -> Read<bool> {
        let is_bar = shape.kind == "bar" && shape.around.link == 1;
        let link =
            self.tree.order.iter().find(|name| if is_bar { **name == self.tip_link } else { **name == shape.link });
        let above = link.map_or(Ok(Vec::new()), |link| self.tree.above(link))?;
        Ok(above.iter().any(|node| node.attribute("name") == Some(joint)))
    }
}

/// By how much objects may press into what supports them: a share of how far the arm reaches, from the first joint to the second, and on
/// to where its shapes or the tip are.
pub fn pressed(arm: &Arm) -> Interval {
    let greatest = |link: usize, first: Interval| {
        let own = arm.shapes.iter().map(|shape| &shape.around).filter(|body| body.link == link);
        let all = own.flat_map(|body| body.shape.points.iter().map(|p| &length(p) + &body.shape.radius));
        all.fold(first, |a, b| if b.lower > a.lower { b } else { a })
    };
    let out = &length(&arm.offset) + &greatest(1, length(&arm.tip.shape.points[0]));
    let near = greatest(0, Interval::whole(0));
    &(if near.lower > out.lower { near } else { out }) * &Interval::from(&Decimal::power_of_ten(PRESSED))
}

/// A body at all heights from where it is to where it is lowered by a length.
pub fn lowered(body: &Body, by: &Decimal) -> Body {
    let by = Interval::from(by);
    let is_raised = by.lower.sign() == Sign::Minus;
    let heights = body.heights.as_ref().map(|[low, high]| {
        let [least, most] = [low - &by, high - &by];
        if is_raised { [low.clone(), most] } else { [least, high.clone()] }
    });
    Body { link: body.link, shape: body.shape.clone(), heights }
}
