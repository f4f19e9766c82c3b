//! The exhaustive method for arcs of contact: all critical angles, and one distance between each two neighbours.

use super::features::quotient;
use super::touching::Placement;
use super::{Hits, ROUNDING, normalized, wrap};
use crate::{Pose, Vector, separation};
use std::f64::consts::{PI, TAU};

/// Critical angles that differ by less than this are treated as one, radians. A turn by it moves no point of a 100 m
/// arm by more than a tenth of [`ROUNDING`].
const ANGLE_TOLERANCE: f64 = 1e-12;

/// Excess of a cosine over 1 that still counts as grazing, so that contacts that rounding would hide are examined.
const GRAZING_COSINE: f64 = 1e-7;

/// Computes the arcs of [`super::turning_from`] correctly even in degenerate positions. Computes the distance at the critical
/// angles, and halfway between neighbours, with a margin of [`ROUNDING`] in favour of contact. `O(n m)` angles and distances.
pub(super) fn critical_arcs(placement: &Placement<'_>, out: &mut Vec<[f64; 2]>) -> Hits {
    let &Placement { part, pivot, zero, piece, radius, .. } = placement;
    let mut angles = critical_angles(placement);
    let zero_angle = zero.y.atan2(zero.x);
    angles.iter_mut().for_each(|angle| *angle = wrap(*angle - zero_angle));
    angles.sort_unstable_by(f64::total_cmp);
    angles.dedup_by(|b, a| *b - *a <= ANGLE_TOLERANCE);

    let allowed = radius - part.shape().radius() - piece.shape().radius() + ROUNDING / 2.0;
    let meets = |angle: f64| {
        let pose = Pose::new(pivot, angle + zero_angle);
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

/// Returns every angle at which a corner lies on the line of a side (at `radius`), or two corners are `radius` apart.
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
            let along = side.offset - side.normal.dot(&pivot) + radius;
            solve(quotient(side.normal, a.at), along / a.distance);
        }
    }
    for p in &piece.corners {
        let at = p.at - pivot;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Convex, Features, Point};

    fn regular(corners: u8, size: f64, radius: f64) -> Convex {
        let corner = |k: u8| {
            let angle = 0.3 + TAU * f64::from(k) / f64::from(corners);
            Point::new(size * angle.cos(), size * angle.sin())
        };
        Convex::trusted((0..corners).map(corner).collect(), radius)
    }

    /// Tests that in general position both methods give the same arcs, and that no comparison is undecided.
    #[test]
    fn the_local_and_the_exhaustive_test_agree() {
        let bar = [(0.0, -0.05), (0.8, -0.05), (0.8, 0.05), (0.0, 0.05)].map(|(x, y)| Point::new(x, y)).to_vec();
        let parts =
            [Convex::trusted(bar.clone(), 0.0), Convex::trusted(bar, 0.02), regular(2, 0.5, 0.1), regular(5, 0.4, 0.0)];
        let pieces = [regular(1, 0.2, 0.1), regular(2, 0.3, 0.0), regular(4, 0.3, 0.0), regular(7, 0.3, 0.05)];
        let mut compared = 0;
        for (i, (part, piece)) in parts.iter().flat_map(|a| pieces.iter().map(move |b| (a, b))).enumerate() {
            let (part, piece) = (Features::new(part), Features::new(piece));
            for k in 0..200 {
                let (distance, angle) = (f64::from(k) * 0.0061 + 0.0137, f64::from(k) * 2.4 + 0.1 * i as f64);
                let pivot = Point::new(distance * angle.cos(), distance * angle.sin());
                let radius = part.shape().radius() + piece.shape().radius();
                let zero = Vector::new(0.6, 0.8);
                let reach = (0.0, f64::INFINITY);
                let placement = Placement { part: &part, pivot, zero, piece: &piece, radius, reach };
                let (mut local, mut exhaustive) = (Vec::new(), Vec::new());
                let hits = critical_arcs(&placement, &mut exhaustive);
                let ends = placement.ends().unwrap_or_else(|_| panic!("doubt at {pivot} for {part:?} and {piece:?}"));
                if ends.is_empty() {
                    assert_ne!(hits, Hits::Within);
                    continue;
                }
                assert!(ends.arcs(&mut local).is_ok());
                assert_eq!(local.len(), exhaustive.len(), "{local:?} {exhaustive:?}");
                for (a, b) in local.iter().zip(&exhaustive) {
                    assert!((a[0] - b[0]).abs() < 1e-7 && (a[1] - b[1]).abs() < 1e-7, "{local:?} {exhaustive:?}");
                }
                compared += 1;
            }
        }
        assert!(compared > 1000, "only {compared} positions have arcs");
    }
}
