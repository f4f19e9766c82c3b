//! Steps to the goal: waves over the free cells of a grid, and the classical searches beside them.

mod free_cells;
mod queue_wave;
mod run_wave;
pub mod search;
mod step_labels;
mod tile_wave;

pub use free_cells::{FreeCells, Move, Neighborhood};
pub use step_labels::StepLabels;

use super::UNREACHED;
