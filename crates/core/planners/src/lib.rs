//! Configuration spaces, and planners that propose paths through them.
//!
//! - [`cspace`]: C-obstacles as slices, polygons or cells. Polygons and cells state what they prove.
//! - [`waves`]: waves and classical searches over the free cells of a grid.
//! - [`planner`]: the trait `Planner` and four planners: visibility graph, trapezoids, wavefront, harmonic field.
//!   The crates `roadmaps`, `fields` and `proofs` have the others.
//!
//! A planner cannot certify a path. Only the judge can, a crate that does not depend on planners.

pub mod cspace;
pub mod waves;
pub mod planner;
