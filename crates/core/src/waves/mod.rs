//! Steps to the goal: waves over the free cells of a grid, and other classical searches.
//!
//! A wave proceeds by rows where free cells form long runs (`run_wave`), by tiles of 8 x 8 cells, one bit each, in
//! mazes and noise (`tile_wave`), and cell by cell where diagonal moves count (`queue_wave`).

mod deepening;
mod free_cells;
mod lattice;
mod queue_wave;
mod run_wave;
pub mod search;
mod step_labels;
mod tile_wave;

pub use free_cells::{FreeCells, Move, Neighborhood};
pub use step_labels::StepLabels;

use cplan_harmonic::UNREACHED;
