//! How a plan leaves cplan: as files, pictures, a page, and a summary for people.
//!
//! [`PlanOutput`] adds all of it to [`Plan`]: `bytes` and `save` for files, `svg` and `html` for pictures,
//! `summary` for a terminal; `cspaces` has the configuration space as data.

mod cspace;
pub mod explained;
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
pub use picture::{PictureFormat, PictureFormatError};
pub use picture::{contours, title_of};
pub use picture::{replayed, status, view_with};
pub use step_lines::{StepLine, step_lines};
pub use summary::{Line, configuration, laid_out, range, summary_with};

use crate::{DrawError, View};
use cplan_engine::Plan;
use std::path::Path;

/// What a [`Plan`] can be written as.
pub trait PlanOutput {
    /// The configuration space as its planner saw it, as data. C-obstacles are traced anew, which takes the time that it takes for a
    /// picture.
    #[must_use]
    fn cspaces(&self) -> CSpaces;

    /// The plan as a file of this format; none if the format holds only a trajectory and there is none. All except MCAP, PNG and GIF
    /// are text in UTF-8.
    ///
    /// # Errors
    /// A picture that cannot be made of pixels.
    fn bytes(&self, format: FileFormat) -> Result<Option<Vec<u8>>, DrawError>;

    /// Writes the plan into a file, whole or not at all. The extension says what it holds, see [`FileFormat::from_path`].
    ///
    /// # Errors
    /// An unknown extension, a missing trajectory, a picture that cannot be made, I/O.
    fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError>;

    /// What its pictures and pages show.
    #[must_use]
    fn view(&self) -> View;

    /// The same with how the planner came to its answer, for pictures and pages that play.
    #[must_use]
    fn view_with_replay(&self) -> View;

    /// Workspace and configuration space side by side, as an SVG document; of a task also its steps.
    #[must_use]
    fn svg(&self) -> String;

    /// A page that stands by itself, in which the motion is played and the arm can be moved.
    #[must_use]
    fn html(&self) -> String;

    /// The result in some ten lines for people, the verdict first; of a task a line for each step.
    #[must_use]
    fn summary(&self) -> String;
}

impl PlanOutput for Plan {
    fn cspaces(&self) -> CSpaces {
        cspace::cspaces(self)
    }

    fn bytes(&self, format: FileFormat) -> Result<Option<Vec<u8>>, DrawError> {
        file::bytes(self, format)
    }

    fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        file::save(self, path.as_ref())
    }

    fn view(&self) -> View {
        picture::view(self)
    }

    fn view_with_replay(&self) -> View {
        picture::view_with_replay(self)
    }

    fn svg(&self) -> String {
        crate::svg(&self.view())
    }

    fn html(&self) -> String {
        crate::page(&self.view_with_replay())
    }

    fn summary(&self) -> String {
        summary::summary_with(self, &[], &[], false)
    }
}
