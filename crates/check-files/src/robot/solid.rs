//! Solids of the URDF, and their projections onto the plane.

use super::Robot;
use super::oblique::oblique;
use super::pose::{Pose, Vector, dot};
use super::tree::{ReadResult, Tree};
use cplan_check::decimal::Decimal;
use cplan_check::interval::{Interval, Point, length, minus, sum};
use cplan_check::overlap::{Shape, hull};
use cplan_check::shapes::{Body, Outline};
use num_bigint::{BigInt, Sign};
use roxmltree::Node;

/// Points of a solid. If its faces are known, also the edges of the faces, as pairs of indices of points.
pub struct Mesh {
    pub points: Vec<Vector>,
    pub edges: Vec<[usize; 2]>,
}

/// A solid in its own frame. The axis of cylinders and capsules is z.
pub enum Solid {
    /// The convex hull of points.
    Hull(Mesh),
    Cylinder {
        radius: Interval,
        half: Interval,
    },
    /// A capsule or a sphere. `half` is half the distance between the centres of the caps, which is 0 for a sphere.
    Capsule {
        radius: Interval,
        half: Interval,
    },
}

impl Solid {
    pub fn point() -> Self {
        Self::Capsule { radius: Interval::whole(0), half: Interval::whole(0) }
    }
}

impl<'a> Tree<'a> {
    /// Reads a `<geometry>` of the URDF. `None` if the solid has no size. The outer error is a mistake in the URDF, the
    /// inner one the reason why the solid's mesh cannot be read.
    pub fn solid(&self, node: Node<'a, 'a>) -> ReadResult<Option<ReadResult<Solid>>> {
        let half = |n: &Decimal| Interval::from(n).half();
        let read = |name: &str| self.number(node, name);
        let (numbers, solid) = match node.tag_name().name() {
            "box" => {
                let size = self.numbers::<3>(node, "size")?;
                let half = size.each_ref().map(half);
                let signed = |i: usize, k: usize| if i >> k & 1 == 0 { half[k].clone() } else { -&half[k] };
                let points = (0..8).map(|i| [0, 1, 2].map(|k| signed(i, k))).collect();
                (size.to_vec(), Solid::Hull(Mesh { points, edges: Vec::new() }))
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

/// The surface of a mesh: its points in plane coordinates relative to a joint, each with its height, and the edges of
/// its faces.
pub struct Surface {
    pub points: Vec<(Point, Interval)>,
    pub edges: Vec<[usize; 2]>,
}

impl Surface {
    /// Computes the least and the greatest height of the points.
    pub fn heights(&self) -> [Interval; 2] {
        [Ord::min, Ord::max].map(|outer: fn(BigInt, BigInt) -> BigInt| {
            let of = |end: fn(&Interval) -> &BigInt| {
                let all = self.points.iter().map(|(_, height)| end(height).clone());
                all.reduce(outer).expect("a hull has points")
            };
            Interval { lower: of(|h| &h.lower), upper: of(|h| &h.upper) }
        })
    }

    /// Computes the convex hull of all points: an outer and an inner approximation.
    pub fn whole(&self, last: Option<usize>) -> [Body; 2] {
        bodies(last, self.points.iter().map(|(at, _)| at.clone()), &self.heights())
    }
}

impl Robot<'_> {
    /// Returns the origin of joint `last`, the last joint that moves a link, in plane coordinates. For a static link
    /// (`None`) this is the origin of the plane.
    fn origin(&self, last: Option<usize>) -> Point {
        match last {
            None => [0, 0].map(Interval::whole),
            Some(0) => self.arm.base.clone(),
            Some(_) => sum(&self.arm.base, &self.arm.offset),
        }
    }

    /// Projects a mesh into the plane, relative to the joint that moves it last.
    pub fn surface(&self, last: Option<usize>, pose: &Pose, mesh: &Mesh) -> Surface {
        let [across, beside] = &self.plane.across;
        let column = |k: usize| [0, 1, 2].map(|i| pose.rows[i][k].clone());
        let columns = [column(0), column(1), column(2)];
        let [x, y, z] = [across, beside, &self.plane.normal].map(|along| columns.each_ref().map(|c| dot(along, c)));
        let center = minus(&self.plane.flat(&pose.at), &self.origin(last));
        let height = self.plane.height(&pose.at);
        let place = |p: &Vector| ([&center[0] + &dot(&x, p), &center[1] + &dot(&y, p)], &height + &dot(&z, p));
        Surface { points: mesh.points.iter().map(place).collect(), edges: mesh.edges.clone() }
    }

    /// Computes the projection of a solid, relative to the joint that moves it last.
    pub fn project(&self, last: Option<usize>, pose: &Pose, solid: &Solid, outline: Outline) -> Body {
        let plane = &self.plane;
        let center = minus(&plane.flat(&pose.at), &self.origin(last));
        let unit = pose.direction(&[0, 0, 1].map(Interval::whole));
        let (along, tilt) = (plane.flat(&unit), plane.height(&unit).abs());
        let beside = |by: &Point| [sum(&center, by), minus(&center, by)];
        let height = &plane.height(&pose.at);
        let about = |reach: &Interval| [height - reach, height + reach];
        let (shape, heights) = match solid {
            Solid::Hull(mesh) => {
                let [around, within] = self.surface(last, pose, mesh).whole(last);
                return if outline == Outline::Around { around } else { within };
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
                // All corners in order.
                let (onward, back) =
                    (offsets.iter().map(|by| sum(&center, by)), offsets.iter().map(|by| minus(&center, by)));
                let points = onward.chain(back).collect();
                (Shape { points, radius: round }, about(&(&(half * &tilt) + &(radius * &length(&along)))))
            }
        };
        Body { link: last.unwrap_or(0), shape, heights: Some(heights) }
    }
}

/// Computes an outer and an inner approximation of the convex hull of points. Both have the corners of the exact hull of the
/// enclosures' middles. The outer one also has a radius, which covers the distances of points from their middles.
pub fn bodies(last: Option<usize>, points: impl Iterator<Item = Point>, heights: &[Interval; 2]) -> [Body; 2] {
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
    let points: Vec<Point> = ring.into_iter().map(|p| p.map(widened)).collect();
    // Together, the distances of a point and of a corner from their middles are less than two errors along each axis.
    [Interval::exact(&error * 4), Interval::whole(0)].map(|radius| {
        let shape = Shape { points: points.clone(), radius };
        Body { link: last.unwrap_or(0), shape, heights: Some(heights.clone()) }
    })
}
