//! Predicates of convex polygons, given as corners, counter-clockwise; one corner is a point, two are a segment.

use crate::error::Refusal;
use cplan::geometry::{self, Convex, Point};
use serde::Serialize;

/// Largest coordinate in metres, the same as for arms and worlds.
const MAX_COORDINATE: f64 = 1e15;

fn polygon(name: &str, corners: &[[f64; 2]]) -> Result<Convex, Refusal> {
    // Products of larger coordinates overflow.
    if corners.iter().flatten().any(|x| x.abs() > MAX_COORDINATE) {
        let limit = format!("{name}: coordinates must be at most {MAX_COORDINATE:e} in magnitude");
        return Err(Refusal::Value(limit));
    }
    let points = corners.iter().map(|&[x, y]| Point::new(x, y)).collect();
    Convex::new(points, 0.0).map_err(|error| Refusal::value(format!("{name}: {error}")))
}

/// Returns the penetration depth of two convex polygons in metres: the shortest translation after which they only
/// touch. A negative value is the distance between them.
///
/// # Errors
/// Corners that are not those of a convex polygon.
pub fn penetration_depth(a: &[[f64; 2]], b: &[[f64; 2]]) -> Result<f64, Refusal> {
    Ok(geometry::penetration_depth(&polygon("a", a)?, &polygon("b", b)?))
}

/// The result of the polygon penetration test.
#[derive(Debug, Serialize)]
pub struct PolygonTest {
    /// True if the polygons have a point in common.
    pub meet: bool,
    /// Numbers of the corners of a in b.
    pub a_inside: Vec<usize>,
    /// Numbers of the corners of b in a.
    pub b_inside: Vec<usize>,
    /// Sides of a and of b that cross properly.
    pub crossings: Vec<(usize, usize)>,
}

/// Finds the corners of each convex polygon in the other, and sides that cross. Exact.
///
/// # Errors
/// Corners that are not those of a convex polygon.
pub fn polygon_test(a: &[[f64; 2]], b: &[[f64; 2]]) -> Result<PolygonTest, Refusal> {
    let test = geometry::polygon_test(&polygon("a", a)?, &polygon("b", b)?);
    let corners = |inside: &[geometry::CornerInside]| inside.iter().map(|inside| inside.corner).collect();
    let (a_inside, b_inside) = (corners(&test.a_inside), corners(&test.b_inside));
    Ok(PolygonTest { meet: test.meet, a_inside, b_inside, crossings: test.crossings })
}

/// Returns the Minkowski difference: the translations of `b` with which it meets `a`, which is its C-obstacle.
///
/// # Errors
/// Corners that are not those of a convex polygon.
pub fn minkowski_difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, Refusal> {
    let difference = polygon("a", a)?.minkowski_difference(&polygon("b", b)?);
    Ok(difference.core().iter().map(|point| [point.x, point.y]).collect())
}
