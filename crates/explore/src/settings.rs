//! How to explore.

use super::survey::MOST_CELLS;
use cplan_engine::Options;
use cplan_motion::Drive;
use cplan_world::OccupancyMap;
use serde::Serialize;
use thiserror::Error;

/// How the explorer decides where to go next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Strategy {
    /// To the goal, by the optimistic path: the one that the options' planner finds where what is unknown counts as free. As far as that is
    /// known to be free; where that shows nothing new, to where what is in its way can be seen, or as [`Strategy::View`].
    #[default]
    Goal,
    /// To a frontier configuration that shows all that the nearest one does, and more than others that are about as near: a next best view
    /// (González-Baños, Latombe 2002) that leaves little behind.
    View,
    /// To the nearest frontier configuration (Yamauchi 1997).
    Nearest,
    /// Up the harmonic potential whose goals are all frontier configurations (Prestes et al. 2002).
    Harmonic,
    /// Along the boundary of what is known to be free, that to the right, to the first frontier configuration there; where none is left, to
    /// the nearest.
    Wall,
}

/// How to explore.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Where to go next.
    pub strategy: Strategy,
    /// Cells of the grid of configurations, along both axes.
    pub cells: [usize; 2],
    /// Distance about the arm, at first, in which the world is known, metres; none for two cells of the map.
    pub surveyed: Option<f64>,
    /// What is known already: the map of an earlier exploration of the same world.
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
    #[error("a map of cells of {0} m would have more than {MOST_CELLS} of them")]
    Map(f64),
    /// What is said to be known already is not of this world.
    #[error("the map that is known already {0}")]
    Known(String),
    /// There is no goal to go to.
    #[error("the strategy \"goal\" has no goal to go to")]
    NoGoal,
}
