//! The family of field equations and relaxations, compared with direct solutions of the same equations, which this
//! module assembles from difference quotients. Also the guarantees of the family on random grids.

mod arrival;
mod charges;
mod convergence;
pub mod direct;
mod divergence;
mod escapes;
mod khatib;
pub mod planner;
mod preferences;
mod product;
mod promises;
mod sides;
mod small_values;
mod stopping;
mod zones;
