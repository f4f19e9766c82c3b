//! Configuration-space obstacles as rows, grids and regions, against clearances and distances of sampled configurations.

mod grids;
mod nearest;
mod regions;
mod rows;
