//! Configuration-space obstacles as grids and regions, against clearances and distances of sampled configurations.

mod crowded;
mod data;
mod gantry_cells;
mod grids;
mod nearest;
mod regions;
