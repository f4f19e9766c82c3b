//! How a plan leaves cplan: as files, pictures, a page, and a summary for people.
//!
//! All of it are methods of [`Plan`](crate::engine::Plan): `bytes` and `save` for files, `svg` and `html` for pictures,
//! `summary` for a terminal.

mod file;
mod picture;
mod step_lines;
mod summary;
mod task_summary;

pub use file::{FileFormat, SaveError};
pub use picture::{Drawn, PictureFormat, PictureFormatError};
pub(crate) use picture::{contours, status, title_of};
pub(crate) use step_lines::{StepLine, step_lines};
pub(crate) use summary::{Line, configuration, laid_out, range, value};
