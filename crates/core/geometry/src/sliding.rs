//! The interval of displacements at which a sliding convex shape meets a fixed one.

use super::meet::sides;
use super::turning::ROUNDING;
use super::{Convex, Point, Vector, cross};

/// Returns the closed interval of all `s` for which `part`, moved by `s * direction`, is within `grow` of `piece`. The
/// shapes are convex, so there is at most one interval. `direction` is a unit vector. `O(n m)`.
///
/// If `grow` is negative, the shapes must overlap by this depth, which must not exceed the sum of the radii. Exact up
/// to [`ROUNDING`]. Touching counts.
pub fn sliding(part: &Convex, direction: Vector, piece: &Convex, grow: f64) -> Option<[f64; 2]> {
    let part_track = along_and_across(part.core().iter(), Vector::zeros(), direction);
    let piece_track = along_and_across(piece.core().iter(), Vector::zeros(), direction);
    sliding_tracks(&part_track, &piece_track, part.radius() + piece.radius() + grow)
}

/// Returns corners relative to `origin`, as coordinates along and across `direction`.
pub fn along_and_across<'a>(
    corners: impl Iterator<Item = &'a Point>,
    origin: Vector,
    direction: Vector,
) -> Vec<Vector> {
    corners
        .map(|p| {
            let v = p - origin;
            Vector::new(direction.dot(&v), cross(direction, v))
        })
        .collect()
}

/// Like [`sliding`], for cores in coordinates along and across the direction.
///
/// The line of motion must be within the Minkowski difference of piece and part, grown by `radius`. The outline of this
/// difference consists of differences between a corner of one core and a side of the other. All such differences belong to the
/// Minkowski difference, so the interval extends from the least to the greatest of their crossings with the line.
pub fn sliding_tracks(part: &[Vector], piece: &[Vector], radius: f64) -> Option<[f64; 2]> {
    debug_assert!(radius >= 0.0, "shapes that overlap do not touch: {radius}");
    let mut interval: Option<[f64; 2]> = None;
    let mut include = |s: f64| {
        interval = Some(interval.map_or([s, s], |[low, high]| [low.min(s), high.max(s)]));
    };
    for a in part {
        for p in piece {
            let d = p - a;
            // A corner counts as on the line if it is on the line up to rounding.
            let square = radius * radius - d.y * d.y;
            if square >= 0.0 || d.y.abs() <= radius + ROUNDING / 2.0 {
                let half = square.max(0.0).sqrt();
                include(d.x - half);
                include(d.x + half);
            }
        }
    }
    for (p, q) in sides(piece) {
        for a in part {
            cross_line(p - a, q - a, radius, &mut include);
        }
    }
    for (a, b) in sides(part) {
        for p in piece {
            cross_line(p - b, p - a, radius, &mut include);
        }
    }
    interval
}

/// Calls `include` with the places where the segment from `p` to `q`, moved by `radius` to either side, crosses the first axis.
fn cross_line(p: Vector, q: Vector, radius: f64, include: &mut impl FnMut(f64)) {
    let along = q - p;
    // A segment parallel to the axis has no crossing. Its ends are tested separately.
    if along.y == 0.0 {
        return;
    }
    let shift = along / along.norm() * radius;
    let shifts: &[f64] = if radius > 0.0 { &[-1.0, 1.0] } else { &[0.0] };
    for hand in shifts {
        let start = p + Vector::new(-shift.y, shift.x) * *hand;
        let t = -start.y / along.y;
        if (0.0..=1.0).contains(&t) {
            include(start.x + t * along.x);
        }
    }
}
