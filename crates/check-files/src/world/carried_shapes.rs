//! Shapes of carried objects that must keep away from obstacles.

use super::ReadResult;
use cplan_check::decimal::Decimal;
use cplan_check::interval::{BITS, Interval, Point, length, minus, sum, times};
use cplan_check::obstacle::{Obstacle, Outline, point};
use cplan_check::overlap::Shape;
use cplan_check::polygon::{Corner, edges, is_convex, side, surrounds};
use cplan_check::{CheckError, Input};
use num_bigint::Sign;

/// Two limits for objects that press into supports, each a power of two with minus this exponent: the least sine of
/// half the angle at a corner, and the least length of a side, metres.
const MIN_SINE_BITS: u64 = 30;

/// Negative binary logarithm of a share. Reflex corners are moved by this share less than other corners.
const REFLEX_CORNER_BITS: u32 = 30;

/// Returns convex shapes at the obstacle's place: the obstacle itself if it is convex, or else its sides. If a set
/// touches none of them, it does not touch the obstacle, unless one contains the other.
///
/// # Errors
/// Same as [`Obstacle::sides`].
pub fn solids(obstacle: &Obstacle) -> ReadResult<Vec<Shape>> {
    match (&obstacle.outline, convex(obstacle)) {
        (_, Some(corners)) => Ok(vec![hull(obstacle, &corners)]),
        _ => obstacle.sides(),
    }
}

/// Returns the part of an object that must keep away from its supports. Each corner is moved inwards along the bisector
/// of its angle, by `by` or up to `2^-30` of `by` less. The radius of a disc is reduced by `by`, but not below 0.
///
/// # Errors
/// If the object has no interior, or is too thin.
pub fn shrunk_object(object: &Obstacle, by: &Interval) -> ReadResult<Obstacle> {
    let wrong = |why: &str| CheckError::in_file(Input::World, why);
    let outline = match &object.outline {
        Outline::Circle(center, radius) => {
            Outline::Circle(center.clone(), (radius - &by.ends()[1]).max(Decimal::whole(0)))
        }
        Outline::Polygon(rings) => {
            let inset = |(number, ring): (usize, &Vec<Corner>)| inset(without_straight_corners(ring), number > 0, by);
            let smaller: Option<Vec<_>> = rings.iter().enumerate().map(inset).collect();
            let within = smaller.filter(|all| all.iter().flatten().all(|corner| surrounds(rings, corner)));
            let thin = || {
                wrong(
                    "an object with supports is too thin or too pointed: it cannot be shrunk by the depth that it may press into them",
                )
            };
            Outline::Polygon(within.ok_or_else(thin)?)
        }
        Outline::Polyline(_) | Outline::Squares(_) | Outline::Own(_) => {
            return Err(wrong("an object must be a polygon or a circle"));
        }
    };
    Ok(Obstacle { outline, ..object.clone() })
}

fn hull(obstacle: &Obstacle, corners: &[Corner]) -> Shape {
    let radius =
        if let Outline::Circle(_, radius) = &obstacle.outline { Interval::from(radius) } else { Interval::whole(0) };
    Shape { points: corners.iter().map(|corner| obstacle.placed(&point(corner))).collect(), radius }
}

/// Returns the corners of a convex obstacle, turning left, or the centre of a disc. `None` if the obstacle is not convex.
fn convex(obstacle: &Obstacle) -> Option<Vec<Corner>> {
    match &obstacle.outline {
        Outline::Circle(center, radius) => (radius.sign() != Sign::Minus).then(|| vec![center.clone()]),
        Outline::Polygon(rings) => {
            let [ring] = &rings[..] else { return None };
            let mut ring = without_straight_corners(ring);
            if !is_convex(&ring) {
                ring.reverse();
            }
            is_convex(&ring).then_some(ring)
        }
        Outline::Polyline(_) | Outline::Squares(_) | Outline::Own(_) => None,
    }
}

/// Removes the corners of a ring that lie on a line with their neighbours.
fn without_straight_corners(ring: &[Corner]) -> Vec<Corner> {
    let mut ring = ring.to_vec();
    let is_straight = |ring: &[Corner], k: usize| {
        let [last, next] = [ring.len() - 1, 1].map(|by| &ring[(k + by) % ring.len()]);
        side(last, &ring[k], next) == Sign::NoSign
    };
    while let Some(k) = (0..ring.len()).find(|k| is_straight(&ring, *k)) {
        ring.remove(k);
    }
    ring
}

/// Moves the corners of a ring by a length along the bisectors of their angles, inwards or outwards. The order of the
/// corners stays the same. `None` if the result turns in the other direction, or if corners are too sharp.
fn inset(mut ring: Vec<Corner>, outwards: bool, by: &Interval) -> Option<Vec<Corner>> {
    let turns_left = |ring: &[Corner]| {
        let doubled = edges(ring).map(|([a, b], [c, d])| &(a * d) - &(b * c));
        doubled.fold(Decimal::whole(0), |sum, area| &sum + &area).sign() == Sign::Plus
    };
    let is_reversed = turns_left(&ring) == outwards;
    if is_reversed {
        ring.reverse();
    }
    let points: Vec<Point> = ring.iter().map(point).collect();
    let along = |direction: &Point| {
        let far = length(direction);
        (far.lower.bits() + MIN_SINE_BITS > BITS.into()).then(|| direction.each_ref().map(|c| c.divided(&far)))
    };
    let corner = |k: usize| {
        let to = |other: usize| along(&minus(&points[other % points.len()], &points[k]));
        let [x, y] = minus(&to(k + 1)?, &to(k + points.len() - 1)?);
        // The difference between the directions of both sides is perpendicular to the bisector. After a quarter turn,
        // it points to the left of both sides. Rounding must not move a reflex corner onto the line of another side.
        let [last, next] = [points.len() - 1, 1].map(|other| &ring[(k + other) % ring.len()]);
        let is_reflex = side(last, &ring[k], next) == Sign::Minus;
        let by = if is_reflex { by - &by.in_halves(REFLEX_CORNER_BITS) } else { by.clone() };
        let moved = sum(&points[k], &times(&along(&[-&y, x])?, &by));
        Some(moved.map(|c| Decimal::dyadic(&c.middle().0, BITS)))
    };
    let mut moved =
        (0..points.len()).map(corner).collect::<Option<Vec<_>>>().filter(|moved| turns_left(moved) != outwards)?;
    if is_reversed {
        moved.reverse();
    }
    Some(moved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_move_inwards_for_both_orientations() {
        let ring = |text: &str| {
            let numbers: Vec<Decimal> = text.split(' ').map(|n| n.parse().unwrap()).collect();
            numbers.chunks(2).map(|p| [p[0].clone(), p[1].clone()]).collect::<Vec<Corner>>()
        };
        // Along the diagonal of a unit square. A corner in the middle of a side has no effect.
        let by = Interval::whole(2).sqrt().over(10);
        for (outwards, is_inside) in [(false, true), (true, false)] {
            for text in ["0 0 1 0 1 1 0 1", "0 0 0 1 1 1 1 0", "0 0 0.5 0 1 0 1 1 0 1"] {
                let moved = inset(without_straight_corners(&ring(text)), outwards, &by).unwrap();
                assert_eq!(moved.len(), 4);
                let is_beside = |(own, moved): (&Corner, &Corner)| {
                    let half = |c: &Decimal| *c > "0.5".parse().unwrap();
                    own.each_ref().map(half) == moved.each_ref().map(half)
                };
                assert!(without_straight_corners(&ring(text)).iter().zip(&moved).all(is_beside), "{text}: {moved:?}");
                let near = |a: &Decimal, b: &str| {
                    let off = a - &b.parse().unwrap();
                    off < Decimal::power_of_ten(9) && -&off < Decimal::power_of_ten(9)
                };
                let [low, high] = if is_inside { ["0.1", "0.9"] } else { ["-0.1", "1.1"] };
                assert!(moved.iter().flatten().all(|c| near(c, low) || near(c, high)), "{text}: {moved:?}");
            }
        }
        assert!(inset(ring("0 0 1 0 1 1e-12"), false, &by).is_none());
    }
}
