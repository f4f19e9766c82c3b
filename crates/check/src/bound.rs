//! Proof that no motion is shorter than some length.
//!
//! A wall is a straight segment of configurations. In all of them, a shape is too near a part of an obstacle. A
//! shortest path around walls consists of straight legs between *corners*, the ends of walls. Each corner has a
//! *potential*: a claimed lower bound on the length of any path from the start to the corner. For each leg that crosses
//! no wall, the check shows that the potential grows along the leg by at most the leg's length.

mod metric;
mod places;
mod plane;

use crate::arm::{Arm, Motion};
use crate::certificate::{Certificate, Wall, rectangles};
use crate::contacts::{Contacts, Pair};
use crate::domain::{Rectangle, within};
use crate::ends::{End, MAX_LOCATED_PARTS};
use crate::error::{CheckError, Input};
use crate::interval::{Interval, minus};
use crate::mover::{self, MovingBody};
use crate::world::World;
use plane::Plane;

/// Maximum number of overlap tests along a wall. If they do not suffice, the wall is not proven.
const MAX_OVERLAP_TESTS: usize = 20_000;

/// Maximum number of times that a wall is halved.
const MAX_WALL_HALVINGS: u32 = 60;

/// Checks that no motion is shorter than the certificate's length. The motions lead from the start to the goal, or to
/// the configuration that the certificate states instead.
pub fn no_shorter(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    let Some(bound) = &certificate.bound else {
        return Err(CheckError::in_file(Input::Certificate, "it has no bound"));
    };
    let start = End::start(certificate, world)?;
    let stuck = certificate.boxes.as_deref().unwrap_or_default();
    let boxes = rectangles(stuck)?;
    let (goals, to) = match &bound.to {
        Some([a, b]) => {
            let at = arm.configuration("bound", &[[a.clone(), a.clone()], [b.clone(), b.clone()]])?;
            (vec![at], format!(" ({a}, {b})"))
        }
        None => {
            let goal = End::goal(certificate, world)?;
            let is_collision = |part: &Rectangle| boxes.iter().any(|stuck| within(part, stuck));
            (goal.places(arm, MAX_LOCATED_PARTS, is_collision)?, format!(" the goal{}", goal.named(arm)))
        }
    };
    bound.metric.is_a_norm()?;
    let axes = arm.joints.each_ref().map(|joint| &joint.axis);
    let plane = Plane::new(bound, axes, &start.configuration(arm)?, &goals)?;
    plane.check_potentials(&plane.corners(bound, axes)?)?;
    let contacts = Contacts::new(arm, world, certificate, certificate.clearance(world)?)?;
    contacts.check_boxes(arm, stuck, &boxes)?;
    for (number, wall) in bound.walls.iter().enumerate() {
        if !closes(arm, wall, &contacts.pair(wall.shape, wall.part, || format!("wall {number}"))?) {
            return CheckError::fails(format!("wall {number}: the shape does not touch the part along the whole wall"));
        }
    }
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let (start, clearance, length) = (start.named(arm), certificate.clearance(world)?, &bound.length);
    let metric = &bound.metric;
    Ok(format!(
        "no motion of \"{first}\" and \"{second}\" from the start{start} to{to} with clearance {clearance} is shorter than {length}{metric}"
    ))
}

/// Returns true if a shape and a part are proven to overlap along a whole wall. The wall is halved until the overlap is
/// proven for a box around each piece, or until there are too many tests.
///
/// If the joints move a shape along the wall without turning it, the configurations in which the shape overlaps the
/// part form a convex set. Then tests at the ends of the wall suffice.
fn closes(arm: &Arm, wall: &Wall, &Pair { body, part, beside }: &Pair) -> bool {
    let [from, to] = [&wall.from, &wall.to].map(|end| end.each_ref().map(Interval::from));
    let along = minus(&to, &from);
    let cell = |from, along, k, cuts| mover::Cell::of_segment(from, along, k, cuts).for_link(beside);
    let mover = MovingBody::new(arm, body);
    let turns = |k: usize| wall.from[k] != wall.to[k] && matches!(arm.joints[k].motion, Motion::Turn(_));
    if !(0..=body.link).any(turns) {
        let still = [0, 1].map(|_| Interval::whole(0));
        return [from, to].iter().all(|end| mover.overlaps(part, &cell(end, &still, 0, 0)));
    }
    let (mut left, mut last) = (vec![(0, 0)], 0);
    for _ in 0..MAX_OVERLAP_TESTS {
        let Some((k, cuts)) = left.pop() else { return true };
        // A piece that is much longer than the previous one is not tested, because the test would probably fail.
        if cuts + 1 >= last && mover.overlaps(part, &cell(&from, &along, k, cuts)) {
            last = cuts;
        } else if cuts < MAX_WALL_HALVINGS {
            left.extend([2 * k + 1, 2 * k].map(|k| (k, cuts + 1)));
        } else {
            return false;
        }
    }
    false
}
