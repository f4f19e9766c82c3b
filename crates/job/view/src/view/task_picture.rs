//! The data for a picture of a task.

use cplan_handling::{Task, TimedScene};
use cplan_legs::TaskAnswer;
use cplan_model::{Scene, Status};
use cplan_motion::PlaceTime;
use cplan_planners::cspace::CObstacle;

/// C-obstacles of moving obstacles at several times, in seconds.
pub type Moments = Vec<(f64, Vec<CObstacle>)>;

/// The content of a task's picture. Objects count as obstacles, and their numbers follow those of static obstacles. So an object
/// has the same colour at every place and in every world.
#[derive(Debug, Clone)]
pub struct TaskPicture<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// The outcome, in a word or two. If a step fails, the status begins with the step's number, and lines below the title state
    /// the reason.
    pub status: String,
    /// The outcome, for colours and symbols.
    pub ending: Option<Status>,
    /// Facts about the result: names and values.
    pub facts: Vec<[String; 2]>,
    /// The task.
    pub task: &'a Task,
    /// The answer.
    pub answer: &'a TaskAnswer,
    /// The times at which moving obstacles block places on the motion. `None` if no obstacle moves.
    pub plane: Option<&'a PlaceTime>,
    /// Computes contours of a scene's C-obstacles in joint space. It is called for each world, and once more if link 2 may reach
    /// into an object.
    pub c_obstacles: fn(&Scene) -> Vec<CObstacle>,
    /// Computes C-obstacles of moving obstacles at times between the two given ones. The last argument limits the number of
    /// times.
    pub in_time: fn(TimedScene, [f64; 2], usize) -> Moments,
}
