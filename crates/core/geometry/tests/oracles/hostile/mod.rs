//! Hostile input for predicates: millions of near-degenerate lattices against 128-bit integers, and coordinates from
//! 1e-12 to 1e12 side by side against rational numbers. Every verdict has to equal the exact one.

mod exact;
mod lattice;
mod lattice_shapes;
mod mixed;
mod polygons;
mod shapes;
