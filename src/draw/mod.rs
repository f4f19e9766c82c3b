//! Pictures: pure functions of results, by way of a neutral figure that knows no file format.
//!
//! ```text
//! Picture (scene, paths, trace, C-obstacles) -> Figure -> SVG -> PNG
//!                                            \-> View -> JSON -> HTML
//! ```
//!
//! Two panels side by side: left the workspace in metres with the arm at the start, at the goal and on its way, and the
//! trace of its tip; right the configuration space in degrees or metres, with the C-obstacles in the colours of their
//! obstacles, the path and what the planner saw. The picture of a task has a configuration space for each payload state.
//! The same picture is the same file, byte for byte.

mod axes;
mod boxes;
mod chart;
mod color;
mod copies;
mod cspace;
mod extent;
mod figure;
mod frames;
mod isolines;
mod legend;
mod page;
#[cfg(feature = "png")]
mod png_writer;
mod arm;
mod preferences;
mod shapes;
mod svg_writer;
mod task;
mod trace;
mod view;
mod workspace;

pub use task::{TaskPicture, task_svg};
pub use view::{View, page, shell};

use crate::check::CheckedProof;
use crate::cspace::CObstacle;
use crate::geometry::Point;
use crate::model::Scene;
use crate::planner::Trace;
use crate::space::{Configuration, Measure, Metric, Path, Segment};
use nalgebra::Vector3;

/// What a picture shows. With one path, the path of a plan with the arm's poses along it; with several, a comparison
/// that tells the paths apart by colour and dashes; with none, the problem alone.
#[derive(Debug, Clone)]
pub struct Picture<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// How it ended, in a word or two.
    pub status: String,
    /// Arm and obstacles.
    pub scene: &'a Scene,
    /// Where the arm begins.
    pub start: Configuration,
    /// Where it may end: single configurations and segments. Without a path the arm is shown at the first, on a segment where
    /// it is nearest to the start.
    pub goals: &'a [Segment],
    /// Names and paths, in unwrapped values.
    pub paths: Vec<(String, &'a Path)>,
    /// What the planner saw.
    pub trace: Option<&'a Trace>,
    /// The proof that there is no path, if that is the answer.
    pub proof: Option<&'a CheckedProof>,
    /// Contours in joint space.
    pub c_obstacles: &'a [CObstacle],
}

impl Picture<'_> {
    /// The single goals, and where no path shows how a segment of them is reached its place nearest to the start.
    fn single_goals(&self) -> Vec<Configuration> {
        let shown = self.goals.iter().filter(|goal| goal.is_point() || self.paths.is_empty());
        shown.map(|goal| goal.nearest(Measure::from(Metric::Euclidean), self.start)).collect()
    }

    /// The configurations that the workspace has to have room for: start and goals.
    fn shown(&self) -> Vec<Configuration> {
        let mut shown = vec![self.start];
        shown.extend(self.single_goals());
        if self.goals.iter().any(|goal| !goal.is_point()) {
            shown.extend(self.paths.iter().map(|(_, path)| path.goal()));
        }
        shown
    }
}

/// A frame, drawn by its axes.
#[derive(Debug, Clone, PartialEq)]
pub struct AxesFrame {
    /// Written beside it.
    pub name: String,
    /// Origin, plane coordinates.
    pub at: Point,
    /// Directions of x, y and z: their parts along the plane's two coordinates and along its normal.
    pub axes: [Vector3<f64>; 3],
}

/// An arm in one configuration among its obstacles, with frames.
#[derive(Debug, Clone)]
pub struct ArmPicture<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// A word or two in the corner.
    pub status: String,
    /// Arm and obstacles.
    pub scene: &'a Scene,
    /// Where the arm is.
    pub at: Configuration,
    /// Drawn above everything.
    pub frames: Vec<AxesFrame>,
}

impl<'a> ArmPicture<'a> {
    /// The same without its frames and with nowhere to go.
    fn picture(&self) -> Picture<'a> {
        Picture {
            title: self.title.clone(),
            status: self.status.clone(),
            scene: self.scene,
            start: self.at,
            goals: &[],
            paths: Vec::new(),
            trace: None,
            proof: None,
            c_obstacles: &[],
        }
    }
}

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DrawError {
    /// The size is no size.
    #[error("a picture at {0} pixels a unit would be empty, or more than 16384 pixels wide")]
    Scale(f64),
    /// The SVG document could not be read back.
    #[error("cannot rasterise the picture: {0}")]
    Svg(String),
    /// The pixels could not be compressed.
    #[error("cannot write the picture as PNG: {0}")]
    Png(String),
}

/// The picture as an SVG document of 1400 x 720 pixels.
#[must_use]
pub fn svg(picture: &Picture) -> String {
    svg_writer::write(&page::compose(picture))
}

/// An SVG document as a PNG file, of its size times `scale`.
///
/// # Errors
/// [`DrawError::Scale`] if the scale is not a positive number of a sensible size.
#[cfg(feature = "png")]
pub fn png(svg: &str, scale: f64) -> Result<Vec<u8>, DrawError> {
    png_writer::write(svg, scale)
}

/// The arm as an SVG document of 1400 x 720 pixels: the workspace alone.
#[must_use]
pub fn arm_svg(arm_picture: &ArmPicture) -> String {
    svg_writer::write(&page::compose_arm(arm_picture))
}
