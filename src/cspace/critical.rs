//! The patient way to the arcs of contact: every critical angle, and one distance between neighbours.

use super::contact::{Hits, ROUNDING, normalized};
use super::features::quotient;
use super::touching::Placement;
use crate::geometry::{Pose, Vector, separation};
use crate::space::Axis;
use std::f64::consts::{PI, TAU};

/// Critical angles closer than this are one: a turn by it moves no point of an arm of 100 m by more than a tenth of
/// [`ROUNDING`].
const SAME_ANGLE: f64 = 1e-12;

/// `cos` may exceed 1 by this and still count as grazing, so that a touch lost to rounding is looked at.
const GRAZING_COSINE: f64 = 1e-7;

/// The arcs of [`super::contact::turning_from`] right in every degenerate position: on the
/// critical angles themselves and halfway between neighbours the distance decides, with [`ROUNDING`] in favour of
/// contact. `O(n m)` critical angles and as many distances.
pub(super) fn critical_arcs(placement: &Placement<'_>, out: &mut Vec<[f64; 2]>) -> Hits {
    let &Placement { part, pivot, zero, piece, radius, .. } = placement;
    let mut angles = critical_angles(placement);
    let zero_angle = zero.y.atan2(zero.x);
    angles.iter_mut().for_each(|angle| *angle = Axis::Circle.wrap(*angle - zero_angle));
    angles.sort_unstable_by(f64::total_cmp);
    angles.dedup_by(|b, a| *b - *a <= SAME_ANGLE);

    let allowed = radius - part.shape().radius() - piece.shape().radius() + ROUNDING / 2.0;
    let meets = |angle: f64| {
        let pose = Pose::new(pivot.coords, angle + zero_angle);
        separation(&part.shape().at(&pose), piece.shape()).distance <= allowed
    };
    let n = angles.len();
    if n == 0 {
        return if meets(0.0) { Hits::Always } else { Hits::Never };
    }
    let after = |i: usize| if i + 1 < n { angles[i + 1] } else { angles[0] + TAU };
    let between: Vec<bool> = (0..n).map(|i| meets((angles[i] + after(i)) / 2.0)).collect();
    let Some(first_free) = between.iter().position(|b| !b) else {
        return Hits::Always;
    };
    let from = out.len();
    let mut begun: Option<f64> = None;
    for k in 1..=n {
        let i = (first_free + k) % n;
        let before = between[(i + n - 1) % n];
        let angle = if first_free + k < n { angles[i] } else { angles[i] + TAU };
        match (before, between[i]) {
            (false, true) => begun = Some(angle),
            (true, false) => out.extend(begun.take().map(|start| [start, angle])),
            (false, false) if meets(angle) => out.push([angle, angle]),
            _ => {}
        }
    }
    for arc in &mut out[from..] {
        *arc = normalized(*arc);
    }
    out[from..].sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    if out.len() == from { Hits::Never } else { Hits::Within }
}

/// Every angle at which some corner lies on the line of some side (at `radius`), or two corners are `radius` apart.
fn critical_angles(placement: &Placement<'_>) -> Vec<f64> {
    let &Placement { part, pivot, piece, radius, .. } = placement;
    let mut angles = Vec::new();
    let mut solve = |reference: Vector, cosine: f64| {
        if cosine.abs() <= 1.0 + GRAZING_COSINE {
            let (middle, half) = (reference.y.atan2(reference.x), cosine.clamp(-1.0, 1.0).acos());
            angles.extend([middle - half, middle + half]);
            if cosine.abs() > 1.0 - GRAZING_COSINE {
                angles.push(if cosine > 0.0 { middle } else { middle + PI });
            }
        }
    };
    for a in part.corners.iter().filter(|a| a.distance2 > 0.0) {
        for side in &piece.sides {
            let along = side.offset - side.normal.dot(&pivot.coords) + radius;
            solve(quotient(side.normal, a.at), along / a.distance);
        }
    }
    for p in &piece.corners {
        let at = p.at - pivot.coords;
        let distance = at.norm();
        if distance == 0.0 {
            continue;
        }
        for side in &part.sides {
            solve(quotient(at, side.normal), (side.offset + radius) / distance);
        }
        for a in part.corners.iter().filter(|a| a.distance2 > 0.0) {
            let cosine = (a.distance2 + distance * distance - radius * radius) / (2.0 * a.distance * distance);
            solve(quotient(at, a.at), cosine);
        }
    }
    angles
}
