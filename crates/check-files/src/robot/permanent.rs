//! Shapes of the robot that meet in every configuration, as neighbours do at their joint. Their contact is ignored.

use cplan_check::arm::{Arm, Motion};
use cplan_check::decimal::Decimal;
use cplan_check::domain::{Range, Rectangle};
use cplan_check::interval::{Interval, Point, sum};
use cplan_check::mover::{Cell, MovingBody};
use cplan_check::overlap::{Shape, overlap_by_more_than};
use cplan_check::shapes::{CollisionShape, Outline};
use num_bigint::BigInt;
use std::collections::VecDeque;

/// Number of decimals of the greatest distance at which shapes count as meeting: `10^-8` m. Links often begin where
/// others end, so that the shapes only touch at some angles.
const TOUCHING_DECIMALS: u32 = 8;

/// Largest number of boxes of configurations for the test of a pair. If they do not decide, contact of the pair counts
/// as a collision.
const MAX_CELLS: usize = 4096;

/// Ignores contact between shapes that are proven to meet in every configuration.
pub(super) fn ignore_permanent_contacts(arm: &mut Arm) {
    let [shapes, bases] = [&arm.shapes, &arm.bases].map(|all| all.chunk_by(is_same_shape).collect::<Vec<_>>());
    let ignored = |layers: &&[CollisionShape]| {
        let own = uncut(layers);
        let met = bases.iter().filter(|other| is_permanent(arm, &own, &uncut(other)));
        let names: Vec<String> = met.flat_map(|other| other.iter().map(ToString::to_string)).collect();
        vec![names; layers.len()]
    };
    let ignored: Vec<Vec<String>> = shapes.iter().flat_map(ignored).collect();
    for (own, ignored) in arm.shapes.iter_mut().zip(ignored) {
        own.ignored.extend(ignored);
    }
}

/// Returns true if `other` is an obstacle for the moving shape `own`, if they certainly share heights, and if they are
/// proven to meet in every configuration.
fn is_permanent(arm: &Arm, own: &CollisionShape, other: &CollisionShape) -> bool {
    let is_obstacle = other.last.is_none() || own.last == Some(1);
    let heights = other.within.inset_heights(Outline::Within);
    is_obstacle
        && own.within.overlaps_heights(heights.as_ref())
        && (meet_at_axis(arm, own, other) || meet_in_boxes(arm, own, other))
}

/// Returns true if one shape contains a disc about the axis of the joint between them, and the other one reaches this
/// disc. Then they meet at every angle.
fn meet_at_axis(arm: &Arm, own: &CollisionShape, other: &CollisionShape) -> bool {
    let (axis, joint) = match (own.last, other.last) {
        (Some(0), None) => (arm.base.clone(), 0),
        (Some(1), Some(0)) => (sum(&arm.base, &arm.offset), 1),
        _ => return false,
    };
    let near = Interval::from(&Decimal::power_of_ten(TOUCHING_DECIMALS));
    let reaches = |shape: &Shape, axis: &Point, radius: &Interval| {
        let disc = Shape { points: vec![axis.clone()], radius: radius + &near };
        overlap_by_more_than(&disc, shape, &BigInt::ZERO)
    };
    let origin = [0, 0].map(Interval::whole);
    let sides = [(&own.within.shape, &origin), (&other.within.shape, &axis)];
    let contains_disc = |(shape, axis): (&Shape, &Point)| {
        let core = Shape { radius: Interval::whole(0), points: shape.points.clone() };
        reaches(&core, axis, &Interval::whole(0))
    };
    let meet = |[disc, other]: [(&Shape, &Point); 2]| {
        contains_disc(disc) && reaches(other.0, other.1, &Interval::exact(disc.0.radius.lower.clone()))
    };
    let turns = matches!(arm.joints[joint].motion, Motion::Turn(_));
    turns && (meet(sides) || meet([sides[1], sides[0]]))
}

/// Returns true if boxes are found that cover all configurations, and in each of which the shapes overlap. A box in
/// which they may be apart is halved. The search fails at the first box in the middle of which no overlap is proven.
fn meet_in_boxes(arm: &Arm, own: &CollisionShape, other: &CollisionShape) -> bool {
    let (mover, beside) = (MovingBody::new(arm, &own.within), other.owner());
    let cell = |ranges: &Rectangle| Cell::from(ranges).for_link(Some(&beside));
    let none = || [0, 0].map(Decimal::whole);
    let [mut first, mut second] = arm.domain.ranges.clone();
    if beside.is_carried {
        first = none();
    }
    if own.last == Some(0) {
        second = none();
    }
    let mut waiting = VecDeque::from([[first, second]]);
    for _ in 0..MAX_CELLS {
        let Some(ranges) = waiting.pop_front() else { return true };
        if mover.overlaps(&other.within.shape, &cell(&ranges)) {
            continue;
        }
        let middle = ranges.each_ref().map(|[low, high]| Decimal::middle(low, high));
        let at = |k: usize| [middle[k].clone(), middle[k].clone()];
        if !mover.overlaps(&other.within.shape, &cell(&[at(0), at(1)])) {
            return false;
        }
        let displaced = |ranges: Rectangle| mover.farthest(&cell(&ranges));
        let side = displaced([at(0), ranges[1].clone()]) > displaced([ranges[0].clone(), at(1)]);
        let half = |range: Range| {
            let mut half = ranges.clone();
            half[usize::from(side)] = range;
            half
        };
        let ([low, high], middle) = (ranges[usize::from(side)].clone(), middle[usize::from(side)].clone());
        waiting.extend([half([low, middle.clone()]), half([middle, high])]);
    }
    false
}

/// Returns true if two shapes are layers of one mesh.
fn is_same_shape(a: &CollisionShape, b: &CollisionShape) -> bool {
    (&a.link, a.kind, a.number) == (&b.link, b.kind, b.number)
}

/// Returns the mesh that consists of these layers, ordered from the lowest to the highest. Its shape is the convex hull.
fn uncut(layers: &[CollisionShape]) -> CollisionShape {
    let mut whole = layers[0].clone();
    for layer in &layers[1..] {
        whole.within.shape.points.extend_from_slice(&layer.within.shape.points);
        if let (Some([_, top]), Some([_, upper])) = (&mut whole.within.heights, &layer.within.heights) {
            top.clone_from(upper);
        }
    }
    whole
}
