//! Planar projections of cylinders whose axes are neither perpendicular to the plane nor in it.

use cplan_check::interval::{BITS, Interval, Point, length, sum};
use cplan_check::shapes::Outline;
use num_bigint::Sign;

/// Number of sides of a polygon that replaces half an ellipse. The ellipse is the projection of a cylinder's end.
const ELLIPSE_STEPS: i32 = 16;

/// Inverse of the tolerance of simple projections, 0.5 %. A disc replaces a projected end that deviates from it by
/// less. A rectangle replaces the cylinder if the projected ends are flatter than this share.
const PROJECTION_TOLERANCE_DIVISOR: u32 = 200;

/// Negative binary logarithm of the greatest slope to the plane with which an axis counts as lying in the plane.
const IN_PLANE_BITS: u64 = 44;

/// Returns the core and the radius of the projection of an oblique cylinder. The projection is the convex hull of two
/// ellipses, one per end, with half-axes `radius` across the projected axis and `radius * tilt` along it. The core is
/// symmetric about the middle.
pub fn oblique(
    along: &Point,
    tilt: &Interval,
    radius: &Interval,
    half: &Interval,
    outline: Outline,
) -> (Vec<Point>, Interval) {
    let end = along.each_ref().map(|c| c * half);
    let length = length(along);
    let (one, least) = (Interval::whole(1), Interval::whole(1).over(PROJECTION_TOLERANCE_DIVISOR));
    // A disc replaces the projected ends, also if the enclosure of the axis is too wide to be useful.
    if length.lower.sign() != Sign::Plus || tilt.lower >= (&one - &least).lower {
        return (vec![end], if outline == Outline::Around { radius.clone() } else { radius * tilt });
    }
    let onward = along.each_ref().map(|c| c.divided(&length));
    let across = [-&(&onward[1] * radius), &onward[0] * radius];
    let bulge = onward.map(|c| &(&c * radius) * tilt);
    // Half an ellipse, in steps of half a side.
    let step = Interval::pi().over(2 * ELLIPSE_STEPS as u32);
    let rim = |k: i32| {
        let [sine, cosine] = (&step * &Interval::whole(k)).sin_cos();
        sum(&across.each_ref().map(|c| c * &cosine), &bulge.each_ref().map(|c| c * &sine))
    };
    let half_way: Vec<Point> = match outline {
        Outline::Around if tilt.upper <= least.upper => [false, true]
            .map(|turned| sum(&bulge, &across.each_ref().map(|c| if turned { -c } else { c.clone() })))
            .to_vec(),
        // The sides touch the ellipse halfway between corners.
        Outline::Around => {
            let grown = &step.sin_cos()[1];
            (0..ELLIPSE_STEPS).map(|k| rim(2 * k + 1).map(|c| c.divided(grown))).collect()
        }
        Outline::Within if tilt.upper.bits() + IN_PLANE_BITS < u64::from(BITS) => {
            [0, 2 * ELLIPSE_STEPS].map(rim).to_vec()
        }
        Outline::Within => (0..=ELLIPSE_STEPS).map(|k| rim(2 * k)).collect(),
    };
    (half_way.iter().map(|by| sum(&end, by)).collect(), Interval::whole(0))
}
