//! Pictures of tasks: the workspace with all that happens in it, and a configuration space for each payload state.

mod grid;
mod page;
mod panel;
mod states;
mod steps;
mod tags;
mod workspace;

pub(super) use states::describe;
pub(super) use steps::words;

use super::{color, svg_writer};
use crate::cspace::CObstacle;
use crate::engine::task::{Leg, TaskAnswer};
use crate::model::{Scene, Task};

/// What the picture of a task shows. Objects count as obstacles, numbered after those that stay: they have the same
/// colour wherever they are, and in every panel.
#[derive(Debug, Clone)]
pub struct TaskPicture<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// How it ended, in a word or two. Where a step fails, its number comes before, and the reason below the title.
    pub status: String,
    /// What was asked.
    pub task: &'a Task,
    /// What came of it.
    pub answer: &'a TaskAnswer,
    /// Contours of a scene in joint space. Asked for the panels that are drawn, twice where link 2 reaches into an
    /// object.
    pub c_obstacles: fn(&Scene) -> Vec<CObstacle>,
}

/// The task as an SVG document, 1400 pixels wide and as high as its panels need.
#[must_use]
pub fn task_svg(picture: &TaskPicture) -> String {
    svg_writer::write(&page::compose(picture))
}

/// The colour of an object, the same as an obstacle's.
fn object_color(task: &Task, object: usize) -> color::Rgb {
    color::obstacle(task.obstacle_number(object))
}

/// The pen of a motion: that of the object which is carried, or a thin grey one.
pub(super) fn motion_pen(task: &Task, leg: &Leg) -> super::figure::Pen {
    let (color, width) = match leg.carried {
        Some(object) => (object_color(task, object).darker(0.25), 2.4),
        None => (color::INK.lighter(0.3), 1.6),
    };
    super::figure::Pen { color, width, dash: &[] }
}
