//! True contacts of a turning shape with a fixed one: the ends of the forbidden arcs.

use super::features::{Corner, Features, product, quotient};
use crate::{Point, Vector};
use std::f64::consts::{PI, TAU};

/// Difference of lengths, metres, or of ends of arcs, radians, below which they are not compared, because rounding
/// could change the result. The rounding error is about 1e-11 m for coordinates up to about 100 m, except where the
/// circle of a corner grazes a line.
const COMPARISON_TOLERANCE: f64 = 1e-9;

/// The circle of a corner grazes a line if its squared radius exceeds the line's squared distance by less than this
/// fraction. The square root then has too few digits for [`COMPARISON_TOLERANCE`]: at 1e-16, half of them are lost.
const LINE_GRAZING_TOLERANCE: f64 = 1e-8;

/// Tolerance of directions between corners, in square metres, to be divided by the distance of the corners. Such
/// directions lose digits as the distance becomes small.
const DIRECTION_TOLERANCE: f64 = 1e-13;

/// Two circles graze each other if the gap between their radii equals the contact distance up to this fraction.
const CIRCLE_GRAZING_TOLERANCE: f64 = 1e-6;

/// Largest number of arcs of one pair of convex shapes. The exhaustive method is used for the rare pairs with more arcs.
const MAX_ARCS: usize = 8;

/// The values of a comparison are too close for a certain result.
pub(super) struct UndecidedComparison;

/// Two shapes and their positions.
#[derive(Clone, Copy)]
pub(super) struct Placement<'a> {
    /// The shape that turns about its own origin.
    pub part: &'a Features,
    /// Position of that origin.
    pub pivot: Point,
    /// Unit vector in the direction of angle 0.
    pub zero: Vector,
    /// The fixed shape.
    pub piece: &'a Features,
    /// Distance between the cores that counts as contact, metres.
    pub radius: f64,
    /// Least and greatest distance from the pivot of the part's corners that can touch, metres.
    pub reach: (f64, f64),
}

/// Starts and ends of the forbidden arcs, as angles in `[-pi, pi)`.
#[derive(Default)]
pub(super) struct Ends {
    starts: [f64; MAX_ARCS],
    ends: [f64; MAX_ARCS],
    count: [usize; 2],
}

impl Ends {
    /// Returns true if no arc starts or ends: the shapes meet at all angles or at none.
    pub(super) fn is_empty(&self) -> bool {
        self.count == [0, 0]
    }

    /// Records a start (or an end) at the angle of `direction`.
    fn push(&mut self, start: bool, direction: Vector) -> Result<(), UndecidedComparison> {
        let angle = direction.y.atan2(direction.x);
        let (list, count) =
            if start { (&mut self.starts, &mut self.count[0]) } else { (&mut self.ends, &mut self.count[1]) };
        *list.get_mut(*count).ok_or(UndecidedComparison)? = if angle >= PI { -PI } else { angle };
        *count += 1;
        Ok(())
    }

    /// Joins each start with the next end. Appends nothing if a comparison is undecided.
    pub(super) fn arcs(mut self, out: &mut Vec<[f64; 2]>) -> Result<(), UndecidedComparison> {
        let n = self.count[0];
        if n != self.count[1] {
            return Err(UndecidedComparison);
        }
        let (starts, ends) = (&mut self.starts[..n], &mut self.ends[..n]);
        if n > 1 {
            starts.sort_unstable_by(f64::total_cmp);
            ends.sort_unstable_by(f64::total_cmp);
        }
        if ends[0] < starts[0] {
            ends.rotate_left(1);
            ends[n - 1] += TAU;
        }
        let next_start = |i: usize| if i + 1 < n { starts[i + 1] } else { starts[0] + TAU };
        if (0..n)
            .any(|i| ends[i] - starts[i] <= COMPARISON_TOLERANCE || next_start(i) - ends[i] <= COMPARISON_TOLERANCE)
        {
            return Err(UndecidedComparison);
        }
        out.extend((0..n).map(|i| [starts[i], ends[i]]));
        Ok(())
    }
}

impl Placement<'_> {
    /// Finds the ends of the arcs: all angles at which the shapes touch.
    pub(super) fn ends(&self) -> Result<Ends, UndecidedComparison> {
        let mut ends = Ends::default();
        self.corners_on_fixed_sides(&mut ends)?;
        for corner in &self.piece.corners {
            let at = corner.at - self.pivot;
            let distance2 = at.norm_squared();
            // A corner on the pivot is in contact at all angles, or at none.
            if distance2 > 0.0 {
                self.corner_on_turning_sides(corner, at, distance2, &mut ends)?;
                if self.radius > 0.0 {
                    self.corners_apart(corner, at, distance2.sqrt(), &mut ends)?;
                }
            }
        }
        Ok(ends)
    }

    /// Iterates over the corners of the part that can touch, except those on the pivot.
    fn corners_in_reach(&self) -> impl Iterator<Item = &Corner> {
        let (near, far) = self.reach;
        self.part.corners.iter().filter(move |c| c.distance > 0.0 && near <= c.distance && c.distance <= far)
    }

    /// Finds contacts of corners of the part with sides of the piece.
    fn corners_on_fixed_sides(&self, ends: &mut Ends) -> Result<(), UndecidedComparison> {
        for side in &self.piece.sides {
            // Distance of the side, moved outwards by the radius, from the pivot.
            let along = side.offset - side.normal.dot(&self.pivot) + self.radius;
            let shift = side.normal.x * self.pivot.y - side.normal.y * self.pivot.x;
            let (from, to) = (side.from - shift, side.to - shift);
            for corner in self.corners_in_reach() {
                for (across, start) in crossings(corner.distance2, along, from, to, [true, false])? {
                    let position = Vector::new(along, across);
                    // Both neighbours of the corner must lie beyond the side as well.
                    let margin = corner.polar().iter().map(|&w| product(position, w).x).fold(f64::INFINITY, f64::min);
                    if is_positive(margin.min(foot_margin(across, from, to)), COMPARISON_TOLERANCE)? {
                        ends.push(start, quotient(quotient(product(position, side.normal), corner.at), self.zero))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Finds contacts of a corner of the piece with sides of the part. `at` is its position relative to the pivot. In
    /// the part's frame, the corner turns in the opposite direction.
    fn corner_on_turning_sides(
        &self,
        corner: &Corner,
        at: Vector,
        distance2: f64,
        ends: &mut Ends,
    ) -> Result<(), UndecidedComparison> {
        for side in &self.part.sides {
            let along = side.offset + self.radius;
            for (across, start) in crossings(distance2, along, side.from, side.to, [false, true])? {
                let position = Vector::new(along, across);
                let neighbors = corner.to_neighbors().iter();
                let margin = neighbors.map(|&v| product(position, quotient(v, at)).x).fold(f64::INFINITY, f64::min);
                if is_positive((margin / distance2).min(foot_margin(across, side.from, side.to)), COMPARISON_TOLERANCE)?
                {
                    ends.push(start, quotient(quotient(quotient(at, self.zero), position), side.normal))?;
                }
            }
        }
        Ok(())
    }

    /// Finds corners of the part at the contact distance from a corner of the piece. `at` and `distance` are the
    /// position of this corner relative to the pivot, and its distance from there.
    fn corners_apart(
        &self,
        fixed: &Corner,
        at: Vector,
        distance: f64,
        ends: &mut Ends,
    ) -> Result<(), UndecidedComparison> {
        let radius = self.radius;
        let doubt = COMPARISON_TOLERANCE + DIRECTION_TOLERANCE / radius;
        let toward = at / distance;
        for corner in self.corners_in_reach() {
            let (excess, sum) = (corner.distance - distance, corner.distance + distance);
            let gap = radius - excess.abs();
            // The corner's circle is outside of the circle around the fixed corner, or inside.
            if gap < -CIRCLE_GRAZING_TOLERANCE * radius || sum - radius < -COMPARISON_TOLERANCE {
                continue;
            }
            if gap < CIRCLE_GRAZING_TOLERANCE * radius || sum - radius < COMPARISON_TOLERANCE {
                return Err(UndecidedComparison);
            }
            // In the direction from the pivot to the fixed corner, the turned corner is `beyond` the fixed one. Across
            // this direction, it is at `across`. Products of sums and differences keep the digits of a small radius.
            let beyond = (excess * sum - radius * radius) / (2.0 * distance);
            let across2 = (sum - radius) * (sum + radius) * gap * (radius + excess.abs());
            let root = across2.sqrt() / (2.0 * distance);
            for (across, start) in [(-root, true), (root, false)] {
                let turned = Vector::new(distance + beyond, across);
                let apart = Vector::new(beyond, across);
                // The direction between the corners must lie in the normal cones of both.
                let direction = product(apart, toward);
                let own = quotient(turned, apart);
                let of_fixed = fixed.to_neighbors().iter().map(|v| -direction.dot(v));
                let of_part = corner.polar().iter().map(|&w| product(own, w).x);
                let margin = of_fixed.chain(of_part).fold(f64::INFINITY, f64::min) / radius;
                if is_positive(margin, doubt)? {
                    ends.push(start, quotient(quotient(product(turned, toward), corner.at), self.zero))?;
                }
            }
        }
        Ok(())
    }
}

/// Returns the positions where a circle about the origin crosses a side, at most two. The side is at `along` on its normal, and
/// extends from `from` to `to` on its tangent. Each position has a value of `start`: the first value for the positive root, the
/// second for the negative one. Positions that are clearly not on the side are omitted. Undecided if the circle grazes the side.
fn crossings(
    distance2: f64,
    along: f64,
    from: f64,
    to: f64,
    start: [bool; 2],
) -> Result<impl Iterator<Item = (f64, bool)>, UndecidedComparison> {
    let across2 = distance2 - along * along;
    let grazes = LINE_GRAZING_TOLERANCE * distance2;
    let root = if across2 >= grazes {
        across2.sqrt()
    } else {
        let blur = 2.0 * grazes.sqrt() + COMPARISON_TOLERANCE;
        if across2 > -grazes && from <= blur && to >= -blur {
            return Err(UndecidedComparison);
        }
        f64::NAN
    };
    let on_side = move |across: f64| foot_margin(across, from, to) >= -COMPARISON_TOLERANCE;
    Ok([(root, start[0]), (-root, start[1])].into_iter().filter(move |&(across, _)| on_side(across)))
}

/// Returns the distance of a position on a side's line from the nearest end of the side, positive on the side and
/// negative beyond its ends.
fn foot_margin(across: f64, from: f64, to: f64) -> f64 {
    (across - from).min(to - across)
}

/// Returns true if a length is positive. Undecided if its magnitude is at most `doubt`.
fn is_positive(margin: f64, doubt: f64) -> Result<bool, UndecidedComparison> {
    if margin.abs() <= doubt { Err(UndecidedComparison) } else { Ok(margin > 0.0) }
}
