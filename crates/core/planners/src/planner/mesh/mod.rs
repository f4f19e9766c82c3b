//! Triangulated free space.

mod cone;
mod corners;
mod delaunay;
mod location;
mod straight;

pub use cone::{Bound, Cone, ConeContinuation, Crossing};
pub use corners::{Corner, Tangency};

use super::NO_ENTRY;
use corners::Corners;
use cplan_geometry::Point;
use cplan_geometry::planar::{Boundary, HalfEdges, triangulate};
use cplan_model::space::Segment;
use location::Columns;

/// The constrained Delaunay triangulation of free space, its convex corners, and an index of its triangles.
///
/// Triangles are neighbours only if they share an edge in free space. So parts that touch only in a corner are separate.
#[derive(Debug, Clone)]
pub struct Mesh {
    vertices: Vec<Point>,
    edges: HalfEdges,
    corners: Corners,
    columns: Columns,
}

impl Mesh {
    /// Builds the triangulation in `O(n log n)` for `n` vertices.
    pub fn new(boundary: Boundary) -> Self {
        let mut edges = triangulate(&boundary);
        let vertices = boundary.vertices;
        delaunay::flip(&vertices, &mut edges);
        let corners = Corners::new(&vertices, &edges);
        let columns = Columns::new(&vertices, &edges);
        Self { vertices, edges, corners, columns }
    }

    /// Returns the number of triangles.
    pub fn triangles(&self) -> usize {
        self.edges.origin.len() / 3
    }

    /// Returns the convex corners of obstacles.
    pub fn corners(&self) -> &[Corner] {
        &self.corners.list
    }

    /// Returns the triangles that contain `p`, borders included. Empty if `p` is outside free space. Exact; `O(sqrt n)`
    /// for triangles of similar sizes.
    pub fn triangles_at(&self, p: Point) -> impl Iterator<Item = u32> + '_ {
        self.columns.triangles_at(&self.vertices, &self.edges, p)
    }

    /// Returns the triangles that contain a part of a segment, each with that part. Linear, except for a point.
    pub fn parts_of(&self, segment: &Segment) -> Vec<(u32, Segment)> {
        if segment.is_point() {
            let [at, _] = segment.ends();
            return self.triangles_at(at).map(|triangle| (triangle, *segment)).collect();
        }
        let part = |triangle: u32| {
            let corners = [0, 1, 2].map(|k| self.origin(3 * triangle + k));
            Some((triangle, segment.within_polygon(&corners)?))
        };
        (0..self.triangles() as u32).filter_map(part).collect()
    }

    /// Returns all vertices of free space, each once, sorted by abscissa.
    pub fn vertices(&self) -> &[Point] {
        &self.vertices
    }

    /// Returns the number of the vertex at which a half-edge begins.
    pub fn vertex(&self, half_edge: u32) -> u32 {
        self.edges.origin[half_edge as usize]
    }

    /// Returns the point at which a half-edge begins.
    pub fn origin(&self, half_edge: u32) -> Point {
        self.vertices[self.edges.origin[half_edge as usize] as usize]
    }

    /// Returns the number of the convex corner at the origin of a half-edge; `None` if the sector there is at most
    /// half a turn.
    pub fn corner_at(&self, half_edge: u32) -> Option<u32> {
        let corner = self.corners.of_half_edge[half_edge as usize];
        (corner != NO_ENTRY).then_some(corner)
    }

    /// Returns the right and the left end of a half-edge, as seen from within its triangle.
    pub fn ends(&self, half_edge: u32) -> [Point; 2] {
        [self.origin(half_edge), self.origin(next(half_edge))]
    }

    /// Returns the sides of the boundary. Free space is to the left of each.
    pub fn walls(&self) -> impl Iterator<Item = [Point; 2]> + '_ {
        (0..self.edges.twin.len() as u32).filter(|&half_edge| self.is_wall(half_edge)).map(|wall| self.ends(wall))
    }

    /// Returns true if a half-edge is part of the boundary.
    pub fn is_wall(&self, half_edge: u32) -> bool {
        self.twin(half_edge).is_none()
    }

    /// Returns the half-edge on the other side of the same edge; `None` if it is part of the boundary.
    pub fn twin(&self, half_edge: u32) -> Option<u32> {
        let twin = self.edges.twin[half_edge as usize];
        (twin != NO_ENTRY).then_some(twin)
    }
}

/// Returns the half-edge that follows in the same triangle.
pub fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// Returns the half-edge that precedes it in the same triangle.
pub fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cspace::{PolygonWithHoles, Proves, Regions};
    use cplan_geometry::{Orientation, in_circle, orientation};
    use cplan_model::space::{JointRange, Topology};
    use proptest::prelude::*;

    /// Returns free space in a window of 7 x 7 squares around a board of 5 x 5 squares. An integer matrix of determinant 1
    /// transforms both. Each blocked square is a separate hole, so holes touch along sides and in corners.
    fn board(blocked: &[bool], [a, b, c, d]: [f64; 4]) -> Regions {
        let square = |x: f64, y: f64, size: f64| {
            [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)]
                .map(|(dx, dy)| Point::new(a * (x + dx) + b * (y + dy), c * (x + dx) + d * (y + dy)))
                .to_vec()
        };
        let squares = (0..25).filter(|&k| blocked[k]).map(|k| {
            let mut hole = square((k / 5) as f64, (k % 5) as f64, 1.0);
            hole.reverse();
            hole
        });
        let free = vec![PolygonWithHoles { outer: square(-1.0, -1.0, 7.0), holes: squares.collect() }];
        let window = [(-50.0, 50.0); 2];
        let axes = window.map(|(lower, upper)| JointRange::Interval { lower, upper });
        Regions { topology: Topology::new(axes), proves: Proves::Exact, window, obstacles: Vec::new(), free }
    }

    fn matrices() -> impl Strategy<Value = [f64; 4]> {
        prop_oneof![
            Just([1.0, 0.0, 0.0, 1.0]),
            Just([0.0, -1.0, 1.0, 0.0]),
            Just([2.0, 1.0, 1.0, 1.0]),
            Just([1.0, 0.0, -3.0, 1.0]),
        ]
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Checks the definition. Triangles are counter-clockwise, are joined in pairs, cover free space, and are
        /// Delaunay. The index finds those that contain a point.
        #[test]
        fn the_mesh_is_the_constrained_delaunay_triangulation(
            blocked in proptest::collection::vec(any::<bool>(), 25), matrix in matrices(),
        ) {
            let mesh = Mesh::new(Boundary::new(&board(&blocked, matrix).contours()));
            let corners = |t: u32| [3 * t, 3 * t + 1, 3 * t + 2].map(|h| mesh.origin(h));
            let mut twice_area = 0.0;
            for t in 0..mesh.triangles() as u32 {
                let [a, b, c] = corners(t);
                prop_assert_eq!(orientation(a, b, c), Orientation::CounterClockwise);
                twice_area += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
                for h in 3 * t..3 * t + 3 {
                    if let Some(twin) = mesh.twin(h) {
                        prop_assert_eq!(mesh.twin(twin), Some(h));
                        let [p, q] = mesh.ends(twin);
                        prop_assert_eq!(mesh.ends(h), [q, p]);
                        prop_assert!(!in_circle([a, b, c], mesh.origin(previous(twin))));
                    }
                }
            }
            // Sums of integers below 2^53 are exact.
            prop_assert_eq!(twice_area, 2.0 * (49.0 - blocked.iter().filter(|b| **b).count() as f64));
            for (x, y) in (-3..=13).flat_map(|x| (-3..=13).map(move |y| (f64::from(x) / 2.0, f64::from(y) / 2.0))) {
                let [a, b, c, d] = matrix;
                let p = Point::new(a * x + b * y, c * x + d * y);
                let holds = |&t: &u32| {
                    let [a, b, c] = corners(t);
                    [(a, b), (b, c), (c, a)].iter().all(|&(a, b)| orientation(a, b, p) != Orientation::Clockwise)
                };
                let expected: Vec<u32> = (0..mesh.triangles() as u32).filter(holds).collect();
                let mut found: Vec<u32> = mesh.triangles_at(p).collect();
                found.sort_unstable();
                prop_assert_eq!(found, expected);
            }
        }

        /// Compares the result with the squares that a segment meets. If the segment passes through no vertex, both
        /// must agree. If it does, a clear segment must still meet no square.
        #[test]
        fn straight_motions_are_clear_where_no_square_is_met(
            blocked in proptest::collection::vec(any::<bool>(), 25), matrix in matrices(),
            ends in [[-7i8..47, -7i8..47], [-7i8..47, -7i8..47]],
        ) {
            let mesh = Mesh::new(Boundary::new(&board(&blocked, matrix).contours()));
            // Places are eighths with a small offset, so few lines pass through vertices.
            let place = |[x, y]: [i8; 2], off: f64| [f64::from(x) / 8.0 + off, f64::from(y) / 8.0 - off / 4.0];
            let [p, q] = [place(ends[0], 1.0 / 1024.0), place(ends[1], 1.0 / 4096.0)];
            let [a, b, c, d] = matrix;
            let mapped = |[x, y]: [f64; 2]| Point::new(a * x + b * y, c * x + d * y);
            // True if the segment meets the square with this lower corner, by the sides of its line and the ranges of both.
            let meets = |x: f64, y: f64| {
                let sides = [(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)]
                    .map(|(x, y)| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]));
                let straddles = sides.iter().any(|s| *s <= 0.0) && sides.iter().any(|s| *s >= 0.0);
                let within = |k: usize, low: f64| p[k].min(q[k]) <= low + 1.0 && p[k].max(q[k]) >= low;
                straddles && within(0, x) && within(1, y)
            };
            let square = |k: usize| ((k / 5) as f64, (k % 5) as f64);
            let meets_any = (0..25).filter(|&k| blocked[k]).any(|k| { let (x, y) = square(k); meets(x, y) });
            let through_vertex = (-1..=6).flat_map(|x| (-1..=6).map(move |y| (f64::from(x), f64::from(y))))
                .any(|(x, y)| (q[0] - p[0]) * (y - p[1]) == (q[1] - p[1]) * (x - p[0]));
            prop_assume!(p.iter().chain(&q).all(|v| (-1.0..=6.0).contains(v)));
            let clear = mesh.is_clear(mapped(p), mapped(q));
            prop_assert!(!clear || !meets_any);
            if !through_vertex {
                prop_assert_eq!(clear, !meets_any, "{:?} {:?}", p, q);
            }
        }
    }
}
