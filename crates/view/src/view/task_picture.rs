//! A task as it is given to be drawn.

use cplan_core::cspace::CObstacle;
use cplan_core::model::{Scene, Status};
use cplan_handling::Task;
use cplan_tasks::TaskAnswer;

/// C-obstacles at some times.
pub type Moments = Vec<(f64, Vec<CObstacle>)>;

/// What there is to show of a task. Objects count as obstacles, numbered after those that stay: they have the same
/// colour wherever they are, and in every world.
#[derive(Debug, Clone)]
pub struct TaskPicture<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// How it ended, in a word or two. Where a step fails, its number comes before, and the reason below the title.
    pub status: String,
    /// The same for colours and symbols.
    pub ending: Option<Status>,
    /// What is to be said of the result: names and values.
    pub facts: Vec<[String; 2]>,
    /// What was asked.
    pub task: &'a Task,
    /// What came of it.
    pub answer: &'a TaskAnswer,
    /// Contours of a scene in joint space. Asked for each world, and once more where link 2 reaches into an object.
    pub c_obstacles: fn(&Scene) -> Vec<CObstacle>,
    /// Those of what moves, at some times from one to another, so many at the most.
    pub in_time: fn(&Scene, [f64; 2], usize) -> Moments,
}
