//! Planning in a world that is only seen bit by bit.
//!
//! The world that is given is what is really there. The explorer knows of it what its [`Sensor`](cplan_world::Sensor) has
//! seen, as a map of cells; what it has not seen is solid. Every motion is certified within what is known to be free before it is
//! begun, so the arm stops before it enters what it has not seen; and it is certified once more against the world itself by who
//! plays it.
//!
//! ```text
//! look -> map -> known free configurations, frontier among them -> decision -> certified leg -> on the way: look ...
//! ```
//!
//! # How it ends
//!
//! - *Reached*: the goal.
//! - *Explored*: from no configuration of the grid that can be reached would a reading show anything new. That is decided, not
//!   guessed: rays are as wide as the cells that they cross, so what a reading adds is known beforehand up to the first unknown
//!   cell of each ray ([`Survey::promise`]).
//!   (Where distances have errors a reading may hide what it promised; such configurations are counted.)
//! - *Unreachable*: no way leads to the goal past the cells that hold something, proven, whatever lies in what was not seen; or
//!   nothing new can be seen, and none leads there in what is known, proven. A cell that holds anything counts as solid, so that a
//!   passage narrower than cells is none: this speaks of what is known, not of the world.
//! - *Unknown*: none of these within the decisions allowed, or the grid is too coarse for the way.
//!
//! ```
//! use cplan_explore::{Ending, Settings, Strategy, explore};
//! use cplan_core::model::{Scene, Sensor};
//! use cplan_core::model::{Arm, Obstacle, Workspace};
//! use cplan_core::space::Configuration;
//!
//! let arm = Arm::rr([0.6, 0.4], 0.04)?;
//! let post = Obstacle::circle("post", [0.5, 0.6], 0.1)?;
//! let scene = Scene::new(arm, Workspace::new([post]))?;
//! let sensor = Sensor { cell: 0.05, ..Sensor::usual(scene.arm()) };
//! let settings = Settings { strategy: Strategy::Nearest, cells: [48, 48], ..Settings::default() };
//! let exploration = explore(&scene, &sensor, Configuration::new(-2.0, 0.5), None, &settings, &mut |_| ())?;
//! assert!(matches!(exploration.ending, Ending::Explored { .. }));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod decision;
mod explorer;
mod frontier;
mod json;
mod known;
mod map_files;
mod reach;
mod result;
mod settings;
mod sight;
mod survey;
mod views;
mod wall;

pub use explorer::explore;
pub use map_files::{map_description, map_picture};
pub use result::{Ending, Exploration, Leg, Reading};
pub use settings::{ExploreError, Settings, Strategy};
pub use survey::{MOST_CELLS, Survey};
