//! Cuts meshes into layers at given heights.

use super::solid::Surface;
use cplan_check::decimal::Decimal;
use cplan_check::interval::{BITS, Interval, Point, minus, sum, times};
use num_bigint::BigInt;

/// Number of decimals of the least thickness of a layer: `10^-6` m.
const MIN_THICKNESS_DECIMALS: u32 = 6;

/// Number of decimals of the tolerance of layers: `10^-9` m. A vertex belongs to a layer if it is at most this far outside.
const LAYER_TOLERANCE_DECIMALS: u32 = 9;

fn metres(digits: u32) -> BigInt {
    Interval::from(&Decimal::power_of_ten(digits)).lower
}

/// Sorts heights. Drops a height if it is less than the least thickness above the previous one.
pub fn cuts(mut ends: Vec<BigInt>) -> Vec<BigInt> {
    let thinnest = metres(MIN_THICKNESS_DECIMALS);
    ends.sort();
    ends.dedup_by(|next, last| &*next - &*last <= thinnest);
    ends
}

impl Surface {
    /// Cuts the surface into layers. Returns for each layer, from the lowest upwards, points whose convex hull is the
    /// layer, and its heights.
    ///
    /// The result is empty if no cut goes through the surface, or if the edges of the surface are unknown.
    pub fn layers(&self, cuts: &[BigInt]) -> Vec<(Vec<Point>, [Interval; 2])> {
        let [low, high] = self.heights();
        let (thinnest, rounded) = (metres(MIN_THICKNESS_DECIMALS), metres(LAYER_TOLERANCE_DECIMALS));
        let [least, most] = [low.middle().0 + &thinnest, high.middle().0 - &thinnest];
        let cuts: Vec<&BigInt> = cuts.iter().filter(|cut| least < **cut && **cut < most).collect();
        if cuts.is_empty() || self.edges.is_empty() {
            return Vec::new();
        }
        let crossings: Vec<Vec<Point>> = cuts.iter().map(|cut| self.crossings(cut, &rounded)).collect();
        let mut layers = Vec::new();
        for number in 0..=cuts.len() {
            let (below, above) = (number.checked_sub(1), (number < cuts.len()).then_some(number));
            let end = |cut: Option<usize>, own: &Interval| {
                cut.map_or_else(|| own.clone(), |cut| Interval::exact(cuts[cut].clone()))
            };
            let heights = [end(below, &low), end(above, &high)];
            let [from, to] = [&heights[0].lower - &rounded, &heights[1].upper + &rounded];
            let is_within = |height: &Interval| from <= height.upper && height.lower <= to;
            let corners = self.points.iter().filter(|(_, height)| is_within(height)).map(|(at, _)| at.clone());
            let places = below.into_iter().chain(above).flat_map(|cut| crossings[cut].iter().cloned());
            let points: Vec<Point> = corners.chain(places).collect();
            if !points.is_empty() {
                layers.push((points, heights));
            }
        }
        layers
    }

    /// Returns the points where edges cross the height of a cut. Omits edges whose ends are both within the tolerance
    /// of the cut, because these ends already belong to both layers.
    fn crossings(&self, cut: &BigInt, rounded: &BigInt) -> Vec<Point> {
        let [floor, top] = [cut - rounded, cut + rounded];
        let is_at = |height: &Interval| floor <= height.upper && height.lower <= top;
        let place = |&[a, b]: &[usize; 2]| {
            let [mut from, mut to] = [&self.points[a], &self.points[b]];
            if from.1.lower > to.1.lower {
                std::mem::swap(&mut from, &mut to);
            }
            if from.1.lower >= *cut || *cut >= to.1.upper || is_at(&from.1) && is_at(&to.1) {
                return None;
            }
            // Rounding must not move the crossing beyond an end of the edge.
            let share = (&Interval::exact(cut.clone()) - &from.1).divided(&(&to.1 - &from.1));
            let one = BigInt::from(1) << BITS;
            let share = Interval { lower: share.lower.max(BigInt::ZERO), upper: share.upper.min(one) };
            Some(sum(&from.0, &times(&minus(&to.0, &from.0), &share)))
        };
        self.edges.iter().filter_map(place).collect()
    }
}
