//! C-obstacles of an arm that moves link 2 without turning it. They are Minkowski differences, exact except for rounded corners.

use cplan_geometry::{Convex, Point, Vector, cross, inset, minkowski_difference, perpendicular};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType};
use nalgebra::Matrix2;
use std::f64::consts::TAU;

/// Sine of the angle between two slides below which they count as parallel. The map from the plane to joint values
/// would multiply rounding errors by the inverse of this sine.
const PARALLEL_SINE: f64 = 1e-9;

/// Returns the map from displacements in the plane to joint values. `None` unless both joints are prismatic and
/// their directions are not parallel.
pub(super) fn joint_map(arm: &Arm) -> Option<Matrix2<f64>> {
    let [JointType::Prismatic { direction: first }, JointType::Prismatic { direction: second }] =
        [arm.joints[0].joint_type, arm.joints[1].joint_type]
    else {
        return None;
    };
    let directions = Matrix2::from_columns(&[first, second]);
    if directions.determinant().abs() < PARALLEL_SINE { None } else { directions.try_inverse() }
}

/// Returns the joint values at which `part` of link 2 is within `level` of `piece`, as a convex polygon. Tangents
/// replace arcs, so the polygon also contains some joint values with distances up to `level + tolerance`. Straight
/// sides are exact. `map` comes from [`joint_map`]. `O(n + m)` time and corners, plus the corners on arcs.
pub(super) fn contour(
    arm: &Arm,
    map: &Matrix2<f64>,
    part: &Convex,
    piece: &Convex,
    level: f64,
    tolerance: f64,
) -> Vec<Point> {
    let radius = part.radius() + piece.radius() + level;
    let core = minkowski_difference(piece.core(), part.core());
    in_joint_values(arm, map, &tangent_polygon(&core, radius, radius + tolerance))
}

/// Returns a convex polygon that contains all joint values at which `part` of link 2 is within `level - margin` of
/// `piece`. Chords replace arcs. All joint values in the polygon have distances below `level`. `None` if no area
/// remains. The arguments are those of [`contour`].
pub(super) fn inner_contour(
    arm: &Arm,
    map: &Matrix2<f64>,
    part: &Convex,
    piece: &Convex,
    level: f64,
    margin: f64,
) -> Option<Vec<Point>> {
    // One half of the margin keeps chords and rounding off the boundary. The other half is what chords may cut off.
    let radius = part.radius() + piece.radius() + level - margin / 2.0;
    let core = minkowski_difference(piece.core(), part.core());
    let polygon = if radius <= 0.0 { inset(&core, -radius)? } else { chord_polygon(&core, radius, margin / 2.0) };
    (polygon.len() > 2).then(|| in_joint_values(arm, map, &polygon))
}

/// Returns the configurations at which joint 1 has its least and its greatest value, and then those for joint 2, while
/// `part` of link 2 is within a distance of `piece`. `radius` is this distance plus both radii. `map` comes from
/// [`joint_map`]. `O(n + m)`.
pub(super) fn extremes(
    arm: &Arm,
    map: &Matrix2<f64>,
    part: &Convex,
    piece: &Convex,
    radius: f64,
) -> [[Configuration; 2]; 2] {
    let core = in_joint_values(arm, map, &minkowski_difference(piece.core(), part.core()));
    [0, 1].map(|axis| {
        // The direction in the plane in which the joint's value grows fastest.
        let up = map.row(axis).transpose().normalize();
        let reach = map * up * radius;
        let by_value = |a: &&Point, b: &&Point| a[axis].total_cmp(&b[axis]);
        let [least, greatest] = [core.iter().min_by(by_value), core.iter().max_by(by_value)];
        let core_end = |end: Option<&Point>| *end.unwrap_or_else(|| unreachable!("shapes have corners"));
        [core_end(least) - reach, core_end(greatest) + reach]
    })
}

/// Returns a polygon that contains all points within `radius - sag` of a convex polygon, and only points within
/// `radius`.
fn chord_polygon(core: &[Point], radius: f64, sag: f64) -> Vec<Point> {
    let widest = 2.0 * (1.0 - sag / radius).max(0.0).acos();
    with_arcs(core, widest, |turn, chords| {
        // On a disc, the last corner equals the first one.
        let last = if core.len() > 1 && turn > 0.0 { chords + 1 } else { chords };
        (0..last).map(|k| (turn * (k as f64 / chords as f64), radius)).collect()
    })
}

/// Converts a polygon of positions of link 2's origin to joint values.
fn in_joint_values(arm: &Arm, map: &Matrix2<f64>, polygon: &[Point]) -> Vec<Point> {
    let origin = arm.base + arm.offset;
    let mut contour: Vec<Point> = polygon.iter().map(|p| map * (p - origin)).collect();
    if map.determinant() < 0.0 {
        contour.reverse();
    }
    contour
}

/// Returns a polygon that contains all points within `radius` of a convex polygon, with corners at most `reach` from
/// it.
fn tangent_polygon(core: &[Point], radius: f64, reach: f64) -> Vec<Point> {
    if radius <= 0.0 {
        return core.to_vec();
    }
    with_arcs(core, 2.0 * (radius / reach).acos(), |turn, tangents| {
        let step = turn / tangents as f64;
        (0..tangents).map(|k| ((k as f64 + 0.5) * step, radius / (step / 2.0).cos())).collect()
    })
}

/// Returns a convex polygon with an arc at each corner. `corners` receives the angle by which the outward normal turns
/// at the corner, and the number of equal parts of this angle, each at most `widest`. It returns the corners of the
/// arc: the angle from the first normal, and the distance.
fn with_arcs(core: &[Point], widest: f64, corners: impl Fn(f64, usize) -> Vec<(f64, f64)>) -> Vec<Point> {
    let n = core.len();
    let mut polygon = Vec::new();
    for (i, &at) in core.iter().enumerate() {
        let (before, after) = (core[(i + n - 1) % n], core[(i + 1) % n]);
        let (normal, turn) = if n == 1 { (Vector::x(), TAU) } else { corner(before, at, after) };
        for (angle, distance) in corners(turn, (turn / widest).ceil().max(1.0) as usize) {
            let angle = normal.y.atan2(normal.x) + angle;
            polygon.push(at + distance * Vector::new(angle.cos(), angle.sin()));
        }
    }
    polygon
}

/// Returns the outward normal of the side before a corner, and the angle in `[0, pi]` by which the normal turns
/// there.
fn corner(before: Point, at: Point, after: Point) -> (Vector, f64) {
    let (into, out) = (at - before, after - at);
    // A convex outline never turns clockwise, so a negative sign is a rounding error.
    (-perpendicular(into), cross(into, out).abs().atan2(into.dot(&out)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::separation;

    fn cores() -> [Vec<Point>; 3] {
        [
            vec![Point::new(0.3, -0.2)],
            vec![Point::new(0.0, 0.0), Point::new(1.0, 0.5)],
            vec![Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.0, 0.1)],
        ]
    }

    /// Tests the distances of the polygon's corners, and of points between them, from the core.
    #[test]
    fn chord_polygons_lie_between_the_sag_and_the_radius() {
        for core in cores() {
            for sag in [1e-6, 1e-3, 0.05, 0.3] {
                let polygon = chord_polygon(&core, 0.2, sag);
                let shape = Convex::trusted(core.clone(), 0.0);
                let distance = |p: Point| separation(&shape, &Convex::point(p)).distance;
                for (i, &a) in polygon.iter().enumerate() {
                    let b = polygon[(i + 1) % polygon.len()];
                    for k in 0..=10 {
                        let distance = distance(a + (b - a) * (f64::from(k) / 10.0));
                        assert!(distance <= 0.2 + 1e-12 && distance >= 0.2 - sag - 1e-12, "{sag}: {distance}");
                    }
                }
                // The corners are counter-clockwise.
                let n = polygon.len();
                let turns = |i: usize| {
                    let [a, b, c] = [0, 1, 2].map(|k| polygon[(i + k) % n]);
                    cross(b - a, c - b) >= -1e-12
                };
                assert!(n < 3 || (0..n).all(turns), "{sag}: {polygon:?}");
            }
        }
    }

    #[test]
    fn tangent_polygons_lie_between_radius_and_reach() {
        for core in cores() {
            let polygon = tangent_polygon(&core, 0.2, 0.21);
            let shape = Convex::trusted(core, 0.0);
            let distance = |p: Point| separation(&shape, &Convex::point(p)).distance;
            for (i, &a) in polygon.iter().enumerate() {
                let b = polygon[(i + 1) % polygon.len()];
                assert!(distance(a) <= 0.21 + 1e-12);
                for k in 0..=10 {
                    assert!(distance(a + (b - a) * (f64::from(k) / 10.0)) >= 0.2 - 1e-12);
                }
            }
        }
    }
}
