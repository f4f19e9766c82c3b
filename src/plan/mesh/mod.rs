//! Free space as triangles, to be walked through along lines of sight.

mod cone;
mod corners;
mod delaunay;
mod location;
mod triangulation;

pub(super) use cone::{Beyond, Cone, Crossing};
pub(super) use corners::{Corner, Tangency};

use super::NONE;
use super::boundary::Boundary;
use crate::geometry::Point;
use corners::Corners;
use location::Columns;
use triangulation::HalfEdges;

/// The constrained Delaunay triangulation of free space, its convex corners, and an index of its triangles.
///
/// Triangles are neighbours only through free space, so what touches in a corner only is apart here.
#[derive(Debug, Clone)]
pub(super) struct Mesh {
    vertices: Vec<Point>,
    edges: HalfEdges,
    corners: Corners,
    columns: Columns,
}

impl Mesh {
    /// Triangulates, `O(n log n)` for `n` vertices.
    pub fn new(boundary: Boundary) -> Self {
        let mut edges = triangulation::triangulate(&boundary);
        let vertices = boundary.vertices;
        delaunay::flip(&vertices, &mut edges);
        let corners = Corners::new(&vertices, &edges);
        let columns = Columns::new(&vertices, &edges);
        Self { vertices, edges, corners, columns }
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.edges.origin.len() / 3
    }

    /// Convex corners of obstacles.
    pub fn corners(&self) -> &[Corner] {
        &self.corners.list
    }

    /// Triangles that contain `p`, borders included; none outside of free space. Exact; `O(sqrt n)` among triangles of
    /// even size.
    pub fn triangles_at(&self, p: Point) -> impl Iterator<Item = u32> + '_ {
        self.columns.triangles_at(&self.vertices, &self.edges, p)
    }

    /// The point at which a half-edge begins.
    pub fn origin(&self, half_edge: u32) -> Point {
        self.vertices[self.edges.origin[half_edge as usize] as usize]
    }

    /// The corner in the sector of free space at the origin of a half-edge, if that is convex for the obstacle.
    pub fn corner_at(&self, half_edge: u32) -> Option<u32> {
        let corner = self.corners.of_half_edge[half_edge as usize];
        (corner != NONE).then_some(corner)
    }

    /// The right and the left end of a half-edge, as seen from within its triangle.
    pub fn ends(&self, half_edge: u32) -> [Point; 2] {
        [self.origin(half_edge), self.origin(next(half_edge))]
    }

    /// Whether a half-edge is part of the boundary.
    pub fn is_wall(&self, half_edge: u32) -> bool {
        self.twin(half_edge).is_none()
    }

    fn twin(&self, half_edge: u32) -> Option<u32> {
        let twin = self.edges.twin[half_edge as usize];
        (twin != NONE).then_some(twin)
    }
}

/// The half-edge that follows in the same triangle.
pub(super) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The half-edge before in the same triangle.
pub(super) fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}
