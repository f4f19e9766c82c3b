//! Pages that people move things in: the same results as the pictures, for a browser to draw.
//!
//! ```text
//! Picture, TaskPicture -> View (a document of numbers and names) -> JSON -> page
//! ```
//!
//! A [`View`] holds what happens and where: the arm, the worlds that it moves in (one for a plan, one for each payload
//! state of a task) with their C-obstacles, and the motions in time. Kinematics, contacts and layers are the page's work,
//! so that whoever holds it can put the arm anywhere. A page is one file that needs no network; the same view is the same
//! file, byte for byte.

mod arm;
mod flow;
mod html;
mod motion;
mod round;
mod task;
mod trace;
mod world;

pub use html::{page, shell};

use super::{ArmPicture, Picture, TaskPicture, extent};
use crate::model::Status;
use crate::motion::Trajectory;
use crate::space::Segment;
use arm::ArmView;
use motion::{Clock, MotionView, PathView};
use round::Grain;
use serde::{Serialize, Serializer};
use world::WorldView;

/// How what is shown ended, for colours and symbols; `shown` where nothing was asked for: a comparison, a configuration.
fn ending<S: Serializer>(status: &Option<Status>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(status.map_or("shown", Status::name))
}

/// What a page shows. Lengths in metres, angles in radians, times in seconds, rounded to what can be seen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct View {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// How it ended, in a word or two.
    pub status: String,
    /// The same for colours and symbols.
    #[serde(serialize_with = "ending")]
    pub ending: Option<Status>,
    /// What is to be said of the result: names and values, such as `length` and `4.4963 rad`.
    pub facts: Vec<[String; 2]>,
    arm: ArmView,
    /// What of the workspace is shown: least and greatest of both coordinates.
    frame: [[f64; 2]; 2],
    start: [f64; 2],
    goals: Vec<[f64; 2]>,
    /// Goals along segments: both ends of each, one coordinate after the other.
    goal_lines: Vec<[f64; 4]>,
    worlds: Vec<WorldView>,
    paths: Vec<PathView>,
    motions: Vec<MotionView>,
    clock: Option<Clock>,
    frames: Vec<FrameView>,
}

/// A frame, drawn by its axes: see [`super::AxesFrame`].
#[derive(Debug, Clone, PartialEq, Serialize)]
struct FrameView {
    name: String,
    at: [f64; 2],
    axes: [[f64; 3]; 3],
}

impl View {
    /// The view of a picture; with a trajectory, that of the motion along its only path.
    #[must_use]
    pub fn of_picture(
        picture: &Picture,
        ending: Option<Status>,
        facts: Vec<[String; 2]>,
        motion: Option<&Trajectory>,
    ) -> Self {
        let arm = picture.scene.arm();
        let grain = Grain::of(arm);
        let world = WorldView::new(picture.scene, String::new(), picture.c_obstacles, grain);
        let world = match picture.trace {
            Some(trace) => world.traced(trace, &arm.topology(), grain),
            None => world,
        };
        let line = |goals: &Segment| {
            let [[a, b], [c, d]] = goals.ends().map(|q| grain.configuration(q));
            [a, b, c, d]
        };
        Self {
            title: picture.title.clone(),
            status: picture.status.clone(),
            ending,
            facts,
            arm: ArmView::new(picture.scene, grain),
            frame: extent::sides(picture.scene, &picture.shown())
                .map(|(lower, upper)| [lower, upper].map(|x| grain.length(x))),
            start: grain.configuration(picture.start),
            goals: picture.single_goals().into_iter().map(|q| grain.configuration(q)).collect(),
            goal_lines: picture.goals.iter().filter(|goal| !goal.is_point()).map(line).collect(),
            worlds: vec![world.proven(picture.proof, grain)],
            paths: PathView::of_picture(&picture.paths, grain),
            motions: motion.map(|trajectory| MotionView::only(trajectory.duration())).into_iter().collect(),
            clock: motion.map(|trajectory| Clock::new(trajectory, grain)),
            frames: Vec::new(),
        }
    }

    /// The view of an arm in one configuration, without its configuration space.
    #[must_use]
    pub fn of_arm(arm_picture: &ArmPicture) -> Self {
        let grain = Grain::of(arm_picture.scene.arm());
        let frames = arm_picture.frames.iter().map(|frame| FrameView {
            name: frame.name.clone(),
            at: grain.point(frame.at),
            axes: frame.axes.map(|axis| [axis.x, axis.y, axis.z].map(|x| grain.number(x))),
        });
        Self { frames: frames.collect(), ..Self::of_picture(&arm_picture.picture(), None, Vec::new(), None) }
    }

    /// The view of a task: a world for each set of motions that share one.
    #[must_use]
    pub fn of_task(picture: &TaskPicture, ending: Option<Status>, facts: Vec<[String; 2]>) -> Self {
        task::view(picture, ending, facts)
    }

    /// The document that the page's code reads.
    ///
    /// # Panics
    /// Never: all keys are strings.
    #[must_use]
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("numbers and strings")
    }
}
