//! Limits of a sum of both joint values, as an elbow motor that is mounted on the base has them.

use crate::decimal::Decimal;
use crate::domain::{Domain, Range, Rectangle};
use num_bigint::BigInt;

/// Number of halvings of the range of joint 1 for the rectangles of [`JointSum::outside`].
const HALVINGS: u32 = 12;

/// The limits of `ratio q1 + q2`, as enclosures, because angles in degrees are not exact in radians.
pub struct JointSum {
    /// Factor of joint 1.
    pub ratio: Decimal,
    /// Enclosures of the least and the greatest sum.
    pub limits: [Range; 2],
}

impl JointSum {
    /// Returns the sum for two joint values.
    pub fn of(&self, first: &Decimal, second: &Decimal) -> Decimal {
        &(&self.ratio * first) + second
    }

    /// Returns rectangles of the domain in which the sum violates the limits everywhere. Each spans one of many parts
    /// of joint 1's range. Parts also begin and end where `boxes` do.
    pub fn outside(&self, domain: &Domain, boxes: &[Rectangle]) -> Vec<Rectangle> {
        let [[left, right], [bottom, top]] = &domain.ranges;
        let width = &(right - left) * &Decimal::dyadic(&BigInt::from(1), HALVINGS);
        let mut ends: Vec<Decimal> = (0..=1 << HALVINGS).map(|k| left + &(&width * &Decimal::whole(k))).collect();
        ends.extend(boxes.iter().flat_map(|b| b[0].clone()).filter(|end| left < end && end < right));
        ends.sort();
        ends.dedup();
        let of_part = |part: &[Decimal]| {
            let turned = [&self.ratio * &part[0], &self.ratio * &part[1]];
            let (least, most) = (turned.iter().min().expect("two"), turned.iter().max().expect("two"));
            let (below, above) = (&self.limits[0][0] - most, &self.limits[1][1] - least);
            let sides = [[bottom.clone(), below.min(top.clone())], [above.max(bottom.clone()), top.clone()]];
            let first = [part[0].clone(), part[1].clone()];
            sides.into_iter().filter(|[from, to]| from < to).map(move |side| [first.clone(), side])
        };
        ends.windows(2).flat_map(of_part).collect()
    }
}
