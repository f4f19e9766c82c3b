//! How a plan leaves cplan: as files, pictures, a page, and a summary for people.
//!
//! All of it are methods of [`Plan`](crate::engine::Plan): `bytes` and `save` for files, `svg` and `html` for pictures,
//! `summary` for a terminal; `cspaces` has the configuration space as data.

mod cspace;
#[cfg(feature = "program")]
pub(crate) mod explained;
mod file;
mod motion_summary;
mod picture;
#[cfg(feature = "mcap")]
mod stage;
mod step_lines;
mod summary;
mod task_summary;

pub use cspace::{
    Axis, Boxes, CSpace, CSpaceFormat, CSpaces, Cells, FieldGrid, FreeRegion, ObstacleRegion, Polygons, Roadmap,
    Values, Way, cspace_schema,
};
pub use file::{FileFormat, SaveError};
#[cfg(feature = "live")]
pub(crate) use picture::status;
pub use picture::{PictureFormat, PictureFormatError};
#[cfg(any(feature = "program", feature = "live"))]
pub(crate) use picture::{contours, title_of};
#[cfg(feature = "program")]
pub(crate) use step_lines::{StepLine, step_lines};
#[cfg(feature = "program")]
pub(crate) use summary::{Line, configuration, laid_out, range};
