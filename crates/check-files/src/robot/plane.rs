//! The plane that the arm moves in.

use super::pose::{Pose, Vector, cross, dot, size};
use cplan_check::decimal::Decimal;
use cplan_check::interval::{Interval, Point};
use cplan_check::polygon::Corner;
use num_bigint::{BigInt, Sign};

/// Directions within this angle of one another count as one, radians: `10^-3`.
const ALIGNED: u32 = 3;

/// Directions within `10^-12` of one another differ by rounding.
const ROUNDED: u32 = 12;

/// The plane of two joints, in the root frame.
pub struct Plane {
    /// The directions of its two coordinates, ...
    pub across: [Vector; 2],
    /// ... and of heights.
    pub normal: Vector,
    /// The joints' axes are off the normal, or slides off the plane, by no more than this angle's sine.
    pub off: BigInt,
}

impl Plane {
    /// That of two joints, by their axes, of unit length, and whether they slide. None if there is none.
    ///
    /// Its normal is the first axis of a joint that turns, else across both slides. A normal along an axis of the root frame is that: about z
    /// the coordinates are (x, y), about y (x, z), about x (y, z). Else the first is x, or y where x is within half a radian or so of the
    /// normal, as far as it is across that, and the second a quarter of a turn on.
    pub fn common(axes: &[Vector; 2], slides: [bool; 2]) -> Option<Self> {
        let [a, b] = axes;
        let aligned = &Interval::from(&Decimal::power_of_ten(ALIGNED)).sin_cos()[0];
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
        // Angles that are known too little are no directions.
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

    /// By how much the joints are off it that are taken to move in it, in words, if it is more than rounding.
    pub fn idealized(&self) -> String {
        let is_within = |digits: &u32| Interval::from(&Decimal::power_of_ten(*digits)).lower >= self.off;
        match (0..=ROUNDED).rev().find(is_within) {
            Some(ROUNDED) => String::new(),
            digits => {
                let digits = digits.unwrap_or(0);
                format!("; the joints are taken to move in one plane, off which they are by up to 1e-{digits} rad")
            }
        }
    }

    /// A vector in the plane, by its two coordinates.
    pub fn flat(&self, v: &Vector) -> Point {
        self.across.each_ref().map(|along| dot(v, along))
    }

    /// A vector's height.
    pub fn height(&self, v: &Vector) -> Interval {
        dot(v, &self.normal)
    }

    /// A direction in the plane, of unit length; none if it is not known.
    pub fn direction(&self, axis: &Vector) -> Option<Point> {
        let flat = self.flat(axis);
        // What lies in it is of unit length.
        if self.height(axis).is_whole(0) {
            return Some(flat);
        }
        let size = cplan_check::interval::length(&flat);
        (size.lower.sign() == Sign::Plus).then(|| flat.map(|c| c.divided(&size)))
    }

    /// What turns left about this.
    pub fn left(&self) -> Vector {
        cross(&self.across[0], &self.across[1])
    }

    /// The pose of a root frame that is turned in the plane by an angle and stands at a place there.
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
