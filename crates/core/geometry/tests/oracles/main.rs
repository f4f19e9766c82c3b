//! The geometry against oracles that share no code with it: integer arithmetic, brute force, identities of areas, and
//! the collision library parry2d.

mod hostile;
mod lattice;
mod many_corners;
mod measures;
mod minkowski;
mod polygons;
mod rings;
mod simple;
mod slices;
mod verdicts;
