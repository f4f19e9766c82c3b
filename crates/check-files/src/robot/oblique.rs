//! What cylinders cover in the plane that do not stand on it.

use cplan_check::interval::{BITS, Interval, Point, length, sum};
use cplan_check::shapes::Outline;
use num_bigint::Sign;

/// Steps along half of the ellipse that a cylinder's end is in the plane.
const ELLIPSE_STEPS: i32 = 16;

/// From this share of its radius on, an oblique cylinder's end is taken as a disc or, lying, a rectangle.
const OBLIQUE: u32 = 200;

/// A cylinder whose axis is out of the plane by less than this power of a half counts as lying.
const LYING: u64 = 44;

/// A core and a radius for the projection of a cylinder that does not stand: the hull of two ellipses, of half-axes `radius` across the
/// projected axis and `radius * tilt` along it, at its ends. Points of the core are as far beyond the middle as they are before it.
pub fn oblique(
    along: &Point,
    tilt: &Interval,
    radius: &Interval,
    half: &Interval,
    outline: Outline,
) -> (Vec<Point>, Interval) {
    let end = along.each_ref().map(|c| c * half);
    let length = length(along);
    let (one, least) = (Interval::whole(1), Interval::whole(1).over(OBLIQUE));
    // A turn by so much that its enclosure says nothing is such a case, too.
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
        Outline::Within if tilt.upper.bits() + LYING < u64::from(BITS) => [0, 2 * ELLIPSE_STEPS].map(rim).to_vec(),
        Outline::Within => (0..=ELLIPSE_STEPS).map(|k| rim(2 * k)).collect(),
    };
    (half_way.iter().map(|by| sum(&end, by)).collect(), Interval::whole(0))
}
