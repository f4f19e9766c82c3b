//! Rigid motions of the plane.

use super::{Point, Vector};
use nalgebra::UnitComplex;
use serde::{Deserialize, Serialize};
use std::ops::Mul;

/// A rigid motion of the plane: rotation, then translation. It is also the pose of a frame.
///
/// It moves points and displacements differently, but both have the same type. So there is no product of a pose and a
/// vector. Use [`Pose::point`] or [`Pose::direction`].
///
/// ```
/// use cplan_geometry::{Point, Pose, Vector};
///
/// let pose = Pose::translation(Vector::new(5.0, 0.0));
/// assert_eq!(pose.point(Point::new(1.0, 2.0)), Point::new(6.0, 2.0));
/// assert_eq!(pose.direction(Vector::new(1.0, 2.0)), Vector::new(1.0, 2.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Rotation about the origin.
    pub rotation: UnitComplex<f64>,
    /// Translation after the rotation, metres: the place of the frame's origin.
    pub translation: Vector,
}

impl Pose {
    /// Creates a pose from its translation, metres, and its rotation, radians.
    pub fn new(translation: Vector, angle: f64) -> Self {
        Self { rotation: UnitComplex::new(angle), translation }
    }

    /// Creates the identity, which moves nothing.
    pub fn identity() -> Self {
        Self::translation(Vector::zeros())
    }

    /// Creates a rotation about the origin, radians.
    pub fn rotation(angle: f64) -> Self {
        Self::new(Vector::zeros(), angle)
    }

    /// Creates a translation, metres.
    pub fn translation(by: Vector) -> Self {
        Self { rotation: UnitComplex::identity(), translation: by }
    }

    /// Returns the image of a point under the motion, which rotates and translates it.
    #[inline]
    pub fn point(&self, p: Point) -> Point {
        self.rotation * p + self.translation
    }

    /// Returns the image of a displacement under the motion, which only rotates it.
    #[inline]
    pub fn direction(&self, v: Vector) -> Vector {
        self.rotation * v
    }

    /// Returns the point that the motion takes to `p`.
    #[inline]
    pub fn inverse_point(&self, p: Point) -> Point {
        self.rotation.inverse() * (p - self.translation)
    }

    /// Returns the displacement that the motion takes to `v`.
    #[inline]
    pub fn inverse_direction(&self, v: Vector) -> Vector {
        self.rotation.inverse() * v
    }

    /// Returns `other` in the frame of this pose.
    #[must_use]
    pub fn inverse_pose(&self, other: &Self) -> Self {
        let back = self.rotation.inverse();
        Self { rotation: back * other.rotation, translation: back * (other.translation - self.translation) }
    }

    /// Returns the inverse motion.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let back = self.rotation.inverse();
        Self { rotation: back, translation: back * -self.translation }
    }

    /// Returns the motion followed by a translation.
    #[inline]
    #[must_use]
    pub fn shifted(&self, by: Vector) -> Self {
        Self { translation: by + self.translation, ..*self }
    }

    /// Returns the motion preceded by a translation. This moves the pose along the axes of its own frame.
    #[inline]
    #[must_use]
    pub fn shifted_in_frame(&self, by: Vector) -> Self {
        Self { translation: self.translation + self.direction(by), ..*self }
    }
}

/// Returns the motion `first`, followed by `self`.
impl Mul for Pose {
    type Output = Self;

    #[inline]
    fn mul(self, first: Self) -> Self {
        Self {
            rotation: self.rotation * first.rotation,
            translation: self.translation + self.direction(first.translation),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Isometry2, Point2, Translation2};
    use proptest::prelude::*;

    fn bits(v: Vector) -> [u64; 2] {
        [v.x.to_bits(), v.y.to_bits()]
    }

    fn pose_bits(pose: Pose) -> [[u64; 2]; 2] {
        [[pose.rotation.re.to_bits(), pose.rotation.im.to_bits()], bits(pose.translation)]
    }

    fn same(pose: Pose, isometry: Isometry2<f64>) -> bool {
        pose_bits(pose) == pose_bits(Pose { rotation: isometry.rotation, translation: isometry.translation.vector })
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Tests that all results are bitwise equal to those of nalgebra's isometries.
        #[test]
        fn poses_agree_with_nalgebra(v in prop::array::uniform8(-10.0..10.0_f64)) {
            let [a, b, p] = [0, 2, 4].map(|k| Vector::new(v[k], v[k + 1]));
            let (first, second) = (Pose::new(a, v[6]), Pose::new(b, v[7]));
            let (f, s) = (Isometry2::new(a, v[6]), Isometry2::new(b, v[7]));
            prop_assert_eq!(bits(first.point(p)), bits((f * Point2::from(p)).coords));
            prop_assert_eq!(bits(first.direction(p)), bits(f * p));
            prop_assert_eq!(bits(first.inverse_point(p)), bits(f.inverse_transform_point(&Point2::from(p)).coords));
            prop_assert_eq!(bits(first.inverse_direction(p)), bits(f.inverse_transform_vector(&p)));
            prop_assert!(same(first * second, f * s));
            prop_assert!(same(first.inverse(), f.inverse()));
            prop_assert!(same(first.inverse_pose(&second), f.inv_mul(&s)));
            prop_assert!(same(first.shifted(p), Translation2::from(p) * f));
            prop_assert!(same(first.shifted_in_frame(p), f * Translation2::from(p)));
        }
    }
}
