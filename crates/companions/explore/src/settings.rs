//! Settings of an exploration.

use super::survey::MAX_CELLS;
use cplan_motion::Drive;
use cplan_solver::Options;
use cplan_world::OccupancyMap;
use serde::Serialize;
use thiserror::Error;

/// Strategy that chooses the next destination.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Strategy {
    /// Follows an optimistic path to the goal, as far as space is known to be free. The planner of the options finds
    /// this path, and counts unknown space as free. If this shows nothing new, moves to a place from which unknown
    /// cells of the path are visible, or else as [`Strategy::View`].
    #[default]
    Goal,
    /// Moves to a frontier configuration that shows everything that the nearest one shows, and more than others at a
    /// similar distance. This is a next best view (González-Baños, Latombe 2002) that leaves little behind.
    View,
    /// Moves to the nearest frontier configuration (Yamauchi 1997).
    Nearest,
    /// Follows the harmonic potential whose goals are all frontier configurations (Prestes et al. 2002).
    Harmonic,
    /// Follows the boundary of the known free space, with this boundary to the right, up to the first frontier
    /// configuration. If there is none on the boundary, moves to the nearest frontier configuration.
    Wall,
}

/// Settings of an exploration.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Strategy for the next destination.
    pub strategy: Strategy,
    /// Number of cells of the grid of configurations along each axis.
    pub cells: [usize; 2],
    /// Distance around the arm within which the world is known initially, in metres. With `None`, it is two cells of
    /// the map.
    pub surveyed: Option<f64>,
    /// Map that is known initially, from an earlier exploration of the same world.
    pub known: Option<OccupancyMap>,
    /// Largest number of decisions.
    pub decisions: usize,
    /// The planner of [`Strategy::Goal`], and how the arm drives along paths.
    pub options: Options,
}

impl Default for Settings {
    fn default() -> Self {
        let options = Options::default();
        // The arm stops at each corner and takes a reading, so corners are not rounded.
        let drive = Drive { blend: 0.0, ..options.drive };
        let options = Options { drive, bounded: false, ..options };
        Self { strategy: Strategy::default(), cells: [96, 96], surveyed: None, known: None, decisions: 10_000, options }
    }
}

/// The reason why an exploration cannot begin.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ExploreError {
    /// The map would have too many cells. Contains the side of a cell, in metres.
    #[error("with cells of {0} m, the map has more than {MAX_CELLS} cells")]
    Map(f64),
    /// The known map is not of this world. Contains the reason.
    #[error("the known map {0}")]
    Known(String),
    /// The strategy needs a goal, and there is none.
    #[error("the strategy \"goal\" needs a goal")]
    NoGoal,
}
