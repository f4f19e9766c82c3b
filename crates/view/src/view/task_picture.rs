//! The data for a picture of a task.

use cplan_core::cspace::CObstacle;
use cplan_core::model::{Scene, Status};
use cplan_handling::{Task, TimedScene};
use cplan_tasks::TaskAnswer;

/// C-obstacles at some times.
pub type Moments = Vec<(f64, Vec<CObstacle>)>;

/// The content of a task's picture. Objects count as obstacles, numbered after the static ones: they have the same
/// colour at every place and in every world.
#[derive(Debug, Clone)]
pub struct TaskPicture<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// The outcome, in a word or two. For a failed step, its number comes before, and the reason below the title.
    pub status: String,
    /// The outcome, for colours and symbols.
    pub ending: Option<Status>,
    /// Facts about the result: names and values.
    pub facts: Vec<[String; 2]>,
    /// The task.
    pub task: &'a Task,
    /// The answer.
    pub answer: &'a TaskAnswer,
    /// Returns contours of a scene in joint space. Called for each world, and once more where link 2 reaches into an
    /// object.
    pub c_obstacles: fn(&Scene) -> Vec<CObstacle>,
    /// C-obstacles of moving obstacles at some times between two, with a greatest number of times.
    pub in_time: fn(TimedScene, [f64; 2], usize) -> Moments,
}
