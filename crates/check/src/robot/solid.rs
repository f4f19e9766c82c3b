//! Solids, and what they cover in the plane.

use super::oblique::oblique;
use super::pose::{Pose, Vector};
use super::tree::{Read, Tree};
use super::{Arm, Body};
use crate::decimal::Decimal;
use crate::domain::Range;
use crate::interval::{Interval, Point, length, minus, sum};
use crate::overlap::{Shape, hull};
use crate::world::task::RESTING;
use num_bigint::{BigInt, Sign};
use roxmltree::Node;

/// A solid about its origin; cylinders and capsules along z.
pub enum Solid {
    /// The convex hull of points.
    Hull(Vec<Vector>),
    Cylinder {
        radius: Interval,
        half: Interval,
    },
    /// `half` is half the length between the centres of the caps: 0 for a sphere.
    Capsule {
        radius: Interval,
        half: Interval,
    },
}

/// What an outline is to be, where it is not the projection itself.
#[derive(Clone, Copy, PartialEq)]
pub enum Outline {
    /// Part of the projection.
    Within,
    /// All of it, and maybe more.
    Around,
}

impl Solid {
    pub fn point() -> Self {
        Self::Capsule { radius: Interval::whole(0), half: Interval::whole(0) }
    }
}

impl<'a> Tree<'a> {
    /// A solid of the URDF, or why its mesh is not read; none if it has no size.
    pub fn solid(&self, node: Node<'a, 'a>) -> Read<Option<Read<Solid>>> {
        let half = |n: &Decimal| Interval::from(n).half();
        let read = |name: &str| self.number(node, name);
        let (numbers, solid) = match node.tag_name().name() {
            "box" => {
                let size = self.numbers::<3>(node, "size")?;
                let half = size.each_ref().map(half);
                let signed = |i: usize, k: usize| if i >> k & 1 == 0 { half[k].clone() } else { -&half[k] };
                (size.to_vec(), Solid::Hull((0..8).map(|i| [0, 1, 2].map(|k| signed(i, k))).collect()))
            }
            "sphere" => {
                let radius = read("radius")?;
                (vec![radius.clone()], Solid::Capsule { radius: Interval::from(&radius), half: Interval::whole(0) })
            }
            kind @ ("cylinder" | "capsule") => {
                let (radius, length) = (read("radius")?, read("length")?);
                let (r, half) = (Interval::from(&radius), half(&length));
                let is_round = kind == "capsule";
                let solid =
                    if is_round { Solid::Capsule { radius: r, half } } else { Solid::Cylinder { radius: r, half } };
                (vec![radius, length], solid)
            }
            "mesh" => return Ok(Some(self.mesh(node)?.map(Solid::Hull))),
            other => return self.error(node, format!("the checker does not know the shape {other} yet")),
        };
        if numbers.iter().any(|n| n.sign() == Sign::Minus) {
            return self.error(node, "a size is negative");
        }
        Ok(numbers.iter().any(|n| n.sign() != Sign::NoSign).then_some(Ok(solid)))
    }
}

impl Arm<'_> {
    /// What a solid covers in the plane.
    pub fn project(&self, link: usize, pose: &Pose, solid: &Solid, outline: Outline) -> Body {
        let plane = &self.plane;
        let joint = if link == 0 { self.base.clone() } else { [0, 1].map(|k| &self.base[k] + &self.offset[k]) };
        let origin = plane.flat(&pose.at);
        let center = minus(&origin, &joint);
        let unit = pose.direction(&[0, 0, 1].map(Interval::whole));
        let (along, tilt) = (plane.flat(&unit), plane.height(&unit).abs());
        let beside = |by: &Point| [sum(&center, by), minus(&center, by)];
        let height = &plane.height(&pose.at);
        let about = |reach: &Interval| [height - reach, height + reach];
        let (shape, heights) = match solid {
            Solid::Hull(points) => {
                let placed: Vec<Vector> = points.iter().map(|p| pose.direction(p)).collect();
                let offsets = placed.iter().map(|p| plane.flat(p));
                let flat = offsets.map(|p| [0, 1].map(|k| &center[k] + &p[k]));
                let heights: Vec<Interval> = placed.iter().map(|p| plane.height(p)).collect();
                let [least, most] = [Ord::min, Ord::max].map(|outer: fn(BigInt, BigInt) -> BigInt| {
                    let of = |end: fn(&Interval) -> &BigInt| {
                        heights.iter().map(end).cloned().reduce(outer).expect("a hull has points")
                    };
                    height + &Interval { lower: of(|h| &h.lower), upper: of(|h| &h.upper) }
                });
                (hull_of(flat, outline), [least, most])
            }
            Solid::Capsule { radius, half } => {
                let points =
                    if half.is_whole(0) { vec![center.clone()] } else { beside(&along.map(|c| &c * half)).to_vec() };
                (Shape { points, radius: radius.clone() }, about(&(&(half * &tilt) + radius)))
            }
            Solid::Cylinder { radius, half } if tilt.is_whole(1) => {
                (Shape { points: vec![center.clone()], radius: radius.clone() }, about(half))
            }
            Solid::Cylinder { radius, half } => {
                let (offsets, round) = oblique(&along, &tilt, radius, half, outline);
                let points = offsets.iter().flat_map(beside).collect();
                (Shape { points, radius: round }, about(&(&(half * &tilt) + &(radius * &length(&along)))))
            }
        };
        Body { link, shape, heights: Some(heights) }
    }
}

/// The hull of points, by those of its corners: of the middles of their enclosures it is found without rounding, and each point is as
/// far from there as that of any enclosure.
fn hull_of(points: impl Iterator<Item = Point>, outline: Outline) -> Shape {
    let mut error = BigInt::ZERO;
    let middles = points.map(|p| {
        p.map(|c| {
            let (middle, radius) = c.middle();
            error = radius.max(std::mem::take(&mut error));
            middle
        })
    });
    let ring = hull(middles.collect());
    let widened = |middle: BigInt| Interval { lower: &middle - &error, upper: middle + &error };
    let points = ring.into_iter().map(|p| p.map(widened)).collect();
    // A point is off its middle, and a corner off its own, by less than two errors across and along together.
    let room = if outline == Outline::Around { Interval::exactly(&error * 4) } else { Interval::whole(0) };
    Shape { points, radius: room }
}

impl Body {
    /// Its heights and others; none where one of them is everywhere.
    fn beside(&self, heights: Option<&Range>) -> Option<(&[Interval; 2], [Interval; 2])> {
        Some((self.heights.as_ref()?, heights?.each_ref().map(Interval::from)))
    }

    /// Whether its heights and these are known to have some in common.
    pub fn is_at(&self, heights: Option<&Range>) -> bool {
        self.beside(heights).is_none_or(|(own, [low, high])| own[0].upper <= high.lower && low.upper <= own[1].lower)
    }

    /// Whether an object with its heights is known to reach deeper below the end of these than one that rests there.
    pub fn is_below_top(&self, heights: Option<&Range>) -> bool {
        let into = Interval::from(&Decimal::power_of_ten(RESTING));
        self.beside(heights).is_none_or(|(own, [_, high])| (&own[0] + &into).upper < high.lower)
    }

    /// Whether its heights and these are known to have none in common.
    pub fn passes(&self, heights: Option<&Range>) -> bool {
        self.beside(heights).is_some_and(|(own, [low, high])| own[1].upper < low.lower || high.upper < own[0].lower)
    }
}
