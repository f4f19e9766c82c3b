//! Shapes that cover all orientations of a turning shape.

use cplan_geometry::{Convex, Point, Pose, Vector, hull, reach};
use std::f64::consts::FRAC_PI_2;

/// Relative growth of covers. It exceeds rounding errors.
const COVER_ROUNDING: f64 = 1e-12;

/// Returns a convex shape that covers a shape in all its rotations about the origin, from one angle to another.
pub(super) fn cover(shape: &Convex, [from, to]: [f64; 2]) -> Convex {
    let farthest = reach(shape.core(), Point::zeros());
    let rounding = COVER_ROUNDING * (farthest + shape.radius());
    let width = (to - from).abs();
    if width > FRAC_PI_2 {
        return Convex::trusted(vec![Point::zeros()], farthest + shape.radius() + rounding);
    }
    let turned = |angle: f64| shape.at(&Pose::rotation(angle));
    if width == 0.0 {
        return turned(from);
    }
    // Between both angles, a corner moves along an arc, whose distance from the chord is at most the sagitta.
    let corners: Vec<Point> = [from, to].into_iter().flat_map(|angle| turned(angle).core().to_vec()).collect();
    let sagitta = farthest * (1.0 - (width / 2.0).cos());
    Convex::trusted(hull(&corners), shape.radius() + sagitta + rounding)
}

/// Returns a convex shape that covers a shape in all its rotations about an axis, from one angle to another.
pub(super) fn cover_about(axis: Point, shape: &Convex, angles: [f64; 2]) -> Convex {
    let [there, back] = [-axis, axis].map(|by: Vector| Pose::translation(by));
    cover(&shape.at(&there), angles).at(&back)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares covers with rotated shapes: in no direction does a rotated shape extend farther than the cover.
        #[test]
        fn a_cover_has_all_rotations(
            corners in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 1..6),
            radius in 0.0..0.2_f64, from in -7.0..7.0_f64, width in -3.0..3.0_f64,
        ) {
            let corners: Vec<Point> = corners.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            let shape = Convex::trusted(hull(&corners), radius);
            let whole = cover(&shape, [from, from + width]);
            for look in 0..=64 {
                let (sin, cos) = (from + width * f64::from(look) / 64.0).sin_cos();
                for side in 0..48 {
                    let (y, x) = (TAU * f64::from(side) / 48.0).sin_cos();
                    let reach = |points: &[Point]| points.iter().map(|p| p.x * x + p.y * y).fold(f64::MIN, f64::max);
                    let turned: Vec<Point> =
                        shape.core().iter().map(|p| Point::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y)).collect();
                    let [inner, outer] = [reach(&turned) + radius, reach(whole.core()) + whole.radius()];
                    prop_assert!(inner <= outer + 1e-12, "{inner} {outer}");
                }
            }
        }
    }
}
