//! Predicates under attack: near-degenerate lattices by the million against 128-bit integers, coordinates from 1e-12 to
//! 1e12 side by side against rational numbers. Every verdict has to equal the exact one.

mod exact;
mod lattice;
mod lattice_shapes;
mod mixed;
mod polygons;
mod shapes;
