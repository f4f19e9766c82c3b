//! At which angles, or along which stretch, a moving convex shape meets a fixed one: closed form, no sampling.
//!
//! A shape that turns about a pivot begins or ceases to meet a fixed one when one of three things happens: a corner of
//! the moving shape comes to lie on a side of the fixed one, a corner of the fixed one on a side of the moving one, or
//! (with rounded shapes) two corners come as close as the radii add up to. Each fixes the turned corner's coordinates
//! along and across the side by one square root. A contact is *true*, an end of a forbidden arc, when nothing of the
//! shapes overlaps there; as both are convex, the neighbours of the corners that touch decide that alone. Which end it
//! is follows from the sign of the root.
//!
//! Every such decision is a comparison of a length with zero. Where one is too close for rounding ([`DOUBT`]), the pair
//! takes the patient way instead ([`super::critical`]): all critical angles, sorted, one distance between neighbours.

use super::critical::critical_arcs;
use super::features::{Features, product, quotient};
use crate::geometry::{Convex, Point, Pose, Vector, separation};
use crate::space::Axis;
use std::f64::consts::{PI, TAU};

/// Bound on the error of a contact, as a distance between the shapes, metres: any angle (or stretch) left out keeps
/// them at least `grow - ROUNDING` apart, any one that is named brings them within `grow + ROUNDING`. Coordinates up to
/// some 100 m lose about 1e-13 m in the formulas here; the rest is margin. As an angle the error can be larger: the
/// square root of it where shapes graze each other.
pub const ROUNDING: f64 = 1e-9;

/// A comparison of lengths closer than this, in metres, is not trusted to rounding.
const DOUBT: f64 = 1e-9;

/// A corner whose path grazes a line: relative excess of its squared distance below which the square root has lost too
/// many digits (half of them at 1e-16) for [`DOUBT`].
const GRAZING: f64 = 1e-8;

/// More ends than this for one pair of convex shapes are left to the patient way, so that none is allocated here.
const MOST_ENDS: usize = 16;

/// For which values of a joint a part meets a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hits {
    /// For none.
    Never,
    /// For all.
    Always,
    /// For those in the intervals that were pushed. Angles: start in `[-pi, pi)`, end at least the start and less than a
    /// turn beyond it, disjoint, in the order of their starts.
    Within,
}

/// Closed arcs of angles `phi` at which `part`, turned by `phi` about the origin and then moved to `pivot`, comes within
/// `grow >= 0` of `piece`; pushed on `out`. Exact up to [`ROUNDING`]; touching counts. `O(n m)`.
pub fn turning(part: &Convex, pivot: Point, piece: &Convex, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
    turning_from(&Features::new(part), pivot, Vector::x(), &Features::new(piece), grow, out)
}

/// [`turning`] for prepared shapes, with angles counted from the direction of the unit vector `zero`.
///
/// Does not allocate, but for `out` and in degenerate positions.
pub fn turning_from(
    part: &Features,
    pivot: Point,
    zero: Vector,
    piece: &Features,
    grow: f64,
    out: &mut Vec<[f64; 2]>,
) -> Hits {
    let radius = part.shape.radius() + piece.shape.radius() + grow;
    let (near, far) = piece.distances(pivot);
    if near > part.outer + radius || far + radius < part.inner {
        return Hits::Never;
    }
    let reach = (near - radius, far + radius);
    let mut ends = Ends::default();
    let clear = touching(part, pivot, zero, piece, radius, reach, &mut ends).is_some();
    if clear && ends.count == [0, 0] {
        // No contact begins or ends: one posture stands for all.
        let pose = Pose::new(pivot.coords, 0.0);
        let distance = separation(&part.shape.at(&pose), &piece.shape).distance - grow;
        return if distance <= ROUNDING / 2.0 { Hits::Always } else { Hits::Never };
    }
    if clear && ends.arcs(out) { Hits::Within } else { critical_arcs(part, pivot, zero, piece, radius, out) }
}

/// Where the forbidden arcs begin and end.
#[derive(Default)]
struct Ends {
    starts: [f64; MOST_ENDS],
    ends: [f64; MOST_ENDS],
    count: [usize; 2],
}

impl Ends {
    /// Notes the end (or start) at the angle of `direction`. None when there are too many.
    fn push(&mut self, start: bool, direction: Vector) -> Option<()> {
        let angle = direction.y.atan2(direction.x);
        let (list, count) =
            if start { (&mut self.starts, &mut self.count[0]) } else { (&mut self.ends, &mut self.count[1]) };
        *list.get_mut(*count)? = if angle >= PI { -PI } else { angle };
        *count += 1;
        Some(())
    }

    /// Pairs each start with the end that follows. False, and nothing pushed, when they do not clearly alternate.
    fn arcs(&mut self, out: &mut Vec<[f64; 2]>) -> bool {
        let n = self.count[0];
        if n != self.count[1] {
            return false;
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
        let clear = (0..n).all(|i| ends[i] - starts[i] > DOUBT && next_start(i) - ends[i] > DOUBT);
        if clear {
            out.extend((0..n).map(|i| [starts[i], ends[i]]));
        }
        clear
    }
}

/// All true contacts; `reach` bounds the distances from the pivot at which there can be any. None in doubt.
fn touching(
    part: &Features,
    pivot: Point,
    zero: Vector,
    piece: &Features,
    radius: f64,
    reach: (f64, f64),
    ends: &mut Ends,
) -> Option<()> {
    corners_on_fixed_sides(part, pivot, zero, piece, radius, reach, ends)?;
    for corner in &piece.corners {
        let at = corner.at - pivot.coords;
        let distance2 = at.norm_squared();
        if distance2 == 0.0 {
            continue;
        }
        let heading = quotient(at, zero);
        let polar = corner.to_neighbors.map(|v| quotient(v, at) / distance2);
        let polar = &polar[..piece.corners.len().min(2)];
        for side in &part.sides {
            // In the part's frame the corner lies at `along` the normal and `across` it.
            let along = side.offset + radius;
            let across2 = distance2 - along * along;
            if across2 < GRAZING * distance2 {
                grazing(across2, distance2, side.from, side.to)?;
                continue;
            }
            let root = across2.sqrt();
            for (across, start) in [(-root, true), (root, false)] {
                let foot = (across - side.from).min(side.to - across);
                if foot >= -DOUBT
                    && decided(polar.iter().map(|w| along * w.x - across * w.y).fold(foot, f64::min), DOUBT)?
                {
                    ends.push(start, quotient(quotient(heading, Vector::new(along, across)), side.normal))?;
                }
            }
        }
        if radius > 0.0 {
            corners_at_distance(
                part,
                at,
                distance2.sqrt(),
                heading,
                &corner.to_neighbors,
                polar.len(),
                radius,
                reach,
                ends,
            )?;
        }
    }
    Some(())
}

/// Contacts of the part's corners with sides of the piece.
fn corners_on_fixed_sides(
    part: &Features,
    pivot: Point,
    zero: Vector,
    piece: &Features,
    radius: f64,
    reach: (f64, f64),
    ends: &mut Ends,
) -> Option<()> {
    let neighbors = part.corners.len().min(2);
    for corner in &part.corners {
        if corner.distance2 == 0.0 || corner.distance < reach.0 || corner.distance > reach.1 {
            continue;
        }
        for side in &piece.sides {
            let along = side.offset - side.normal.dot(&pivot.coords) + radius;
            let across2 = corner.distance2 - along * along;
            let shift = side.normal.x * pivot.y - side.normal.y * pivot.x;
            let (from, to) = (side.from - shift, side.to - shift);
            if across2 < GRAZING * corner.distance2 {
                grazing(across2, corner.distance2, from, to)?;
                continue;
            }
            let root = across2.sqrt();
            for (across, start) in [(root, true), (-root, false)] {
                let foot = (across - from).min(to - across);
                if foot < -DOUBT {
                    continue;
                }
                let polar = corner.polar[..neighbors].iter();
                if decided(polar.map(|w| along * w.x - across * w.y).fold(foot, f64::min), DOUBT)? {
                    let turned = product(Vector::new(along, across), side.normal);
                    ends.push(start, quotient(quotient(turned, corner.at), zero))?;
                }
            }
        }
    }
    Some(())
}

/// Contacts of the part's corners with the rounded corner of the piece at `at` from the pivot.
#[allow(clippy::too_many_arguments)]
fn corners_at_distance(
    part: &Features,
    at: Vector,
    distance: f64,
    heading: Vector,
    to_neighbors: &[Vector; 2],
    neighbors: usize,
    radius: f64,
    reach: (f64, f64),
    ends: &mut Ends,
) -> Option<()> {
    // Directions between corners `radius` apart lose digits as the radius shrinks.
    let doubt = DOUBT + 1e-13 / radius;
    let toward = at / distance;
    for corner in &part.corners {
        let excess = corner.distance - distance;
        let gap = radius - excess.abs();
        if corner.distance2 == 0.0 || gap < -DOUBT * radius || corner.distance < reach.0 || corner.distance > reach.1 {
            continue;
        }
        let sum = corner.distance + distance;
        if sum - radius < DOUBT {
            // The circle of the one lies inside the other's: no crossing.
            if sum - radius < -DOUBT {
                continue;
            }
            return None;
        }
        if gap < 1e-6 * radius {
            return None;
        }
        // The turned corner lies at `along` and `across` the direction from the pivot to the piece's corner, at `beyond`
        // and `across` from that corner. The product form keeps its digits for small radii.
        let beyond = (excess * sum - radius * radius) / (2.0 * distance);
        let along = distance + beyond;
        let root = ((sum - radius) * (sum + radius) * gap * (radius + excess.abs())).sqrt() / (2.0 * distance);
        for (across, start) in [(-root, true), (root, false)] {
            let turned = Vector::new(along, across);
            let apart = Vector::new(beyond, across);
            let fixed = product(apart, toward);
            let moving = quotient(turned, apart);
            let margin_fixed = to_neighbors[..neighbors].iter().map(|v| -fixed.dot(v));
            let margin_moving =
                corner.polar[..part.corners.len().min(2)].iter().map(|w| moving.x * w.x - moving.y * w.y);
            let margin = margin_fixed.chain(margin_moving).fold(f64::INFINITY, f64::min) / radius;
            if decided(margin, doubt)? {
                ends.push(start, quotient(product(turned, heading), corner.at))?;
            }
        }
    }
    Some(())
}

/// Whether a length is positive; none if that is in doubt.
fn decided(margin: f64, doubt: f64) -> Option<bool> {
    if margin.abs() <= doubt { None } else { Some(margin > 0.0) }
}

/// A corner that hardly reaches a line touches it near 0 along its tangent: none if that may be on the side.
fn grazing(across2: f64, distance2: f64, from: f64, to: f64) -> Option<()> {
    let blur = (GRAZING * distance2).sqrt() * 2.0 + DOUBT;
    let reaches = across2 >= -GRAZING * distance2 && from <= blur && to >= -blur;
    if reaches { None } else { Some(()) }
}

/// The copy of an arc that starts in `[-pi, pi)`.
pub(super) fn normalized([start, end]: [f64; 2]) -> [f64; 2] {
    let wrapped = Axis::Circle.wrap(start);
    [wrapped, wrapped + (end - start)]
}
