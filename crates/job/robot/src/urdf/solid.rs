//! Solids in space, and their projections onto a plane.

use super::mesh::Mesh;
use super::plane::project;
use cplan_geometry::{Convex, Point, Vector, hull};
use cplan_model::{Heights, Plane};
use nalgebra::{Isometry3, Point3, Vector3};

/// A collision or visual shape, centred at the origin of its frame. Lengths are in metres. The axis of a cylinder or a
/// capsule is z.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Solid {
    Box {
        half: Vector3<f64>,
    },
    Cylinder {
        radius: f64,
        half: f64,
    },
    /// A capsule. `half` is half the distance between the centres of its caps.
    Capsule {
        radius: f64,
        half: f64,
    },
    Sphere {
        radius: f64,
    },
    /// A mesh. Its convex hull, or that of each of its layers, represents it; see [`Solid::layers`].
    Mesh(Mesh),
}

/// A corner within this distance, in metres, of the previous one is removed. Such corners are due to the rounding of rotations.
/// Their removal moves the outline inwards by at most this distance.
const CORNER_ROUNDING: f64 = 1e-9;

/// Greatest excess of an oblique cylinder's outline over its exact projection, as a fraction of the radius.
const MAX_OUTLINE_EXCESS: f64 = 0.005;

/// Number of sides of the polygon that circumscribes the end of an oblique cylinder. It must satisfy
/// `1 / cos(pi / n) - 1 <= MAX_OUTLINE_EXCESS`.
const ELLIPSE_SIDES: usize = 32;

/// Number of steps along half of the ellipse at the end of an oblique cylinder. The corners of the inscribed polygon are the
/// points where the circumscribed one touches the ellipse.
const ELLIPSE_STEPS: usize = ELLIPSE_SIDES / 2;

/// Least thickness of a mesh's layers, in metres. It is far above the rounding of heights.
pub(super) const MIN_LAYER_THICKNESS: f64 = 1e-6;

/// Largest deviation from 0 (or 1) of the cosine of the angle between a cylinder's axis and the normal for which the cylinder
/// counts as perpendicular (or parallel) to the normal.
const EXACT_ALIGNMENT: f64 = 1e-13;

impl Solid {
    /// Returns true if the solid has no size.
    pub fn has_no_size(&self) -> bool {
        match self {
            Solid::Box { half } => half.iter().all(|h| *h == 0.0),
            Solid::Cylinder { radius, half } | Solid::Capsule { radius, half } => *radius == 0.0 && *half == 0.0,
            Solid::Sphere { radius } => *radius == 0.0,
            Solid::Mesh(mesh) => mesh.points.is_empty(),
        }
    }

    /// Returns the projection of the solid onto the plane, in plane coordinates. `pose` is in the root frame.
    ///
    /// Exact for boxes, spheres, capsules, meshes (their convex hull), and cylinders that are parallel or perpendicular to the
    /// normal. The outline of an oblique cylinder exceeds the exact one by at most 0.5 % of the radius; see [`Solid::inner`].
    pub fn outline(&self, pose: &Isometry3<f64>, plane: &Plane) -> Convex {
        let at = |p: &Point3<f64>| project(plane, &(pose * p).coords);
        let center = at(&Point3::origin());
        let along = project(plane, &(pose * Vector3::z()));
        match self {
            Solid::Box { half } => {
                let corner = |i: u8| {
                    let sign = |bit: u8| if i & bit == 0 { -1.0 } else { 1.0 };
                    at(&Point3::new(sign(1) * half.x, sign(2) * half.y, sign(4) * half.z))
                };
                polygon((0..8).map(corner).collect())
            }
            Solid::Mesh(mesh) => polygon(mesh.points.iter().map(at).collect()),
            Solid::Sphere { radius } => Convex::trusted(vec![center], *radius),
            Solid::Capsule { radius, half } => capsule(center - along * *half, center + along * *half, *radius),
            Solid::Cylinder { radius, half } => {
                let tilt = (pose * Vector3::z()).dot(&plane.normal);
                cylinder(center, along, tilt, *radius, *half)
            }
        }
    }

    /// Returns the outlines of a mesh's layers between consecutive `cuts`, which are ascending, with the heights of each. Returns
    /// the whole outline if no cut goes through the mesh, or if the solid is no mesh.
    ///
    /// A layer's outline is the convex hull of the mesh's surface within the layer. Its points are the vertices in the layer, and
    /// the points where edges cross the layer's upper and lower height.
    pub fn layers(&self, pose: &Isometry3<f64>, plane: &Plane, cuts: &[f64]) -> Vec<(Convex, Heights)> {
        let heights = self.heights(pose, plane);
        let is_within =
            |cut: &&f64| heights.lower + MIN_LAYER_THICKNESS < **cut && **cut + MIN_LAYER_THICKNESS < heights.upper;
        let cuts: Vec<f64> = cuts.iter().filter(is_within).copied().collect();
        let Solid::Mesh(Mesh { points, edges }) = self else { return vec![(self.outline(pose, plane), heights)] };
        if cuts.is_empty() || edges.is_empty() {
            return vec![(self.outline(pose, plane), heights)];
        }
        let placed: Vec<(Point, f64)> =
            points.iter().map(|p| (pose * p).coords).map(|p| (project(plane, &p), p.dot(&plane.normal))).collect();
        let ends = || std::iter::once(heights.lower).chain(cuts.iter().copied()).chain([heights.upper]);
        let layer = |(lower, upper): (f64, f64)| {
            let is_in = |height: f64| lower - CORNER_ROUNDING <= height && height <= upper + CORNER_ROUNDING;
            let mut corners: Vec<Point> =
                placed.iter().filter(|(_, height)| is_in(*height)).map(|(at, _)| *at).collect();
            for edge in edges {
                let [(from, low), (to, high)] = edge.map(|end| placed[end as usize]);
                let crossed = [lower, upper].into_iter().filter(|cut| (low - cut) * (high - cut) < 0.0);
                corners.extend(crossed.map(|cut| from + (to - from) * ((cut - low) / (high - low))));
            }
            (!corners.is_empty()).then(|| (polygon(corners), Heights { lower, upper }))
        };
        ends().zip(ends().skip(1)).filter_map(layer).collect()
    }

    /// Returns a shape within the exact projection if the outline exceeds it, which is the case only for oblique cylinders. The
    /// shape is smaller than the outline by at most a hundredth of the radius.
    pub fn inner(&self, pose: &Isometry3<f64>, plane: &Plane) -> Option<Convex> {
        let Solid::Cylinder { radius, half } = self else { return None };
        let center = project(plane, &(pose * Point3::origin()).coords);
        let axis = pose * Vector3::z();
        within_cylinder(center, project(plane, &axis), axis.dot(&plane.normal).abs(), *radius, *half)
    }

    /// Returns the least and the greatest height.
    pub fn heights(&self, pose: &Isometry3<f64>, plane: &Plane) -> Heights {
        let n = plane.normal;
        let middle = pose.translation.vector.dot(&n);
        let axis = |a: Vector3<f64>| (pose * a).dot(&n).abs();
        let tilt = axis(Vector3::z()).min(1.0);
        let reach = match self {
            Solid::Box { half } => {
                half.x * axis(Vector3::x()) + half.y * axis(Vector3::y()) + half.z * axis(Vector3::z())
            }
            Solid::Cylinder { radius, half } => half * tilt + radius * (1.0 - tilt * tilt).sqrt(),
            Solid::Capsule { radius, half } => half * tilt + radius,
            Solid::Sphere { radius } => *radius,
            Solid::Mesh(mesh) => {
                let heights = || mesh.points.iter().map(|p| (pose * p).coords.dot(&n));
                return Heights {
                    lower: heights().fold(f64::INFINITY, f64::min),
                    upper: heights().fold(f64::NEG_INFINITY, f64::max),
                };
            }
        };
        Heights { lower: middle - reach, upper: middle + reach }
    }
}

/// Returns the capsule with two ends, or a disc if they coincide.
pub(super) fn capsule(a: Point, b: Point, radius: f64) -> Convex {
    let apart = (b - a).norm();
    if apart <= CORNER_ROUNDING {
        return Convex::trusted(vec![(a + b) * 0.5], radius + apart / 2.0);
    }
    Convex::trusted(vec![a, b], radius)
}

/// Returns the convex hull of points, without corners that are due to rounding.
fn polygon(points: Vec<Point>) -> Convex {
    let mut corners: Vec<Point> = Vec::new();
    for corner in hull(&points) {
        if corners.last().is_none_or(|kept| (corner - kept).norm() > CORNER_ROUNDING) {
            corners.push(corner);
        }
    }
    if corners.len() > 1 && (corners[0] - corners[corners.len() - 1]).norm() <= CORNER_ROUNDING {
        corners.pop();
    }
    Convex::trusted(corners, 0.0)
}

/// Returns the outline of a cylinder. `along` is the projection of its axis, whose length is the sine of the angle between axis
/// and normal; `tilt` is the cosine. The exact projection is the hull of two ellipses, the ends, with half-axes `radius` across
/// the axis and `radius * |tilt|` along it.
fn cylinder(center: Point, along: Vector, tilt: f64, radius: f64, half: f64) -> Convex {
    if 1.0 - tilt.abs() <= MAX_OUTLINE_EXCESS {
        // If the axis is almost parallel to the normal, the ends are discs, up to a factor of `tilt` in one direction.
        return capsule(center - along * half, center + along * half, radius);
    }
    let direction = along.normalize();
    let across = cplan_geometry::perpendicular(direction) * radius;
    let bulge = direction * (radius * tilt.abs());
    let end = along * half;
    if tilt.abs() <= MAX_OUTLINE_EXCESS {
        // If the axis is almost in the plane, the outline is a rectangle, lengthened by the half-axes of the ellipses.
        let end = end + bulge;
        return polygon(vec![
            center - end - across,
            center + end - across,
            center + end + across,
            center - end + across,
        ]);
    }
    let step = std::f64::consts::TAU / ELLIPSE_SIDES as f64;
    let grown = 1.0 / (step / 2.0).cos();
    let rim = (0..ELLIPSE_SIDES).flat_map(|i| {
        // Half a step of offset puts the ends of the axes on sides instead of corners, so that the width is exact.
        let (sine, cosine) = ((i as f64 + 0.5) * step).sin_cos();
        let offset = (bulge * cosine + across * sine) * grown;
        [center - end + offset, center + end + offset]
    });
    polygon(rim.collect())
}

/// Returns a region that an oblique cylinder certainly covers. `None` if [`cylinder`] is exact. An almost circular end
/// contributes a disc; otherwise an end contributes a polygon with corners on the outer half of its ellipse.
fn within_cylinder(center: Point, along: Vector, tilt: f64, radius: f64, half: f64) -> Option<Convex> {
    if tilt <= EXACT_ALIGNMENT || 1.0 - tilt <= EXACT_ALIGNMENT {
        return None;
    }
    let end = along * half;
    if 1.0 - tilt <= MAX_OUTLINE_EXCESS {
        let is_disc = 2.0 * end.norm() <= CORNER_ROUNDING;
        let core = if is_disc { vec![center] } else { vec![center - end, center + end] };
        return Some(Convex::trusted(core, radius * tilt));
    }
    let direction = along.normalize();
    let (across, bulge) = (cplan_geometry::perpendicular(direction) * radius, direction * (radius * tilt));
    let rim = (0..=ELLIPSE_STEPS).flat_map(|i| {
        let (sine, cosine) = (i as f64 * (std::f64::consts::PI / ELLIPSE_STEPS as f64)).sin_cos();
        let outer = end + bulge * sine + across * cosine;
        [center - outer, center + outer]
    });
    Some(polygon(rim.collect()))
}
