//! What of an object keeps off others while it hangs on the arm.

use super::obstacle::Outline;
use super::{Obstacle, Read, point};
use crate::error::{CheckError, Input};
use crate::interval::{Interval, Point, length, sum, times};
use crate::overlap::Shape;
use crate::polygon::{Corner, is_convex, side};
use num_bigint::Sign;

impl Obstacle {
    /// The same elsewhere, where it stands.
    pub fn moved(self, at: Point, turn: Point) -> Self {
        Self { at, turn, course: None, ..self }
    }

    /// Convex shapes, in its place: itself, or else its sides. What they stay off, and what neither lies in the other, is off it.
    ///
    /// # Errors
    /// As [`Obstacle::sides`].
    pub fn solids(&self) -> Read<Vec<Shape>> {
        match (&self.outline, self.convex()) {
            (_, Some(corners)) => Ok(vec![self.hull(&corners)]),
            _ => self.sides(),
        }
    }

    /// A convex shape, in its place, of which a point is within `by` of each of its points: what does not meet that shape and is convex
    /// comes off this one by a translation of `by`.
    ///
    /// # Errors
    /// An object that is not convex.
    pub fn kernel(&self, by: &Interval) -> Read<Shape> {
        if let Outline::Circle(..) = self.outline {
            let Shape { points, radius } = self.sides()?.swap_remove(0);
            let left = &radius - by;
            let radius = if left.lower.sign() == Sign::Plus { left } else { Interval::whole(0) };
            return Ok(Shape { points, radius });
        }
        let wrong =
            "the checker does not know how deep an object presses into its supports that is no disc and not convex";
        let Some(corners) = self.convex() else { return Err(CheckError::in_file(Input::World, wrong)) };
        let Shape { points, radius } = self.hull(&corners);
        let corner = |k: usize| {
            let to = |other: usize| {
                let [p, q] = [&points[k], &points[other % points.len()]];
                let way = [0, 1].map(|c| &q[c] - &p[c]);
                let far = length(&way);
                (far.lower.sign() == Sign::Plus).then(|| way.map(|c| c.divided(&far)))
            };
            let (next, last) = (to(k + 1)?, to(k + points.len() - 1)?);
            // To the left of the one, and so between the two, which turn left.
            let inward = [&last[1] - &next[1], &next[0] - &last[0]];
            let far = length(&inward);
            (far.lower.sign() == Sign::Plus).then(|| sum(&points[k], &times(&inward.map(|c| c.divided(&far)), by)))
        };
        let points: Option<Vec<Point>> = (0..points.len()).map(corner).collect();
        let sharp = || CheckError::in_file(Input::World, "a corner of an object is too sharp");
        Ok(Shape { points: points.ok_or_else(sharp)?, radius })
    }

    fn hull(&self, corners: &[Corner]) -> Shape {
        let radius =
            if let Outline::Circle(_, radius) = &self.outline { Interval::from(radius) } else { Interval::whole(0) };
        Shape { points: corners.iter().map(|corner| self.placed(&point(corner))).collect(), radius }
    }

    /// The corners that it is the hull of, turning left, up to the radius of a disc; none if it is not convex.
    fn convex(&self) -> Option<Vec<Corner>> {
        match &self.outline {
            Outline::Circle(center, radius) => (radius.sign() != Sign::Minus).then(|| vec![center.clone()]),
            Outline::Polygon(rings) => {
                let [ring] = &rings[..] else { return None };
                let mut ring = ring.clone();
                let is_straight = |ring: &[Corner], k: usize| {
                    let [last, next] = [ring.len() - 1, 1].map(|by| &ring[(k + by) % ring.len()]);
                    side(last, &ring[k], next) == Sign::NoSign
                };
                while let Some(k) = (0..ring.len()).find(|k| is_straight(&ring, *k)) {
                    ring.remove(k);
                }
                if !is_convex(&ring) {
                    ring.reverse();
                }
                is_convex(&ring).then_some(ring)
            }
            Outline::Polyline(_) | Outline::Cells(_) => None,
        }
    }
}
