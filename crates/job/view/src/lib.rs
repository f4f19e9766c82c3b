//! Pictures and pages as pure functions of results. Both are made from one description of the content, the [`View`].
//!
//! ```text
//! Picture (one motion), TaskPicture -> View -> Figure -> SVG, PNG
//!                                     |    \-> one a moment -> GIF
//!                                     \-> JSON -> HTML
//! ```
//!
//! A picture has two panels side by side. The left one is the workspace in metres: the arm at the start, at the goal and along
//! its path, and the trace of its tip. The right one is the configuration space in degrees or metres: the C-obstacles with the
//! colours and names of their obstacles, the path, and the planner's trace. Only proofs are hatched. The picture of a task has a
//! configuration space for each payload state.
//!
//! The [`View`] determines the content and its colours. The [`Figure`] places the content on the page, whatever the file format.
//! The same view always gives the same file, byte for byte.

pub mod output;
mod animation;
mod arm;
mod axes;
mod boxes;
mod channel;
mod chart;
mod compared;
mod checked;
mod copies;
mod cspace;
pub mod figure;
mod flow;
mod followed;
mod frames;
#[cfg(feature = "png")]
mod gif_writer;
mod grid;
mod key;
mod labels;
mod legend;
mod letter_widths;
#[cfg(feature = "png")]
mod letters;
mod named;
mod object;
mod obstacles;
mod page;
mod polygon_pair;
mod preferences;
#[cfg(feature = "png")]
mod rasterizer;
mod regions;
mod section;
pub mod shapes;
mod steps;
mod strip;
mod blocking;
mod svg_writer;
mod tags;
mod trace;
mod view;
mod wave_numbers;
mod workspace;

pub use axes::{Frame, Unit};
pub use blocking::BlockingView;
pub use checked::CheckedView;
pub use compared::{ComparedPaths, SmallPicture, compared};
pub use figure::Figure;
pub use flow::FieldLines;
pub use followed::{LineSettings, LineView, MoveMark};
pub use object::Object;
pub use obstacles::{extent, obstacles, still_page};
pub use page::{heading, titles, verdict};
pub use polygon_pair::{PolygonPair, polygon_pair};
pub use section::{CellLayer, Section};
pub use view::{
    AxesFrame, KeyFigures, Moments, Picture, TaskPicture, View, drawing, inspection_page, page, sealed, shell,
};
pub use view::{Chain, ContourView, ObstacleView, PathView, RoundingSteps, bounding_box, contour_views, listed_number};

/// The reason why there is no picture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DrawError {
    /// The scale or the size of the picture is not usable.
    #[error("a picture at {0} pixels a unit would be empty, or more than 16384 pixels wide")]
    Scale(f64),
    /// The pixels could not be compressed.
    #[error("cannot write the picture as PNG: {0}")]
    Png(String),
    /// The pictures could not be combined.
    #[error("cannot write the picture as GIF: {0}")]
    Gif(String),
}

/// Returns the picture of a view, 1400 pixels wide and 720 high; pictures of tasks can be higher.
pub fn figure(view: &View) -> Figure {
    page::compose(view)
}

/// Returns the picture of a view as an SVG document.
pub fn svg(view: &View) -> String {
    figure(view).svg()
}

/// Returns the workspace alone as a small SVG document, whose texts are legible on a phone.
pub fn workspace_svg(view: &View) -> String {
    page::workspace_figure(view).svg()
}

/// Iterates over the pictures of a view's animation: SVG documents, each with the time for which it is shown, in hundredths of a
/// second. If the view contains a replay, the animation first shows how the planner found its answer. Then it shows the arm's
/// motion. The last document is [`svg()`].
pub fn moving(view: &View) -> impl Iterator<Item = (String, u16)> {
    let moments = animation::moments(view).into_iter();
    moments.map(|moment| (animation::figure(view, moment).svg(), moment.delay))
}

/// Returns the animation of a view as a GIF of this width. If the view contains a replay, the animation first shows how
/// the planner found its answer. Then it shows the motion of the arm. `progress` receives the number of finished
/// pictures and the number of all.
///
/// # Errors
/// [`DrawError::Scale`] if the width is not usable.
#[cfg(feature = "png")]
pub fn gif(view: &View, width: f64, progress: &mut dyn FnMut(usize, usize)) -> Result<Vec<u8>, DrawError> {
    let moments = animation::moments(view);
    let figures = moments.iter().map(|&moment| (animation::figure(view, moment), moment.delay));
    let mut done = 0;
    gif_writer::write(figures, width, &mut || {
        done += 1;
        progress(done, moments.len());
    })
}
