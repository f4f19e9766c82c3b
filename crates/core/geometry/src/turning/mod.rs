//! The angles at which a turning convex shape meets a fixed one, in closed form.
//!
//! A shape that turns about a pivot can begin or cease to meet a fixed one in three cases: a corner of the moving shape
//! is on a side of the fixed one; a corner of the fixed shape is on a side of the moving one; or, with rounded shapes,
//! the distance of two corners is the sum of the radii. In each case, one square root gives the coordinates of the
//! turned corner along and across the side.
//!
//! A contact is a *true* contact, that is, an end of a forbidden arc, if the shapes do not overlap there. As both are
//! convex, the neighbours of the touching corners decide this. The sign of the root distinguishes starts from ends.
//!
//! Each such decision compares a length with zero ([`touching`]). If a length is too close to zero, the exhaustive
//! method ([`critical`]) replaces this one: it sorts all critical angles, and computes a distance between each two
//! neighbours. A bar about the pivot, the usual link, has a faster method ([`bar`]).

mod bar;
mod critical;
mod features;
mod touching;

use super::{Convex, Point, Pose, Vector, separation};
use critical::critical_arcs;
pub use features::{Features, product};
use std::f64::consts::{PI, TAU};
use touching::Placement;

/// Bound on the error of a contact, as a distance between the shapes, metres. At any angle (or displacement) outside
/// the result the shapes are at least `grow - ROUNDING` apart. At any angle in the result they are within
/// `grow + ROUNDING`.
///
/// The error of the formulas is about 1e-13 m for coordinates up to about 100 m. The rest is margin. Where shapes graze
/// each other, the error of an angle can be as large as the square root of this bound.
pub const ROUNDING: f64 = 1e-9;

/// States whether a part meets a piece for no, all, or some values of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hits {
    /// The shapes meet for no value.
    Never,
    /// The shapes meet for every value.
    Always,
    /// The shapes meet in the intervals that were appended. Angles start in `[-pi, pi)` and end less than one turn
    /// after the start. The intervals are disjoint and ordered by start.
    Within,
}

/// Appends to `out` the closed arcs of angles `phi` at which `part`, turned by `phi` about the origin and then moved to
/// `pivot`, comes within `grow >= 0` of `piece`. Exact up to [`ROUNDING`]. Touching counts. `O(n m)`.
pub fn turning(part: &Convex, pivot: Point, piece: &Convex, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
    turning_from(&Features::new(part), pivot, Vector::x(), &Features::new(piece), grow, out)
}

/// Like [`turning`], for prepared shapes, with angles measured from the direction of the unit vector `zero`.
///
/// Allocates only for `out` and in degenerate positions.
pub fn turning_from(
    part: &Features,
    pivot: Point,
    zero: Vector,
    piece: &Features,
    grow: f64,
    out: &mut Vec<[f64; 2]>,
) -> Hits {
    let radius = part.shape.radius() + piece.shape.radius() + grow;
    debug_assert!(radius >= 0.0, "shapes that overlap do not touch: {radius}");
    if let Some(bar) = part.bar.as_ref().filter(|_| radius == 0.0)
        && let Some(hits) = bar.arc(pivot, zero, piece, out)
    {
        return hits;
    }
    let (near, far) = piece.distances(pivot);
    if near > part.outer + radius || far + radius < part.inner {
        return Hits::Never;
    }
    let placement = Placement { part, pivot, zero, piece, radius, reach: (near - radius, far + radius) };
    match placement.ends() {
        // If no contact begins or ends, a test at one angle decides for all angles.
        Ok(ends) if ends.is_empty() => {
            let pose = Pose::new(pivot, 0.0);
            let distance = separation(&part.shape.at(&pose), &piece.shape).distance - grow;
            if distance <= ROUNDING / 2.0 { Hits::Always } else { Hits::Never }
        }
        Ok(ends) => ends.arcs(out).map_or_else(|_| critical_arcs(&placement, out), |()| Hits::Within),
        Err(_) => critical_arcs(&placement, out),
    }
}

/// Returns the equivalent arc that starts in `[-pi, pi)`.
pub fn normalized([start, end]: [f64; 2]) -> [f64; 2] {
    let wrapped = wrap(start);
    [wrapped, wrapped + (end - start)]
}

/// Returns the equivalent angle in `[-pi, pi)`.
fn wrap(angle: f64) -> f64 {
    if (-PI..PI).contains(&angle) {
        return angle;
    }
    let wrapped = (angle + PI).rem_euclid(TAU) - PI;
    if wrapped >= PI { -PI } else { wrapped }
}
