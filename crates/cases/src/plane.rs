//! Plane geometry in floating point, for oracles. It shares no code with the library.

/// A point or a vector.
pub type Point = [f64; 2];

/// Returns `a + b`.
pub fn plus(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1]]
}

/// Returns `a - b`.
pub fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

/// Returns a vector turned by an angle, radians.
pub fn turned([x, y]: Point, angle: f64) -> Point {
    let (s, c) = angle.sin_cos();
    [x * c - y * s, x * s + y * c]
}

/// Returns the cross product: positive if `b` is to the left of `a`.
pub fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns the distance of two points.
pub fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns the distance of a point from a segment. The segment may be a point.
pub fn distance_to_segment(p: Point, [a, b]: [Point; 2]) -> f64 {
    let (along, to) = (minus(b, a), minus(p, a));
    let square = along[0] * along[0] + along[1] * along[1];
    let share = if square > 0.0 { ((along[0] * to[0] + along[1] * to[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (to[0] - share * along[0]).hypot(to[1] - share * along[1])
}

/// Returns the distance of two segments; 0 if they cross.
pub fn segment_distance(s: [Point; 2], t: [Point; 2]) -> f64 {
    let side = |[a, b]: [Point; 2], p: Point| cross(minus(b, a), minus(p, a));
    if side(s, t[0]) * side(s, t[1]) < 0.0 && side(t, s[0]) * side(t, s[1]) < 0.0 {
        return 0.0;
    }
    let ends = [(s[0], t), (s[1], t), (t[0], s), (t[1], s)];
    ends.map(|(p, segment)| distance_to_segment(p, segment)).into_iter().fold(f64::INFINITY, f64::min)
}

/// Returns the sides of a polygon.
pub fn sides(corners: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]])
}

/// Returns true if a point is inside a polygon: a ray to the right crosses the sides an odd number of times.
pub fn is_inside([x, y]: Point, corners: &[Point]) -> bool {
    let crosses =
        |&[a, b]: &[Point; 2]| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    sides(corners).filter(crosses).count() % 2 == 1
}

/// Returns the distance of two polygons; 0 if they overlap. They may also be segments or points.
pub fn polygon_distance(a: &[Point], b: &[Point]) -> f64 {
    if is_inside(a[0], b) || is_inside(b[0], a) {
        return 0.0;
    }
    sides(a).flat_map(|s| sides(b).map(move |t| segment_distance(s, t))).fold(f64::INFINITY, f64::min)
}
