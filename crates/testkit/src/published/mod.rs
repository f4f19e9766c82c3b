//! Numbers published in the literature, next to ours: sweeps of relaxations on the maps and worlds of their sources.

pub mod alves;
pub mod deicu;
pub mod grid_lengths;
pub mod line_maps;
pub mod plain;
pub mod row;
pub mod search;
pub mod silva;
