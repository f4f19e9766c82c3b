//! The arc of contact of a bar that turns about the joint and a convex polygon, in closed form with two arc tangents.
//!
//! A point at distance `r` from the joint touches the sides of a bar of half-width `w` if the angle between the bar's
//! axis and the direction to the point is `asin(w / r)`, and if `r` is at most the reach of the bar's front corners.
//!
//! Let `K` be the part of the polygon within that reach. Suppose `K` is farther from the joint than the bar's rear
//! corners and at least as close as its front side. Then the directions at which the bar meets `K` form *one* arc, from
//! the least to the greatest such direction over the points of `K`. The arc has no gap, because `K` contains the
//! segments from all its points to the one nearest to the joint.
//!
//! Both ends are attained at corners of `K`: corners of the polygon, and points where its sides cross the circle of the
//! reach. All these directions are within a right angle of the direction to the polygon, so signs of cross products
//! order them. Rounding in comparisons does no harm: of two candidates that tie, either is correct.

use super::features::{Features, quotient};
use super::{Hits, wrap};
use crate::{Convex, Point, Vector, cross, perpendicular};
use std::f64::consts::TAU;

/// Lengths that differ by less count as equal, metres. This exceeds the rounding of coordinates up to about 100 m, and
/// is far smaller than [`super::ROUNDING`].
const LENGTH_TOLERANCE: f64 = 1e-11;

/// Least ratio of width to reach of a bar. The arcs are then much wider than the rounding errors of their ends.
const MIN_WIDTH_RATIO: f64 = 1e-6;

/// A rectangle from `rear` to `front` along the axis, symmetric about it, with the joint at the origin.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bar {
    /// Unit vector along the bar, from the joint to the middle of the front side.
    axis: Vector,
    front: f64,
    half_width: f64,
    /// Squared distance of the front corners from the joint.
    reach2: f64,
    /// Distance of the rear corners from the joint.
    rear: f64,
}

impl Bar {
    /// Returns the shape as a bar; `None` if it is not a bar.
    pub fn of(shape: &Convex) -> Option<Self> {
        let core: &[Point; 4] = shape.core().try_into().ok()?;
        (0..4).find_map(|k| {
            let [right, left, rear_left, rear_right] = [0, 1, 2, 3].map(|i| core[(k + i) % 4]);
            let axis = (-perpendicular(left - right)).try_normalize(0.0)?;
            let (front, half_width) = (axis.dot(&right), (left - right).norm() / 2.0);
            let back = axis.dot(&rear_left);
            let corner = |along: f64, across: f64| axis * along + perpendicular(axis) * across;
            let is = |at: Vector, along: f64, across: f64| (at - corner(along, across)).norm() <= LENGTH_TOLERANCE;
            let rectangle = is(right, front, -half_width)
                && is(left, front, half_width)
                && is(rear_left, back, half_width)
                && is(rear_right, back, -half_width);
            let reach = front.hypot(half_width);
            (rectangle && back.abs() < front && half_width > MIN_WIDTH_RATIO * reach).then(|| Self {
                axis,
                front,
                half_width,
                reach2: reach * reach,
                rear: back.hypot(half_width),
            })
        })
    }

    /// Like [`super::turning_from`], for a bar, without radii and growth. `None` if the joint is too close to the
    /// piece, or if only the front corners of the bar reach the piece. `O(n)`.
    pub fn arc(&self, pivot: Point, zero: Vector, piece: &Features, out: &mut Vec<[f64; 2]>) -> Option<Hits> {
        let side_gap = |normal: Vector, offset: f64| normal.dot(&pivot) - offset;
        let (gap, toward) = piece.sides.iter().map(|s| (side_gap(s.normal, s.offset), -s.normal)).fold(
            (self.rear + LENGTH_TOLERANCE, Vector::zeros()),
            |best, next| if next.0 > best.0 { next } else { best },
        );
        if toward == Vector::zeros() {
            return None;
        }
        if gap * gap > self.reach2 {
            return Some(Hits::Never);
        }
        let mut extremes = Extremes { first: perpendicular(toward), last: -perpendicular(toward) };
        let (mut touched, mut blocks_front, mut all_inside) = (false, false, true);
        let reach = self.reach2.sqrt() + LENGTH_TOLERANCE;
        for corner in &piece.corners {
            let at = corner.at - pivot;
            let distance2 = at.norm_squared();
            if distance2 <= reach * reach {
                extremes.add(at, (distance2 - self.half_width * self.half_width).sqrt(), self.half_width);
                touched = true;
                blocks_front |= distance2 <= self.front * self.front;
            } else {
                all_inside = false;
            }
        }
        if !all_inside {
            for side in &piece.sides {
                let along = -side_gap(side.normal, side.offset);
                let across2 = self.reach2 - along * along;
                if across2 < 0.0 {
                    continue;
                }
                let shift = cross(side.normal, pivot);
                let (from, to) = (side.from - shift, side.to - shift);
                let root = across2.sqrt();
                for across in [root, -root] {
                    if from <= across && across <= to {
                        let at = side.normal * along + perpendicular(side.normal) * across;
                        extremes.add(at, self.front, self.half_width);
                        touched = true;
                    }
                }
                blocks_front |= from <= 0.0 && 0.0 <= to && along.abs() <= self.front;
            }
        }
        match (touched, blocks_front) {
            (false, _) => Some(Hits::Never),
            (true, false) => None,
            (true, true) => {
                let angle = |direction| {
                    let direction = quotient(quotient(direction, self.axis), zero);
                    wrap(direction.y.atan2(direction.x))
                };
                let (start, end) = (angle(extremes.first), angle(extremes.last));
                out.push([start, if end < start { end + TAU } else { end }]);
                Some(Hits::Within)
            }
        }
    }
}

/// The first and the last direction of the bar's axis at which it meets any of the given points. The vectors may
/// have any length.
struct Extremes {
    first: Vector,
    last: Vector,
}

impl Extremes {
    /// Adds a point. The bar touches it when the point is at `along` in the direction of the axis, and at `across`
    /// beside the axis.
    fn add(&mut self, at: Vector, along: f64, across: f64) {
        let first = Vector::new(along * at.x + across * at.y, along * at.y - across * at.x);
        let last = Vector::new(along * at.x - across * at.y, along * at.y + across * at.x);
        if cross(first, self.first) > 0.0 {
            self.first = first;
        }
        if cross(self.last, last) > 0.0 {
            self.last = last;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::critical::critical_arcs;
    use super::super::touching::Placement;
    use super::*;
    use crate::{Pose, ROUNDING, separation};
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn bar(length: f64, back: f64, half_width: f64, turn: f64) -> Convex {
        let corners = [(back, -half_width), (length, -half_width), (length, half_width), (back, half_width)];
        Convex::trusted(corners.map(|(x, y)| Pose::rotation(turn).point(Point::new(x, y))).to_vec(), 0.0)
    }

    #[test]
    fn only_bars_about_the_joint_are_bars() {
        let corners = |list: [(f64, f64); 4]| Convex::trusted(list.map(|(x, y)| Point::new(x, y)).to_vec(), 0.0);
        assert!(Bar::of(&bar(0.8, -0.1, 0.05, 0.7)).is_some());
        assert!(Bar::of(&bar(0.8, 0.1, 0.05, -2.0)).is_some());
        assert!(Bar::of(&bar(0.8, 0.0, 1e-9, 0.0)).is_none(), "hardly a width");
        assert!(Bar::of(&bar(0.1, -0.1, 0.1, 0.0)).is_none(), "no end is the front");
        assert!(Bar::of(&corners([(0.0, -0.05), (0.8, -0.05), (0.8, 0.06), (0.0, 0.06)])).is_none(), "off the axis");
        assert!(Bar::of(&corners([(0.0, -0.05), (0.8, -0.04), (0.8, 0.04), (0.0, 0.05)])).is_none(), "tapered");
        assert!(Bar::of(&Convex::trusted(vec![Point::zeros(), Point::new(1.0, 0.0)], 0.0)).is_none());
    }

    /// Tests shapes that touch. Rounding moves the touching corner farther into the bar than its distance along the
    /// normal suggests.
    #[test]
    fn touching_shapes_have_no_gap() {
        let part = bar(0.8, 0.14258016639302604, 0.01648044041409189, -1.856738282955592);
        let corner = |k: u32| {
            let angle = 6.086385869499533 + TAU * f64::from(k) / 4.0;
            Point::new(0.07625734473771464 * angle.cos(), 0.07625734473771464 * angle.sin())
        };
        let piece = Convex::trusted((0..4).map(corner).collect(), 0.0);
        let away = Vector::new(0.7598922895925858_f64.cos(), 0.7598922895925858_f64.sin()) * 0.4827191507635857;
        for touching in [-1.6011286936056064, -1.273965092817372] {
            for nudge in -8_i32..=8 {
                let angle = touching + f64::from(nudge) * 2.0 * f64::EPSILON + 0.8_f64.atan2(0.6);
                let distance = separation(&part.at(&Pose::new(away, angle)), &piece).distance;
                assert!(distance.abs() < ROUNDING, "{touching} {nudge}: {distance}");
            }
        }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(20_000))]

        /// Compares the arcs with those of the exhaustive method, which sorts all critical angles and computes a
        /// distance between each two neighbours. An independent computation of the distance confirms that the shapes
        /// touch at the ends. In some cases, corners are exactly at the reach of the bar.
        #[test]
        fn arcs_are_those_of_all_critical_angles(
            (back, half_width, turn) in (-0.2..0.2f64, 0.01..0.15f64, -PI..PI),
            (corners, size, own_turn) in (2usize..8, 0.02..0.5f64, 0.0..TAU),
            (distance, direction) in (0.05..1.3f64, -PI..PI),
            at_reach in prop_oneof![Just(None), (0..8usize).prop_map(Some)],
        ) {
            let part = bar(0.8, back, half_width, turn);
            let corner = |k: usize| {
                let angle = own_turn + TAU * k as f64 / corners as f64;
                Point::new(size * angle.cos(), size * angle.sin())
            };
            let piece = Convex::trusted((0..corners).map(corner).collect(), 0.0);
            let away = Vector::new(direction.cos(), direction.sin());
            let pivot = match at_reach {
                None => away * distance,
                Some(k) => piece.core()[k % corners] + away * 0.8_f64.hypot(half_width),
            };
            let zero = Vector::new(0.6, 0.8);
            let (part, piece) = (Features::new(&part), Features::new(&piece));
            let bar = part.bar.clone().expect("a bar");
            let (mut arcs, mut exhaustive) = (Vec::new(), Vec::new());
            let Some(hits) = bar.arc(pivot, zero, &piece, &mut arcs) else { return Ok(()) };
            let reach = (0.0, f64::INFINITY);
            let expected =
                critical_arcs(&Placement { part: &part, pivot, zero, piece: &piece, radius: 0.0, reach }, &mut exhaustive);
            let distance = |angle: f64| {
                let pose = Pose::new(pivot, angle + zero.y.atan2(zero.x));
                separation(&part.shape().at(&pose), piece.shape()).distance
            };
            if hits == Hits::Never {
                // Within rounding, the exhaustive method may report false contacts.
                prop_assert!(expected == Hits::Never || exhaustive.iter().all(|a| distance((a[0] + a[1]) / 2.0) > -ROUNDING));
            } else if expected == Hits::Never {
                prop_assert!(arcs.iter().all(|a| distance((a[0] + a[1]) / 2.0) > -ROUNDING));
            } else {
                prop_assert_eq!((hits, arcs.len(), exhaustive.len()), (Hits::Within, 1, 1));
                for k in 0..2 {
                    prop_assert!(wrap(arcs[0][k] - exhaustive[0][k]).abs() < 1e-4, "{:?} {:?}", arcs, exhaustive);
                    prop_assert!(distance(arcs[0][k]).abs() < ROUNDING, "{:?} {}", arcs, distance(arcs[0][k]));
                }
            }
        }
    }
}
