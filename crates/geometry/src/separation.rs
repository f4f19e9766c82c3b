//! Distance and penetration depth of two convex shapes.

use super::meet::cores_meet;
use super::{Convex, Point, Pose, Vector, perpendicular};

/// How two convex shapes lie to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separation {
    /// Distance when positive; when negative, minus the *penetration depth*: the shortest translation that
    /// separates the shapes. Metres.
    pub distance: f64,
    /// Unit direction from the first shape to the second along which `distance` is measured.
    pub direction: Vector,
}

/// Signed distance of two rounded convex polygons.
///
/// Disjoint cores: the least distance between their sides, less both radii. Overlapping cores: the depth of the origin
/// in their Minkowski difference, whose side directions are the side normals of the two cores. `O(n m)`, which for the
/// handful of corners that links and obstacles have beats the linear methods.
///
/// A measure, not a predicate: rounding can turn a touching pair's 0 into a few 1e-16. Ask [`super::shapes_meet`] for
/// the exact verdict.
#[must_use]
pub fn separation(a: &Convex, b: &Convex) -> Separation {
    let core = core_separation(a.core(), b.core());
    Separation { distance: core.distance - a.radius() - b.radius(), direction: core.direction }
}

/// The [`separation`] of a shape that is turned and moved by a pose from another, and what `and` makes of its corners there. A shape of few
/// corners is put there without a list of its own.
pub fn separation_at<R>(a: &Convex, pose: &Pose, b: &Convex, and: impl FnOnce(&[Point], Separation) -> R) -> R {
    const FEW: usize = 8;
    let (mut few, many);
    let corners = if a.core().len() <= FEW {
        few = [Point::origin(); FEW];
        for (corner, p) in few.iter_mut().zip(a.core()) {
            *corner = pose * p;
        }
        &few[..a.core().len()]
    } else {
        many = a.core().iter().map(|p| pose * p).collect::<Vec<Point>>();
        &many
    };
    let core = core_separation(corners, b.core());
    and(corners, Separation { distance: core.distance - a.radius() - b.radius(), direction: core.direction })
}

/// How far `b` is from `a`, turned and moved by a pose, along a unit direction: the gap between their supporting lines,
/// negative where they overlap. The [`separation`] is the greatest of these, so none is greater than it. `O(n + m)`.
pub fn gap_along(a: &Convex, pose: &Pose, b: &Convex, direction: Vector) -> f64 {
    let own = pose.inverse_transform_vector(&direction);
    let of_a = a.core().iter().map(|p| own.dot(&p.coords)).fold(f64::NEG_INFINITY, f64::max);
    let of_b = b.core().iter().map(|p| direction.dot(&p.coords)).fold(f64::INFINITY, f64::min);
    of_b - of_a - direction.dot(&pose.translation.vector) - a.radius() - b.radius()
}

/// Rounding error of a side distance, relative to the largest coordinate: a difference, two products and a sum at
/// coordinates twice as large, and the normal's own error, are some 6 epsilon together.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

fn core_separation(a: &[Point], b: &[Point]) -> Separation {
    let face_a = best_face(a, b, f64::NEG_INFINITY);
    let most = face_a.map_or(f64::NEG_INFINITY, |face| face.distance);
    let face_b = best_face(b, a, most).map(|face| Face { normal: -face.normal, ..face });
    let face = face_b.or(face_a);
    let error = ROUNDING * largest(a).max(largest(b));
    let Some(Face { distance, normal, is_beside }) = face else { return nearest_features(a, b, error) };
    let face = Separation { distance, direction: normal };
    // No two points are nearer than the distance along any direction, and these two are as near.
    if distance < -error || is_beside && distance > 4.0 * error {
        return face;
    }
    // Disjoint, or touching up to rounding. Cores that lie apart on one line (as two walls in a row do) are separated by
    // no side normal; only their distance tells them from cores that touch, whose distance is within `error` of 0.
    let nearest = nearest_features(a, b, error);
    if nearest.distance > 4.0 * error {
        nearest
    } else if cores_meet(a, b) {
        Separation { distance: face.distance.min(0.0), ..face }
    } else {
        Separation { distance: nearest.distance, ..face }
    }
}

/// The largest coordinate, whatever its sign.
fn largest(points: &[Point]) -> f64 {
    points.iter().fold(0.0, |largest: f64, p| largest.max(p.x.abs()).max(p.y.abs()))
}

/// A side of one core against another core.
#[derive(Clone, Copy)]
struct Face {
    /// How far outside of the side the other core is.
    distance: f64,
    /// The side's unit normal, outwards.
    normal: Vector,
    /// Whether the other core's corner that is the least outside is beside the side, not beyond its ends.
    is_beside: bool,
}

/// The side of `a` which `b` is farthest outside of (least deep inside), if it is by more than `most` of one.
fn best_face(a: &[Point], b: &[Point], mut most: f64) -> Option<Face> {
    let mut best: Option<(f64, Vector, [&Point; 3])> = None;
    for (p, q) in sides(a) {
        let across = -perpendicular(q - p);
        // Most sides face away from what lies apart, which is soon seen.
        if most >= 0.0 && b.iter().any(|v| across.dot(&(v - p)) <= 0.0) {
            continue;
        }
        let Some(normal) = across.try_normalize(0.0) else { continue };
        let mut nearest = (f64::INFINITY, p);
        for v in b {
            let outside = normal.dot(&(v - p));
            if outside < nearest.0 {
                nearest = (outside, v);
                // What is no better than the best so far need not be known.
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

/// The sides of a core, from corner to corner; none of a single corner, both ways of two.
fn sides(core: &[Point]) -> impl Iterator<Item = (&Point, &Point)> {
    let closing = (core.len() > 1).then(|| (&core[core.len() - 1], &core[0]));
    core.windows(2).map(|ends| (&ends[0], &ends[1])).chain(closing)
}

/// Least distance between the boundaries of two cores that are disjoint, or meet by no more than `error`.
fn nearest_features(a: &[Point], b: &[Point], error: f64) -> Separation {
    let mut best = Separation { distance: f64::INFINITY, direction: Vector::x() };
    nearest_to_sides(b, a, error, 1.0, &mut best);
    nearest_to_sides(a, b, error, -1.0, &mut best);
    let distance = best.distance.sqrt();
    // Only points that coincide have no direction; any will do for them.
    let direction = if distance > 0.0 { best.direction / distance } else { Vector::x() };
    Separation { distance, direction }
}

/// By how much more than the best a distance to a side's line has to be, as a share of its square, so that rounding does not hide
/// a better one.
const SLACK: f64 = 1e-12;

/// Looks for a corner that is nearer to a side than the best so far, which holds the squared distance, and the offset from the
/// nearest point of the side to the corner, times `sign`.
///
/// The line of a side is no farther than the side, so most sides are passed over. So are those of a core with area that have
/// the corner on their inner side by more than some `error`: the nearest point of the core is on one that the corner is outside
/// of, too.
fn nearest_to_sides(corners: &[Point], core: &[Point], error: f64, sign: f64, best: &mut Separation) {
    let mut look = |p: &Point, q: &Point, is_one_sided: bool| {
        let along = q - p;
        let length2 = along.norm_squared();
        // Cores that meet by `error` along a side's normal may do so by a little more along what is computed here.
        let inside = 16.0 * error * error * length2;
        for v in corners {
            let from = v - p;
            // Left of the side, which is inside, if positive.
            let left = along.x * from.y - along.y * from.x;
            let left2 = left * left;
            if left2 > best.distance * length2 * (1.0 + SLACK) || is_one_sided && left > 0.0 && left2 > inside {
                continue;
            }
            let t = from.dot(&along);
            let offset = if t <= 0.0 {
                from
            } else if t >= length2 {
                v - q
            } else {
                // Along the normal, rather than to a rounded foot on the side: keeps the direction of small offsets.
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
