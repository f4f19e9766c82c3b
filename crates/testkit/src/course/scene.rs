//! The plane of most figures: three convex obstacles in a room, a start and a goal.

use cplan::Point;

/// Size of the room.
pub const ROOM: [f64; 2] = [10.0, 4.0];
/// Number of obstacles.
const COUNT: usize = 3;

/// Returns the start and the goal.
pub fn ends() -> [Point; 2] {
    [Point::new(0.7, 1.0), Point::new(9.3, 3.0)]
}

/// Returns the corners of the obstacles, counter-clockwise.
pub fn obstacles() -> [Vec<Point>; COUNT] {
    let corners = |all: &[[f64; 2]]| all.iter().map(|&[x, y]| Point::new(x, y)).collect();
    [
        corners(&[[1.7, 0.6], [3.0, 0.35], [3.7, 1.5], [3.1, 2.6], [1.9, 2.3]]),
        corners(&[[4.7, 1.7], [6.3, 1.2], [5.9, 3.4]]),
        corners(&[[7.0, 0.5], [8.5, 0.9], [8.3, 2.5], [7.2, 2.2]]),
    ]
}

/// Returns the distance of a point from the outline of a convex polygon; negative inside.
pub fn distance(polygon: &[Point], p: Point) -> f64 {
    let sides = || polygon.iter().zip(polygon.iter().cycle().skip(1));
    let to_side = |(a, b): (&Point, &Point)| {
        let side = b - a;
        let share = ((p - a).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
        (p - a - side * share).norm()
    };
    let nearest = sides().map(to_side).fold(f64::INFINITY, f64::min);
    let is_inside = sides().all(|(a, b)| (b - a).perp(&(p - a)) > 0.0);
    if is_inside { -nearest } else { nearest }
}

/// Returns true if the open segment does not enter an obstacle.
pub fn sees(obstacles: &[Vec<Point>], a: Point, b: Point) -> bool {
    obstacles.iter().all(|polygon| {
        // The part of the segment within all sides so far.
        let (mut low, mut high) = (0.0f64, 1.0f64);
        for (p, q) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
            let (at, along) = ((q - p).perp(&(a - p)), (q - p).perp(&(b - a)));
            if along.abs() < 1e-12 {
                if at <= 1e-9 {
                    return true;
                }
            } else if along > 0.0 {
                low = low.max(-at / along);
            } else {
                high = high.min(-at / along);
            }
        }
        high - low < 1e-9
    })
}

/// Returns the shortest path from the first to the second point along edges.
pub fn shortest(points: &[Point], edges: &[[usize; 2]]) -> Vec<Point> {
    let mut lengths = vec![f64::INFINITY; points.len()];
    let mut before = vec![usize::MAX; points.len()];
    lengths[0] = 0.0;
    // Each pass settles at least one more point of every shortest path.
    for _ in points {
        for &[i, j] in edges {
            for (from, to) in [(i, j), (j, i)] {
                let length = lengths[from] + (points[to] - points[from]).norm();
                if length < lengths[to] {
                    (lengths[to], before[to]) = (length, from);
                }
            }
        }
    }
    let mut path = vec![1];
    while let Some(&last) = path.last().filter(|last| before[**last] != usize::MAX) {
        path.push(before[last]);
    }
    path.iter().rev().map(|&k| points[k]).collect()
}

/// Returns the start, the goal and all corners, and the pairs of points that see each other.
pub fn visibility() -> (Vec<Point>, Vec<[usize; 2]>) {
    let obstacles = obstacles();
    let points: Vec<Point> = ends().into_iter().chain(obstacles.iter().flatten().copied()).collect();
    let pairs = (0..points.len()).flat_map(|i| (i + 1..points.len()).map(move |j| [i, j]));
    let edges = pairs.filter(|&[i, j]| sees(&obstacles, points[i], points[j])).collect();
    (points, edges)
}
