//! The geometry against oracles that share no code with it: integer arithmetic, brute force, identities of areas, and
//! the collision library parry2d.

#[path = "../common/mod.rs"]
mod common;
mod cspace;
mod hostile;
mod lattice;
mod many_corners;
mod measures;
mod minkowski;
mod parry;
mod polygons;
mod rings;
mod verdicts;
