//! The core planner: from an arm among obstacles to a certified path.
//!
//! - [`space`]: joint values, axes that are intervals or circles, paths.
//! - [`model`]: joints, links, the arm, obstacles, and the scene with the pairs of shapes that can meet.
//! - [`cspace`]: C-obstacles as slices, polygons or cells. Polygons and cells state what they prove.
//! - [`waves`]: waves and classical searches over the free cells of a grid.
//! - [`planner`]: the trait `Planner` and four planners: visibility graph, trapezoids, wavefront, harmonic field.
//!   The crates `roadmaps`, `fields` and `proofs` have the others.
//! - [`check`]: the judge, which certifies paths and proofs on the shapes themselves.

pub mod space;
pub mod model;
pub mod cspace;
pub mod waves;
pub mod planner;
pub mod check;
