//! The plane in which the arm moves.

use super::pose::{Pose, Vector, cross, dot, size};
use cplan_check::decimal::Decimal;
use cplan_check::interval::{Interval, Point};
use cplan_check::polygon::Corner;
use num_bigint::{BigInt, Sign};

/// Number of decimals of the largest angle between directions that count as equal: `10^-3` rad.
const ALIGNMENT_DECIMALS: u32 = 3;

/// Number of decimals of the largest angle between directions that differ only by rounding: `10^-12` rad.
const ROUNDING_DECIMALS: u32 = 12;

/// The plane of two joints, in the root frame.
pub struct Plane {
    /// Directions of the two plane coordinates.
    pub across: [Vector; 2],
    /// Direction of heights.
    pub normal: Vector,
    /// Sine of the greatest deviation of the joints from the plane. This is the angle between the axis of a revolute
    /// joint and the normal, or between the axis of a prismatic joint and the plane.
    pub off: BigInt,
}

impl Plane {
    /// Finds the plane in which two joints move. `axes` are their axes of unit length, and `slides` states for each
    /// whether it is prismatic. Returns `None` if there is no such plane.
    ///
    /// The normal is the axis of the first revolute joint, or else perpendicular to both axes. If it is along an axis
    /// of the root frame, that axis replaces it, and the plane coordinates are the other two axes: (x, y) for z, (x, z)
    /// for y, and (y, z) for x. Otherwise the first coordinate is the projection of x onto the plane, or of y if x is
    /// within about half a radian of the normal. The second coordinate is a quarter turn to the left of the first.
    pub fn common(axes: &[Vector; 2], slides: [bool; 2]) -> Option<Self> {
        let [a, b] = axes;
        let aligned = &Interval::from(&Decimal::power_of_ten(ALIGNMENT_DECIMALS)).sin_cos()[0];
        let beside = cross(a, b);
        let [parallel, square] = [size(&beside), dot(a, b).abs()].map(|off| off.upper <= aligned.lower);
        let normal = match slides {
            [false, false] if parallel => a.clone(),
            [false, true] if square => a.clone(),
            [true, false] if square => b.clone(),
            [true, true] if size(&beside).lower > aligned.upper => unit(&beside)?,
            _ => return None,
        };
        let [x, y, z] = Pose::identity().rows;
        let frames = [([&x, &y], &z), ([&x, &z], &y), ([&y, &z], &x)];
        let is_along = |axis: &Vector| size(&cross(&normal, axis)).upper <= aligned.lower;
        // Reject angles that are not known precisely enough.
        if frames.iter().all(|(_, axis)| size(&cross(&normal, axis)).lower <= aligned.upper && !is_along(axis)) {
            return None;
        }
        let (across, normal) = match frames.into_iter().find(|(_, axis)| is_along(axis)) {
            Some((across, axis)) => (across.map(Clone::clone), axis.clone()),
            None => {
                let most = Interval::from(&(&Decimal::power_of_ten(1) * &Decimal::whole(9)));
                let along = if normal[0].abs().upper < most.lower { &x } else { &y };
                let share = dot(&normal, along);
                let first = unit(&[0, 1, 2].map(|k| &along[k] - &(&normal[k] * &share)))?;
                ([first.clone(), cross(&normal, &first)], normal)
            }
        };
        let off = axes.iter().zip(slides).map(|(axis, slides)| {
            if slides { dot(axis, &normal).magnitude() } else { size(&cross(axis, &normal)).upper }
        });
        let off = off.max().expect("two axes");
        Some(Self { across, normal, off })
    }

    /// Describes in words how much the joints deviate from the plane. Empty if the deviation is only rounding.
    pub fn idealized(&self) -> String {
        let is_within = |digits: &u32| Interval::from(&Decimal::power_of_ten(*digits)).lower >= self.off;
        match (0..=ROUNDING_DECIMALS).rev().find(is_within) {
            Some(ROUNDING_DECIMALS) => String::new(),
            digits => {
                let digits = digits.unwrap_or(0);
                format!("; the joints' axes are up to 1e-{digits} rad off the assumed common plane")
            }
        }
    }

    /// Returns the two plane coordinates of a vector.
    pub fn flat(&self, v: &Vector) -> Point {
        self.across.each_ref().map(|along| dot(v, along))
    }

    /// Returns the coordinate of a vector along the normal.
    pub fn height(&self, v: &Vector) -> Interval {
        dot(v, &self.normal)
    }

    /// Returns the projection of an axis onto the plane, scaled to unit length. `None` if the axis may be perpendicular
    /// to the plane.
    pub fn direction(&self, axis: &Vector) -> Option<Point> {
        let flat = self.flat(axis);
        // A vector in the plane already has unit length.
        if self.height(axis).is_whole(0) {
            return Some(flat);
        }
        let size = cplan_check::interval::length(&flat);
        (size.lower.sign() == Sign::Plus).then(|| flat.map(|c| c.divided(&size)))
    }

    /// Returns the axis about which positive angles turn to the left in the plane.
    pub fn left(&self) -> Vector {
        cross(&self.across[0], &self.across[1])
    }

    /// Returns the pose of a root frame that is turned in the plane by an angle and placed at a point.
    pub fn placed(&self, at: &Corner, angle: &Interval) -> Pose {
        let [x, y] = at.each_ref().map(Interval::from);
        let [u, v] = &self.across;
        let at = [0, 1, 2].map(|k| &(&u[k] * &x) + &(&v[k] * &y));
        Pose { at, ..Pose::turn(&self.left(), angle) }
    }
}

fn unit(v: &Vector) -> Option<Vector> {
    let size = size(v);
    (size.lower.sign() == Sign::Plus).then(|| v.each_ref().map(|c| c.divided(&size)))
}
