//! Planning in a world that a sensor reveals step by step.
//!
//! The given world is the true one. The explorer knows only the cells that its [`Sensor`](cplan_world::Sensor) has seen, and
//! treats all others as solid. Each motion is certified within the known free space before it begins, so the arm never enters
//! unseen space. The page that plays an exploration certifies each motion once more, in the true world.
//!
//! ```text
//! look -> map -> known free configurations, frontier among them -> decision -> certified leg -> on the way: look ...
//! ```
//!
//! # Endings
//!
//! - *Reached*: the arm is at the goal.
//! - *Explored*: no reading at any reachable configuration of the grid would show anything new. This is decided, not
//!   estimated: rays are as wide as the cells that they cross, so the result of a reading is known in advance up to the
//!   first unknown cell of each ray ([`Survey::reachable_unknown`]). With distance errors, a reading may not show the
//!   expected cells. Such configurations are counted.
//! - *Unreachable*: proven. Either no path leads to the goal past the occupied cells, whatever the unseen cells
//!   contain; or nothing new can be seen, and no path leads there in the known space. An occupied cell is solid as a
//!   whole, so passages narrower than a cell are closed. The proof is about the map, not about the world.
//! - *Unknown*: the allowed number of decisions was reached without another ending, or the grid is too coarse for the path.
//!
//! ```
//! use cplan_explore::{Ending, Settings, Strategy, explore};
//! use cplan_model::{Arm, Obstacle, Scene, Workspace};
//! use cplan_model::space::Configuration;
//! use cplan_world::Sensor;
//!
//! let arm = Arm::rr([0.6, 0.4], 0.04)?;
//! let post = Obstacle::circle("post", [0.5, 0.6], 0.1)?;
//! let scene = Scene::new(arm, Workspace::new([post]))?;
//! let sensor = Sensor { cell: 0.05, ..Sensor::default_for(scene.arm()) };
//! let settings = Settings { strategy: Strategy::Nearest, cells: [48, 48], ..Settings::default() };
//! let exploration = explore(&scene, &sensor, Configuration::new(-2.0, 0.5), None, &settings, &mut |_| ())?;
//! assert!(matches!(exploration.ending, Ending::Explored { .. }));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod decision;
mod explorer;
mod frontier;
mod json;
mod known_space;
mod map_files;
mod page;
mod reach;
mod result;
mod settings;
mod sight;
mod survey;
mod views;
mod wall;

pub use explorer::explore;
pub use map_files::{map_description, map_picture};
pub use page::exploration_page;
pub use result::{Ending, Exploration, Leg, SensorReading};
pub use settings::{ExploreError, Settings, Strategy};
pub use survey::{MAX_CELLS, Survey};
