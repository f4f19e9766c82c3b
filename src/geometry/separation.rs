//! Distance and penetration depth of two convex shapes.

use super::meet::cores_meet;
use super::{Convex, Point, Vector, perpendicular};

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

/// Rounding error of a side distance, relative to the largest coordinate: a difference, two products and a sum at
/// coordinates twice as large, and the normal's own error, are some 6 epsilon together.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

fn core_separation(a: &[Point], b: &[Point]) -> Separation {
    let face_a = best_face(a, b);
    let face_b = best_face(b, a).map(|s| Separation { direction: -s.direction, ..s });
    let face = match (face_a, face_b) {
        (Some(x), Some(y)) => Some(if x.distance >= y.distance { x } else { y }),
        (x, y) => x.or(y),
    };
    let Some(face) = face else { return nearest_features(a, b) };
    let error = ROUNDING * a.iter().chain(b).map(|p| p.coords.amax()).fold(0.0, f64::max);
    if face.distance < -error {
        return face;
    }
    // Disjoint, or touching up to rounding. Cores that lie apart on one line (as two walls in a row do) are separated by
    // no side normal; only their distance tells them from cores that touch, whose distance is within `error` of 0.
    let nearest = nearest_features(a, b);
    if nearest.distance > 4.0 * error {
        nearest
    } else if cores_meet(a, b) {
        Separation { distance: face.distance.min(0.0), ..face }
    } else {
        Separation { distance: nearest.distance, ..face }
    }
}

/// The side normal of `a` along which `b` is farthest outside (least deep inside), if `a` has a side.
fn best_face(a: &[Point], b: &[Point]) -> Option<Separation> {
    let mut best: Option<Separation> = None;
    let n = a.len();
    if n < 2 {
        return None;
    }
    for i in 0..n {
        let (p, q) = (a[i], a[(i + 1) % n]);
        let Some(normal) = (-perpendicular(q - p)).try_normalize(0.0) else { continue };
        let distance = b.iter().map(|v| normal.dot(&(v - p))).fold(f64::INFINITY, f64::min);
        if best.is_none_or(|s| distance > s.distance) {
            best = Some(Separation { distance, direction: normal });
        }
    }
    best
}

/// Least distance between the boundaries of two cores.
fn nearest_features(a: &[Point], b: &[Point]) -> Separation {
    let mut best = Separation { distance: f64::INFINITY, direction: Vector::x() };
    let mut consider = |offset: Vector| {
        let squared = offset.norm_squared();
        if squared < best.distance {
            best = Separation { distance: squared, direction: offset };
        }
    };
    for_each_vertex_side(b, a, &mut consider);
    for_each_vertex_side(a, b, |offset| consider(-offset));
    let distance = best.distance.sqrt();
    // Only points that coincide have no direction; any will do for them.
    let direction = if distance > 0.0 { best.direction / distance } else { Vector::x() };
    Separation { distance, direction }
}

/// Calls `f` with the offset from the nearest point of each side of `sides` to each corner of `corners`.
fn for_each_vertex_side(corners: &[Point], sides: &[Point], mut f: impl FnMut(Vector)) {
    let n = sides.len();
    let count = if n > 2 { n } else { n - 1 }.max(1);
    for i in 0..count {
        let (p, q) = (sides[i], sides[(i + 1) % n]);
        let along = q - p;
        let length2 = along.norm_squared();
        for v in corners {
            let t = (v - p).dot(&along);
            f(if t <= 0.0 {
                v - p
            } else if t >= length2 {
                v - q
            } else {
                // Along the normal, rather than to a rounded foot on the side: keeps the direction of small offsets.
                let normal = perpendicular(along);
                normal * (normal.dot(&(v - p)) / length2)
            });
        }
    }
}
