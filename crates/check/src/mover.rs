//! Positions of the arm's shapes, and bounds on their displacement.

use crate::arm::{Arm, Motion};
use crate::decimal::Decimal;
use crate::domain::{Range, Rectangle};
use crate::interval::{BITS, Interval, Point, both_turns, length, rough, roughly, sum, times, turned};
use crate::overlap::{Shape, overlap_by_more_than, seem_to_overlap};
use crate::shapes::{Body, Owner};
use num_bigint::BigInt;
use std::cell::RefCell;

/// A box of configurations, given by its middle and half the length of each side.
#[derive(Clone)]
pub struct Cell {
    middle: [Interval; 2],
    half: [Interval; 2],
}

impl Cell {
    /// Returns the box in which contact with an obstacle is tested. If joint 1 carries `link`, this is the same box
    /// with joint 1 at zero. Otherwise, the box is unchanged. `None` stands for an obstacle of the world.
    pub fn for_link(mut self, link: Option<&Owner>) -> Self {
        if link.is_some_and(|link| link.is_carried) {
            (self.middle[0], self.half[0]) = (Interval::whole(0), Interval::whole(0));
        }
        self
    }

    /// Returns the box around the part of a straight segment from `k / 2^cuts` to `(k + 1) / 2^cuts` of its length.
    pub fn of_segment(from: &Point, along: &Point, k: i64, cuts: u32) -> Self {
        let middle = sum(from, &times(along, &Interval::exact(BigInt::from(2 * k + 1) << (BITS - cuts - 1))));
        Self { middle, half: along.each_ref().map(|along| along.abs().in_halves(cuts + 1)) }
    }
}

impl From<&Rectangle> for Cell {
    fn from(ranges: &Rectangle) -> Self {
        let middle = ranges.each_ref().map(|[low, high]| Interval::from(&Decimal::middle(low, high)));
        let half = ranges.each_ref().map(|[low, high]| Interval::from(&(high - low)).half());
        Self { middle, half }
    }
}

/// Returns an upper bound on the displacement of a point at distance 1 from an axis, for turns by up to an angle. This
/// is the length of the chord, which grows with the angle up to half a turn.
fn chord(angle: &Interval) -> Interval {
    if angle.upper >= Interval::pi().lower {
        return Interval::whole(2);
    }
    if angle.upper < Interval::whole(1).in_halves(4).lower {
        // The terms of the series alternate in sign, so the partial sum is an upper bound.
        let square = angle * angle;
        let cubed = (&square * angle).over(24);
        return &(angle - &cubed) + &(&cubed * &square).over(80);
    }
    let sine = &angle.half().sin_cos()[0];
    sine + sine
}

impl Arm {
    /// Returns the motion by a joint at a value: sine and cosine of the turn, and the translation.
    fn displaced(&self, joint: usize, value: &Interval) -> [Point; 2] {
        let [none, one] = [0, 1].map(Interval::whole);
        match &self.joints[joint].motion {
            Motion::Turn(sign) => [(value * &Interval::whole(*sign)).sin_cos(), [none.clone(), none]],
            Motion::Slide(direction) => [[none, one], times(direction, value)],
        }
    }
}

/// A body, with the data about its position and displacement that do not depend on the box.
pub struct MovingBody<'a> {
    arm: &'a Arm,
    body: &'a Body,
    /// Corners of the body in floating point, for quick guesses.
    rough: Vec<[f64; 2]>,
    /// Latest value of joint 1, with the motion at this value. Many consecutive boxes share them.
    first: RefCell<(Interval, [Point; 2])>,
    /// Distance of the second joint from the first.
    offset: Interval,
    /// Greatest distance of the body's points from the last joint that moves the body.
    reach: Interval,
}

/// Returns the greatest length of some vectors.
fn reach(points: &[Point]) -> Interval {
    points.iter().map(|p| length(p).upper).max().map_or(Interval::whole(0), Interval::exact)
}

impl<'a> MovingBody<'a> {
    /// Prepares a body that an arm moves.
    pub fn new(arm: &'a Arm, body: &'a Body) -> Self {
        let zero = Interval::whole(0);
        let first = RefCell::new((zero.clone(), arm.displaced(0, &zero)));
        let rough = body.shape.points.iter().map(rough).collect();
        Self { arm, body, rough, first, offset: length(&arm.offset), reach: reach(&body.shape.points) }
    }

    /// Returns the body's shape in the middle of a box, in plane coordinates.
    fn placed(&self, cell: &Cell) -> Shape {
        let Self { arm, body, first, .. } = self;
        let (value, first) = &mut *first.borrow_mut();
        if *value != cell.middle[0] {
            (*value, *first) = (cell.middle[0].clone(), arm.displaced(0, &cell.middle[0]));
        }
        let [turn, at] = match body.link {
            0 => first.clone(),
            _ => {
                let [turn, at] = arm.displaced(1, &cell.middle[1]);
                [both_turns(&first[0], &turn), sum(&turned(&sum(&arm.offset, &at), &first[0]), &first[1])]
            }
        };
        let origin = sum(&arm.base, &at);
        let point = |p: &Point| sum(&origin, &turned(p, &turn));
        Shape { points: body.shape.points.iter().map(point).collect(), radius: body.shape.radius.clone() }
    }

    /// Returns an upper bound on the displacement of the body's points from their positions in the middle of a box,
    /// while the joints stay within the box.
    ///
    /// It suffices to bound the displacement of the corners, because no point of a convex hull moves farther than every corner.
    pub fn farthest(&self, cell: &Cell) -> BigInt {
        let Self { arm, body, offset, reach: own, .. } = self;
        let half = &cell.half;
        let slid = |k: usize, direction: &Point| &length(direction) * &half[k];
        let bound = match (&arm.joints[0].motion, (body.link == 1).then_some(&arm.joints[1].motion)) {
            (Motion::Turn(_), None) => own * &chord(&half[0]),
            (Motion::Slide(direction), None) => slid(0, direction),
            (Motion::Turn(_), Some(Motion::Turn(_))) => {
                &(offset * &chord(&half[0])) + &(own * &chord(&(&half[0] + &half[1])))
            }
            (Motion::Turn(_), Some(Motion::Slide(direction))) => {
                // Move joint 2 first, and then turn by joint 1. At one end of the slide, the turn moves points the
                // most, because distance is convex.
                let slide = [&cell.middle[1] - &half[1], &cell.middle[1] + &half[1]];
                let ends = slide.map(|value| sum(&arm.offset, &times(direction, &value)));
                let points = &body.shape.points;
                let out: Vec<Point> = ends.iter().flat_map(|end| points.iter().map(move |p| sum(end, p))).collect();
                &slid(1, direction) + &(&reach(&out) * &chord(&half[0]))
            }
            (Motion::Slide(direction), Some(Motion::Turn(_))) => &slid(0, direction) + &(own * &chord(&half[1])),
            (Motion::Slide(first), Some(Motion::Slide(second))) => &slid(0, first) + &slid(1, second),
        };
        bound.upper
    }

    /// Returns true if the body is proven to overlap a shape in the whole box.
    pub fn overlaps(&self, shape: &Shape, cell: &Cell) -> bool {
        let farthest = self.farthest(cell);
        self.seems_to_overlap(shape, cell, &farthest) && overlap_by_more_than(&self.placed(cell), shape, &farthest)
    }

    /// Guesses in floating point whether the exact test can succeed. A wrong guess costs only time, or makes the answer
    /// inconclusive.
    fn seems_to_overlap(&self, shape: &Shape, cell: &Cell, farthest: &BigInt) -> bool {
        let mut placed = self.rough.clone();
        for joint in (0..=self.body.link).rev() {
            let value = roughly(&cell.middle[joint].lower);
            let [x, y] = rough([&self.arm.base, &self.arm.offset][joint]);
            match &self.arm.joints[joint].motion {
                Motion::Turn(sign) => {
                    let (sine, cosine) = (value * f64::from(*sign)).sin_cos();
                    placed.iter_mut().for_each(|[a, b]| {
                        [*a, *b] = [x + cosine * *a - sine * *b, y + sine * *a + cosine * *b];
                    });
                }
                Motion::Slide(direction) => {
                    let [u, v] = rough(direction);
                    placed.iter_mut().for_each(|[a, b]| [*a, *b] = [x + value * u + *a, y + value * v + *b]);
                }
            }
        }
        let needed = farthest - &self.body.shape.radius.lower - &shape.radius.lower;
        seem_to_overlap(&placed, &shape.points.iter().map(rough).collect::<Vec<_>>(), roughly(&needed))
    }
}

impl Arm {
    /// Returns rectangles that contain all configurations which put the tip at a position. Configurations in rectangles
    /// that `is_left_out` excludes need not be contained.
    ///
    /// The domain is cut into four rectangles again and again. A rectangle is dropped if it is excluded. It is also
    /// dropped if the tip, at its middle, is farther from the position than it can move within the rectangle. Cutting
    /// stops when there would be more than `most` rectangles. Rectangles that touch are merged.
    pub fn places(&self, place: &Point, most: usize, is_left_out: impl Fn(&Rectangle) -> bool) -> Vec<Rectangle> {
        let mover = MovingBody::new(self, &self.tip);
        let is_far = |rectangle: &Rectangle| {
            let cell = Cell::from(rectangle);
            let at = &mover.placed(&cell).points[0];
            length(&[&at[0] - &place[0], &at[1] - &place[1]]).lower > mover.farthest(&cell)
        };
        let halves = |[low, high]: &Range| {
            let middle = Decimal::middle(low, high);
            [[low.clone(), middle.clone()], [middle, high.clone()]]
        };
        let mut parts = vec![self.domain.ranges.clone()];
        for _ in 0..MAX_DOMAIN_CUTS {
            let mut smaller = Vec::new();
            for part in &parts {
                let [first, second] = part.each_ref().map(halves);
                let four = first.iter().flat_map(|a| second.iter().map(move |b| [a.clone(), b.clone()]));
                smaller.extend(four.filter(|part| !is_left_out(part) && !is_far(part)));
            }
            if smaller.len() > most {
                break;
            }
            parts = smaller;
        }
        let mut merged: Vec<Rectangle> = Vec::new();
        for mut part in parts {
            while let Some(other) = merged.iter().position(|other| (0..2).all(|k| touch(&other[k], &part[k]))) {
                let other = merged.swap_remove(other);
                part = [0, 1].map(|k| hull(&part[k], &other[k]));
            }
            merged.push(part);
        }
        merged
    }
}

/// Returns true if two ranges have a number in common.
fn touch(a: &Range, b: &Range) -> bool {
    a[0] <= b[1] && b[0] <= a[1]
}

/// Returns the smallest range that contains two ranges.
fn hull(a: &Range, b: &Range) -> Range {
    [(&a[0]).min(&b[0]).clone(), (&a[1]).max(&b[1]).clone()]
}

/// Maximum number of times that the domain is cut in the search for configurations of a tip position. The last
/// rectangles are `10^-12` of the domain along each joint.
const MAX_DOMAIN_CUTS: u32 = 40;
