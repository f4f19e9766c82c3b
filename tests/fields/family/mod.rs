//! The family of field equations and relaxations against direct solutions of the same equations, assembled here from
//! difference quotients; and its promises on random grids.

mod arrival;
mod charges;
mod convergence;
pub mod direct;
mod divergence;
mod escapes;
mod khatib;
mod planner;
mod product;
mod promises;
mod sides;
mod small_values;
mod stopping;
mod zones;
