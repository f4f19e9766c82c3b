//! Distance and penetration depth of two convex shapes.

use super::meet::cores_meet;
use super::{Convex, Point, Pose, Vector, perpendicular};

/// Signed distance of two convex shapes, and its direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separation {
    /// The distance of the shapes if they are apart, metres. If they overlap, it is minus their *penetration depth*:
    /// the length of the shortest translation that separates them.
    pub distance: f64,
    /// Unit direction from the first shape to the second, along which `distance` is measured.
    pub direction: Vector,
}

/// Computes the signed distance of two rounded convex polygons. `O(n m)`. For the few corners of typical links and
/// obstacles, this is faster than linear methods.
///
/// For disjoint cores, it is the least distance between their sides, minus both radii. For overlapping cores, it follows from
/// the depth of the origin in their Minkowski difference, whose sides have the normals of the cores' sides.
///
/// The distance is rounded: that of a touching pair may be a few 1e-16 instead of 0. [`super::shapes_meet`] decides exactly.
pub fn separation(a: &Convex, b: &Convex) -> Separation {
    let core = core_separation(a.core(), b.core());
    Separation { distance: core.distance - a.radius() - b.radius(), direction: core.direction }
}

/// Computes the [`separation`] of a shape moved by a pose from another shape, and passes it to `and` with the moved
/// corners. Needs no allocation for shapes with few corners.
pub fn separation_at<R>(a: &Convex, pose: &Pose, b: &Convex, and: impl FnOnce(&[Point], Separation) -> R) -> R {
    const FEW_SIDES: usize = 8;
    let (mut few, many);
    let corners = if a.core().len() <= FEW_SIDES {
        few = [Point::zeros(); FEW_SIDES];
        for (corner, p) in few.iter_mut().zip(a.core()) {
            *corner = pose.point(*p);
        }
        &few[..a.core().len()]
    } else {
        many = a.core().iter().map(|&p| pose.point(p)).collect::<Vec<Point>>();
        &many
    };
    let core = core_separation(corners, b.core());
    and(corners, Separation { distance: core.distance - a.radius() - b.radius(), direction: core.direction })
}

/// Returns the gap along a unit direction between the supporting lines of two shapes: of `a` moved by a pose, and of
/// `b`. It is negative if the shapes overlap along that direction. The [`separation`] is the greatest gap over all
/// directions. `O(n + m)`.
pub fn gap_along(a: &Convex, pose: &Pose, b: &Convex, direction: Vector) -> f64 {
    let own = pose.inverse_direction(direction);
    let of_a = a.core().iter().map(|p| own.dot(p)).fold(f64::NEG_INFINITY, f64::max);
    let of_b = b.core().iter().map(|p| direction.dot(p)).fold(f64::INFINITY, f64::min);
    of_b - of_a - direction.dot(&pose.translation) - a.radius() - b.radius()
}

/// Rounding error of a distance from a side, relative to the largest coordinate. It results from a difference, two products and
/// a sum at coordinates twice as large, and from the error of the normal. Together, these are about 6 epsilon.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

fn core_separation(a: &[Point], b: &[Point]) -> Separation {
    let face_a = best_face(a, b, f64::NEG_INFINITY);
    let most = face_a.map_or(f64::NEG_INFINITY, |face| face.distance);
    let face_b = best_face(b, a, most).map(|face| Face { normal: -face.normal, ..face });
    let face = face_b.or(face_a);
    let error = ROUNDING * largest(a).max(largest(b));
    let Some(Face { distance, normal, is_beside }) = face else { return nearest_features(a, b, error) };
    let face = Separation { distance, direction: normal };
    // The cores are at least as far apart as the gap along any direction. The face and its nearest corner are exactly
    // that far apart.
    if distance < -error || is_beside && distance > 4.0 * error {
        return face;
    }
    // The cores are disjoint, or touch up to rounding. Collinear cores (such as two walls in a row) have no separating
    // side normal. Only their distance distinguishes them from touching cores, whose distance is at most `error`.
    let nearest = nearest_features(a, b, error);
    if nearest.distance > 4.0 * error {
        nearest
    } else if cores_meet(a, b) {
        Separation { distance: face.distance.min(0.0), ..face }
    } else {
        Separation { distance: nearest.distance, ..face }
    }
}

/// Returns the largest absolute coordinate.
fn largest(points: &[Point]) -> f64 {
    points.iter().fold(0.0, |largest: f64, p| largest.max(p.x.abs()).max(p.y.abs()))
}

/// A side of one core compared with another core.
#[derive(Clone, Copy)]
struct Face {
    /// Distance by which the other core lies outside the side.
    distance: f64,
    /// Outward unit normal of the side.
    normal: Vector,
    /// True if the nearest corner of the other core projects onto the side, not beyond its ends.
    is_beside: bool,
}

/// Returns the side of `a` with the greatest signed distance to `b`, which is positive outside. `None` if no side
/// exceeds `most`.
fn best_face(a: &[Point], b: &[Point], mut most: f64) -> Option<Face> {
    let mut best: Option<(f64, Vector, [&Point; 3])> = None;
    for (p, q) in sides(a) {
        let across = -perpendicular(q - p);
        // This test quickly skips sides that face away from the other core.
        if most >= 0.0 && b.iter().any(|v| across.dot(&(v - p)) <= 0.0) {
            continue;
        }
        let Some(normal) = across.try_normalize(0.0) else { continue };
        let mut nearest = (f64::INFINITY, p);
        for v in b {
            let outside = normal.dot(&(v - p));
            if outside < nearest.0 {
                nearest = (outside, v);
                // A side that is no better than the best one so far need not be evaluated further.
                if outside <= most {
                    break;
                }
            }
        }
        if nearest.0 > most {
            (most, best) = (nearest.0, Some((nearest.0, normal, [p, q, nearest.1])));
        }
    }
    best.map(|(distance, normal, [p, q, v])| {
        let (along, from) = (q - p, v - p);
        let foot = along.dot(&from);
        Face { distance, normal, is_beside: 0.0 <= foot && foot <= along.norm_squared() }
    })
}

/// Iterates over the sides of a core: none for one corner, both directions for two.
fn sides(core: &[Point]) -> impl Iterator<Item = (&Point, &Point)> {
    let closing = (core.len() > 1).then(|| (&core[core.len() - 1], &core[0]));
    core.windows(2).map(|ends| (&ends[0], &ends[1])).chain(closing)
}

/// Returns the least distance between the boundaries of two cores that are disjoint, or that overlap by at most `error`.
fn nearest_features(a: &[Point], b: &[Point], error: f64) -> Separation {
    let mut best = Separation { distance: f64::INFINITY, direction: Vector::x() };
    nearest_to_sides(b, a, error, 1.0, &mut best);
    nearest_to_sides(a, b, error, -1.0, &mut best);
    let distance = best.distance.sqrt();
    // Only coincident points have no direction. Any direction is valid for them.
    let direction = if distance > 0.0 { best.direction / distance } else { Vector::x() };
    Separation { distance, direction }
}

/// Relative margin on squared distances from side lines, so that rounding does not hide a better side.
const SIDE_MARGIN: f64 = 1e-12;

/// Looks for a corner closer to a side than the best so far. `best` holds the squared distance, and the offset from the
/// nearest point of the side to the corner, times `sign`.
///
/// The line of a side is at least as close as the side, so its distance suffices to skip most sides. If the core has an
/// area, a side is also skipped if the corner lies inside it by more than `error`. Then the nearest point of the core
/// is on another side, outside of which the corner lies.
fn nearest_to_sides(corners: &[Point], core: &[Point], error: f64, sign: f64, best: &mut Separation) {
    let mut look = |p: &Point, q: &Point, is_one_sided: bool| {
        let along = q - p;
        let length2 = along.norm_squared();
        // Cores that overlap by `error` along a side's normal may overlap by slightly more along the direction computed
        // here.
        let inside = 16.0 * error * error * length2;
        for v in corners {
            let from = v - p;
            // Positive if the corner is to the left of the side, that is, inside.
            let left = along.x * from.y - along.y * from.x;
            let left2 = left * left;
            if left2 > best.distance * length2 * (1.0 + SIDE_MARGIN) || is_one_sided && left > 0.0 && left2 > inside {
                continue;
            }
            let t = from.dot(&along);
            let offset = if t <= 0.0 {
                from
            } else if t >= length2 {
                v - q
            } else {
                // Use the normal instead of a rounded foot on the side, so that small offsets keep their direction.
                let normal = perpendicular(along);
                normal * (normal.dot(&from) / length2)
            };
            let squared = offset.norm_squared();
            if squared < best.distance {
                *best = Separation { distance: squared, direction: offset * sign };
            }
        }
    };
    match core {
        [p] => look(p, p, false),
        [p, q] => look(p, q, false),
        _ => sides(core).for_each(|(p, q)| look(p, q, true)),
    }
}
