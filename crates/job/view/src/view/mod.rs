//! The content of pictures and pages, determined once, so that both show the same.
//!
//! ```text
//! Picture, TaskPicture -> View -> Figure -> SVG -> PNG
//!                             \-> JSON -> page
//! ```
//!
//! A [`View`] contains the arm, its worlds with their C-obstacles, coloured paths, and the motions over time. A single motion has
//! one world, and a task has one for each payload state. Numbers are rounded to visible precision. The code of a page computes
//! kinematics, contacts and layers itself, so that users can place the arm anywhere. A page is one file that needs no network.
//! The same view always gives the same file, byte for byte.

mod arm;
mod content;
mod document;
mod extent;
mod flow;
mod html;
mod isolines;
mod motion;
mod numbers;
mod phase;
mod picture;
mod replay;
mod slope;
mod states;
mod steps;
mod height;
mod tool_angle;
mod strip;
mod task;
mod task_picture;
mod trace;
mod waves;
mod world;

pub use content::{KeyFigures, View};
pub use extent::bounding_box;
pub use html::{drawing, inspection_page, page, sealed, shell};
pub use picture::{AxesFrame, Picture};
pub use task_picture::{Moments, TaskPicture};

pub(super) use arm::{reach_shape, titles};
pub(super) use content::{FrameView, PanelView};
pub(super) use motion::Clock;
pub use motion::PathView;
pub use numbers::{Chain, RoundingSteps};
pub(super) use states::ranges;
pub(super) use steps::Row;
pub(super) use strip::StripView;
pub(super) use trace::{LevelView, ScaleView, TraceView};
pub(super) use waves::{LEVELS, Waves};
pub use world::{ContourView, ObstacleView, contours as contour_views, listed_number};
pub(super) use world::{MAX_NAMED_OBSTACLES, PayloadView, RegionView, WorldView};
