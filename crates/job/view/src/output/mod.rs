//! Output of a plan: files, pictures, a page, and a summary for people.
//!
//! [`PlanOutput`] adds them to [`Plan`]: `bytes` and `save` write files, `svg` and `html` draw pictures, `summary` is for a
//! terminal, and `cspaces` returns the configuration space as data.

mod cspace;
pub mod checked_words;
mod file;
mod motion_summary;
pub mod names;
mod picture;
#[cfg(feature = "mcap")]
mod stage;
mod step_lines;
mod summary;
mod task_summary;

pub use cspace::{
    Axis, Boxes, CSpace, CSpaceFormat, CSpaces, Cells, FieldGrid, FreeRegion, ObstacleRegion, PathData, Polygons,
    Roadmap, Values,
};
pub use file::{FileFormat, SaveError};
pub use picture::{PictureFormat, PictureFormatError, contours, replayed, status, title_of, view_with};
pub use step_lines::{StepLine, step_lines};
pub use summary::{Line, configuration, format_columns, goal_lines, range, summary_with};

use crate::{DrawError, View};
use cplan_engine::Plan;
#[cfg(feature = "mcap")]
use cplan_motion::Format;
use cplan_motion::write_whole;
use std::path::Path;

/// The forms in which a [`Plan`] can be written.
pub trait PlanOutput {
    /// Returns the planner's configuration space as data. Computes the C-obstacles again, which takes as long as for a
    /// picture.
    fn cspaces(&self) -> CSpaces;

    /// Returns the plan as a file of this format. Returns `None` if the format contains only a trajectory or only a grid, which
    /// the plan lacks. All formats except MCAP, PNG and GIF are text in UTF-8.
    ///
    /// # Errors
    /// A picture that cannot be rendered.
    fn bytes(&self, format: FileFormat) -> Result<Option<Vec<u8>>, DrawError>;

    /// Writes the plan into a file, completely or not at all. The extension determines the format, see
    /// [`FileFormat::from_path`].
    ///
    /// # Errors
    /// An unknown extension, a missing trajectory, a picture that cannot be made, and I/O errors.
    fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError>;

    /// Returns the content of the plan's pictures and pages.
    fn view(&self) -> View;

    /// Returns the view with a replay of the planner, for formats that can show it.
    fn view_with_replay(&self) -> View;

    /// Returns an SVG document with workspace and configuration space side by side, and the steps of a task.
    fn svg(&self) -> String;

    /// Returns a self-contained page that plays the motion and in which the arm can be moved.
    fn html(&self) -> String;

    /// Returns the result in some ten lines for people. The verdict comes first. There is a line for each step of a
    /// task.
    fn summary(&self) -> String;

    /// Returns the first line of the summary: the result, or the reason why there is none.
    fn verdict(&self) -> String;
}

impl PlanOutput for Plan {
    fn cspaces(&self) -> CSpaces {
        cspace::cspaces(self)
    }

    fn bytes(&self, format: FileFormat) -> Result<Option<Vec<u8>>, DrawError> {
        match format {
            #[cfg(feature = "mcap")]
            FileFormat::Result(Format::Mcap) => Ok(stage::stage(self).and_then(|stage| self.recording(Some(&stage)))),
            FileFormat::Result(format) => Ok(self.encoded(format)),
            FileFormat::CSpace(format) => Ok(format.text(&self.cspaces()).map(String::into_bytes)),
            FileFormat::Picture(format) if format.is_animated() => format.bytes(&self.view_with_replay()).map(Some),
            FileFormat::Picture(format) => format.bytes(&self.view()).map(Some),
        }
    }

    fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        let format = FileFormat::from_path(path)?;
        let Some(contents) = self.bytes(format)? else {
            let content = if let FileFormat::CSpace(_) = format { "grid" } else { "trajectory" };
            return Err(SaveError::Empty { file: path.display().to_string(), content });
        };
        Ok(write_whole(path, &contents)?)
    }

    fn view(&self) -> View {
        let mut view = view_with(self, picture::contours_of(self.options()));
        if let Some((problem, answer)) = self.motion()
            && let Some(set) = motion_summary::blocking(problem, answer)
        {
            view.title.insert(0, format!("No path: {}", names::blame_in_words(problem.scene(), &set)));
        }
        if let Some(headline) = picture::headline(self) {
            // The names are the second line, together with the numbers.
            let rest = view.title.drain(..view.title.len().min(2)).collect::<Vec<_>>().join(" \u{b7} ");
            view.title.splice(0..0, [headline, rest]);
        }
        view
    }

    fn view_with_replay(&self) -> View {
        replayed(self, self.view())
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

    fn verdict(&self) -> String {
        summary::verdict(self)
    }
}
