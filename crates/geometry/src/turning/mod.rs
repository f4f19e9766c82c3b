//! At which angles a turning convex shape meets a fixed one: closed form, no sampling.
//!
//! A shape that turns about a pivot begins or ceases to meet a fixed one when one of three things happens: a corner of
//! the moving shape comes to lie on a side of the fixed one, a corner of the fixed one on a side of the moving one, or
//! (with rounded shapes) two corners come as close as the radii add up to. Each fixes the turned corner's coordinates
//! along and across the side by one square root. A contact is *true*, an end of a forbidden arc, when nothing of the
//! shapes overlaps there; as both are convex, the neighbours of the corners that touch decide that alone. Which end it
//! is follows from the sign of the root.
//!
//! Every such decision is a comparison of a length with zero. Where one is too close for rounding
//! ([`touching`]), the pair takes the exhaustive way instead ([`critical`]): all critical angles, sorted, one
//! distance between neighbours. A bar about the pivot, the usual link, has a shorter way ([`bar`]).

mod bar;
mod critical;
mod features;
mod touching;

use super::{Convex, Point, Pose, Vector, separation};
use critical::critical_arcs;
pub use features::Features;
pub use features::product;
use std::f64::consts::{PI, TAU};
use touching::Placement;

/// Bound on the error of a contact, as a distance between the shapes, metres: any angle (or stretch) left out keeps
/// them at least `grow - ROUNDING` apart, any one that is named brings them within `grow + ROUNDING`. Coordinates up to
/// some 100 m lose about 1e-13 m in the formulas here; the rest is margin. As an angle the error can be larger: the
/// square root of it where shapes graze each other.
pub const ROUNDING: f64 = 1e-9;

/// For which values of a joint a part meets a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hits {
    /// The shapes meet for no value.
    Never,
    /// The shapes meet for every value.
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
        // No contact begins or ends: one configuration stands for all.
        Ok(ends) if ends.is_empty() => {
            let pose = Pose::new(pivot.coords, 0.0);
            let distance = separation(&part.shape.at(&pose), &piece.shape).distance - grow;
            if distance <= ROUNDING / 2.0 { Hits::Always } else { Hits::Never }
        }
        Ok(ends) => ends.arcs(out).map_or_else(|_| critical_arcs(&placement, out), |()| Hits::Within),
        Err(_) => critical_arcs(&placement, out),
    }
}

/// The copy of an arc that starts in `[-pi, pi)`.
pub fn normalized([start, end]: [f64; 2]) -> [f64; 2] {
    let wrapped = wrap(start);
    [wrapped, wrapped + (end - start)]
}

/// The copy of an angle in `[-pi, pi)`.
fn wrap(angle: f64) -> f64 {
    if (-PI..PI).contains(&angle) {
        return angle;
    }
    let wrapped = (angle + PI).rem_euclid(TAU) - PI;
    if wrapped >= PI { -PI } else { wrapped }
}
