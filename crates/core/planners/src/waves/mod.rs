//! Waves and other classical searches over the free cells of a grid.
//!
//! There are three waves. `run_wave` proceeds by rows, and is fast if free cells form long runs. `tile_wave` proceeds by tiles
//! of 8 x 8 cells, one bit each, and is fast in mazes and noise. `queue_wave`, for diagonal moves, proceeds cell by cell.

mod deepening;
mod free_cells;
mod queue_wave;
mod run_wave;
pub mod search;
mod step_labels;
mod tile_wave;

pub use free_cells::{FreeCells, Move, Neighborhood};
pub use step_labels::StepLabels;

/// Label of a cell that no wave and no search reached.
pub const UNREACHED: u32 = u32::MAX;
