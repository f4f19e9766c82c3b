//! Roadmap planners besides the visibility graph: random roadmaps, triangulations, and the Voronoi diagram.

mod prm;
mod triangles;
mod voronoi;

pub use prm::{Prm, PrmMap};
pub use triangles::{Triangles, TrianglesMap};
pub use voronoi::{Voronoi, VoronoiMap};
