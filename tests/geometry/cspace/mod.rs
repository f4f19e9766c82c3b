//! Configuration-space obstacles as slices, grids and regions, against clearances and distances of sampled configurations.

mod crowded;
mod data;
mod grids;
mod nearest;
mod regions;
mod slices;
