//! Configuration-space obstacles as grids and regions, against clearances and distances of sampled configurations.

#[path = "../common/mod.rs"]
mod common;
mod crowded;
mod data;
mod gantry_cells;
mod grids;
mod nearest;
#[path = "../../crates/core/geometry/tests/oracles/parry.rs"]
mod parry;
mod regions;
