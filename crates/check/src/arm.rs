//! Where the arm's shapes are, and how far they can move.

use crate::decimal::Decimal;
use crate::interval::{Interval, Point, length, sum, times, turned};
use crate::overlap::Shape;
use crate::robot::{Arm, Body, Motion};
use crate::sweep::{Domain, Range, Rectangle};
use num_bigint::BigInt;

/// A box of configurations by its middle and half its sides.
pub struct Cell {
    middle: [Interval; 2],
    half: [Interval; 2],
}

impl From<&Rectangle> for Cell {
    fn from(ranges: &Rectangle) -> Self {
        let middle = ranges.each_ref().map(|[low, high]| Interval::from(&Decimal::middle(low, high)));
        let half = ranges.each_ref().map(|[low, high]| Interval::from(&(high - low)).half());
        Self { middle, half }
    }
}

/// What moves by no more than this when it turns by up to an angle at distance 1: the chord, which grows until half a turn.
fn chord(angle: &Interval) -> Interval {
    if angle.upper >= Interval::pi().lower {
        return Interval::whole(2);
    }
    let sine = &angle.half().sin_cos()[0];
    sine + sine
}

impl Arm<'_> {
    /// A body's shape in the middle of a box, in plane coordinates.
    pub fn placed(&self, body: &Body, cell: &Cell) -> Shape {
        let moved = |k: usize| {
            let value = &cell.middle[k];
            match &self.joints[k].motion {
                Motion::Turn(sign) => Moved::Turn((value * &Interval::whole(*sign)).sin_cos()),
                Motion::Slide(direction) => Moved::Slide(times(direction, value)),
            }
        };
        let first = moved(0);
        let second = (body.link == 1).then(|| moved(1));
        let point = |p: &Point| {
            let carried = second.as_ref().map_or_else(|| p.clone(), |second| sum(&self.offset, &second.apply(p)));
            sum(&self.base, &first.apply(&carried))
        };
        Shape { points: body.shape.points.iter().map(point).collect(), radius: body.shape.radius.clone() }
    }

    /// No point of a body is farther than this from where it is in the middle of a box, while the joints stay within the box.
    ///
    /// Of a convex hull it is a corner that moves farthest: where a point is depends on it affinely.
    pub fn farthest(&self, body: &Body, cell: &Cell) -> BigInt {
        let half = &cell.half;
        let slid = |k: usize, direction: &Point| &length(direction) * &half[k];
        let reach = |points: &[Point]| {
            points.iter().map(|p| length(p).upper).max().map_or(Interval::whole(0), Interval::exactly)
        };
        let points = &body.shape.points;
        let bound = match (&self.joints[0].motion, (body.link == 1).then_some(&self.joints[1].motion)) {
            (Motion::Turn(_), None) => &reach(points) * &chord(&half[0]),
            (Motion::Slide(direction), None) => slid(0, direction),
            (Motion::Turn(_), Some(Motion::Turn(_))) => {
                let second = &reach(points) * &chord(&(&half[0] + &half[1]));
                &(&length(&self.offset) * &chord(&half[0])) + &second
            }
            (Motion::Turn(_), Some(Motion::Slide(direction))) => {
                // The second joint first, then the turn at the farther of the ends of the slide: distance is convex.
                let slide = [&cell.middle[1] - &half[1], &cell.middle[1] + &half[1]];
                let ends = slide.map(|value| sum(&self.offset, &times(direction, &value)));
                let out: Vec<Point> = ends.iter().flat_map(|end| points.iter().map(move |p| sum(end, p))).collect();
                &slid(1, direction) + &(&reach(&out) * &chord(&half[0]))
            }
            (Motion::Slide(direction), Some(Motion::Turn(_))) => {
                &slid(0, direction) + &(&reach(points) * &chord(&half[1]))
            }
            (Motion::Slide(first), Some(Motion::Slide(second))) => &slid(0, first) + &slid(1, second),
        };
        bound.upper
    }
}

impl Arm<'_> {
    /// Whether the tip may be at a place in some configuration of a region. The domain is cut in four, again and again; parts are
    /// dropped that have nothing of the region, or in whose middle the tip is farther from the place than it can move within.
    pub fn may_reach(&self, tip: &Body, place: &Point, domain: &Domain, region: impl Fn(&Rectangle) -> bool) -> bool {
        let is_far = |rectangle: &Rectangle| {
            let cell = Cell::from(rectangle);
            let at = &self.placed(tip, &cell).points[0];
            length(&[&at[0] - &place[0], &at[1] - &place[1]]).lower > self.farthest(tip, &cell)
        };
        let halves = |[low, high]: &Range| {
            let middle = Decimal::middle(low, high);
            [[low.clone(), middle.clone()], [middle, high.clone()]]
        };
        let (mut waiting, mut looked_at) = (vec![(domain.whole(), 0)], 0);
        while let Some((rectangle, cuts)) = waiting.pop() {
            looked_at += 1;
            if !region(&rectangle) || is_far(&rectangle) {
                continue;
            }
            if cuts == MOST_CUTS || looked_at > MOST_RECTANGLES {
                return true;
            }
            let [first, second] = rectangle.each_ref().map(halves);
            for a in &first {
                waiting.extend(second.each_ref().map(|b| ([a.clone(), b.clone()], cuts + 1)));
            }
        }
        false
    }
}

/// How often the domain is cut where the tip may be at a place: a part in 10^12 of each range is left.
const MOST_CUTS: u32 = 40;

/// Parts of the domain that are looked at before the place counts as reached.
const MOST_RECTANGLES: usize = 20_000;

/// What a joint does at a value.
enum Moved {
    /// Sine and cosine.
    Turn([Interval; 2]),
    Slide(Point),
}

impl Moved {
    fn apply(&self, p: &Point) -> Point {
        match self {
            Self::Turn(angle) => turned(p, angle),
            Self::Slide(by) => sum(p, by),
        }
    }
}
