//! Roadmap planners other than the visibility graph: random roadmaps, triangles of a triangulation, and the Voronoi
//! diagram.

mod prm;
mod triangles;
mod voronoi;

pub use prm::{Prm, PrmMap};
pub use triangles::{Triangles, TrianglesMap};
pub use voronoi::{Voronoi, VoronoiMap};
