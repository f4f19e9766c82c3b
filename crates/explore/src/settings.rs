//! Settings of an exploration.

use super::survey::MAX_CELLS;
use cplan_motion::Drive;
use cplan_solver::Options;
use cplan_world::OccupancyMap;
use serde::Serialize;
use thiserror::Error;

/// Strategies for the next destination.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Strategy {
    /// To the goal along the optimistic path, which the options' planner finds with unknown space counted as free.
    /// Follows it as far as free space is known. If that shows nothing new, moves to a view of the cells in its way,
    /// or as [`Strategy::View`].
    #[default]
    Goal,
    /// To a frontier configuration that shows everything that the nearest one shows, and more than others at a similar
    /// distance: a next best view (González-Baños, Latombe 2002) that leaves little behind.
    View,
    /// To the nearest frontier configuration (Yamauchi 1997).
    Nearest,
    /// Up the harmonic potential whose goals are all frontier configurations (Prestes et al. 2002).
    Harmonic,
    /// Along the boundary of the known free space, with the boundary to the right, to the first frontier configuration
    /// there; otherwise to the nearest.
    Wall,
}

/// Settings of an exploration.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Strategy for the next destination.
    pub strategy: Strategy,
    /// Cells of the grid of configurations, along both axes.
    pub cells: [usize; 2],
    /// Distance around the arm within which the world is known initially, metres; `None` for two cells of the map.
    pub surveyed: Option<f64>,
    /// Known map: from an earlier exploration of the same world.
    pub known: Option<OccupancyMap>,
    /// Decisions at the most.
    pub decisions: usize,
    /// The planner of [`Strategy::Goal`], and how motions are driven.
    pub options: Options,
}

impl Default for Settings {
    fn default() -> Self {
        let options = Options::default();
        // A corner is stopped at: there the arm looks around.
        let drive = Drive { blend: 0.0, ..options.drive };
        let options = Options { drive, bounded: false, ..options };
        Self { strategy: Strategy::default(), cells: [96, 96], surveyed: None, known: None, decisions: 10_000, options }
    }
}

/// Why there is no exploration.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ExploreError {
    /// The map would be too large.
    #[error("a map of cells of {0} m would have more than {MAX_CELLS} of them")]
    Map(f64),
    /// The known map is not of this world.
    #[error("the known map {0}")]
    Known(String),
    /// There is no goal to go to.
    #[error("the strategy \"goal\" needs a goal")]
    NoGoal,
}
