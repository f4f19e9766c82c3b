//! The content of pictures and pages, determined once: both render the same view.
//!
//! ```text
//! Picture, TaskPicture -> View -> Figure -> SVG -> PNG
//!                             \-> JSON -> page
//! ```
//!
//! A [`View`] contains the arm, the worlds that it moves in with their C-obstacles, paths with their colours, and the
//! motions in time. There is one world for a single motion, and one for each payload state of a task. Numbers are
//! rounded to visible precision. In pages, the page's code computes kinematics, contacts and layers, so that a user can
//! place the arm anywhere. A page is one file that needs no network. The same view always gives the same file, byte for
//! byte.

mod arm;
mod extent;
mod flow;
mod html;
mod isolines;
mod motion;
mod names;
mod numbers;
mod picture;
mod replay;
mod slope;
mod states;
mod steps;
mod task;
mod trace;
mod waves;
mod world;

pub use html::{drawing, page, sealed, shell};
pub use picture::{AxesFrame, Picture};
pub use task::{Moments, TaskPicture};

pub(super) use extent::around;
pub(super) use motion::PathView;
pub(super) use names::NameView;
pub(super) use numbers::{Chain, Grain};
use replay::{MotionReplayView, PhaseView};
pub(super) use states::ranges;
pub(super) use steps::Row;
pub(super) use trace::{LevelView, ScaleView, TraceView};
pub(super) use waves::{LEVELS, Waves};
pub(super) use world::{ContourView, NAMED, ObstacleView, PayloadView, RegionView, WorldView};

use super::flow::FieldLines;
use super::legend::{self, KeyView};
use super::reach::ReachView;
use super::stuck::Stuck;
use cplan_core::model::{Arm, Status};
use cplan_core::space::Configuration;
use cplan_engine::Reach;
use motion::{Clock, MotionView};
use serde::{Serialize, Serializer};

/// Serialises the outcome for colours and symbols; `shown` if there was no task, as for a comparison or a
/// configuration.
fn ending<S: Serializer>(status: &Option<Status>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(status.map_or("shown", Status::name))
}

/// The content of a picture or a page. Lengths in metres, angles in radians, times in seconds, rounded to visible
/// precision.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct View {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// Outcome in a word or two.
    pub status: String,
    /// Outcome for colours and symbols.
    #[serde(serialize_with = "ending")]
    pub ending: Option<Status>,
    /// Facts about the result: names and values, such as `length` and `4.4963 rad`.
    pub facts: Vec<[String; 2]>,
    /// Arm without payload.
    #[serde(serialize_with = "arm::document")]
    pub(super) arm: Arm,
    /// Visible part of the workspace: least and greatest value of both coordinates.
    pub(super) frame: [[f64; 2]; 2],
    pub(super) start: [f64; 2],
    pub(super) goals: Vec<[f64; 2]>,
    /// Goals along segments: both ends of each.
    pub(super) goal_lines: Vec<Chain>,
    /// Worlds; the first one is the initial world.
    pub(super) worlds: Vec<WorldView>,
    pub(super) paths: Vec<PathView>,
    motions: Vec<MotionView>,
    clock: Option<Clock>,
    pub(super) frames: Vec<FrameView>,
    /// Phases of the planner's run, in order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) replay: Vec<PhaseView>,
    /// Replays of the planner for the motions of a task.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    replays: Vec<MotionReplayView>,
    #[serde(skip)]
    pub(super) still: Still,
}

/// The document of a page: a view, its legend, the blocking obstacles, and the reachable places.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    view: &'a View,
    legend: Vec<KeyView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stuck: Option<&'a Stuck>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reach: Option<ReachView>,
}

/// A frame, drawn by its axes: see [`AxesFrame`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct FrameView {
    pub name: String,
    pub at: [f64; 2],
    pub axes: [[f64; 3]; 3],
}

/// Content that pictures show side by side. Pages show it one after the other, because they have time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Still {
    /// Panels with configuration spaces; empty for an arm alone.
    pub panels: Vec<PanelView>,
    /// The kinds of lines that are drawn of a field.
    pub field_lines: FieldLines,
    /// Objects at the places where the task puts them, each place once.
    pub placed: Vec<ObstacleView>,
    /// Reachable places of the tip.
    pub reach: Option<Reach>,
    /// Current configuration and world of the arm, while it moves.
    pub now: Option<([f64; 2], usize)>,
    /// Current time, in seconds.
    pub time: f64,
    /// Blocking obstacles.
    pub stuck: Option<Stuck>,
    /// Final configuration and world of the arm.
    pub end: Option<([f64; 2], usize)>,
    /// Steps of a task, below the titles of the columns; empty for a single motion.
    pub steps: Vec<Row>,
}

/// A panel with a configuration space.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PanelView {
    /// Text above the panel.
    pub title: String,
    /// Worlds of the panel. They differ only in the obstacles that link 2 may reach into.
    pub worlds: Vec<usize>,
    /// Paths that are drawn; repeated paths only once.
    pub paths: Vec<usize>,
    /// Initial configuration of the arm.
    pub start: [f64; 2],
    /// The step that fails here, if one does.
    pub fails: Option<usize>,
}

impl View {
    /// Returns true if the view shows a task, whose steps have numbers.
    pub(super) fn is_task(&self) -> bool {
        !self.still.steps.is_empty()
    }

    /// Returns the planner's trace of each motion of a task, as far as the document contains them.
    pub(super) fn traces_of_steps(&self) -> impl Iterator<Item = &TraceView> {
        self.replays.iter().filter_map(|replay| replay.trace.as_ref())
    }

    /// Selects the lines of a field in pictures; pages can show and hide each kind.
    #[must_use]
    pub fn with_field_lines(mut self, lines: FieldLines) -> Self {
        self.still.field_lines = lines;
        self
    }

    /// Adds the reachable places of the tip.
    #[must_use]
    pub fn with_reach(mut self, reach: &Reach) -> Self {
        self.still.reach = Some(reach.clone());
        self
    }

    /// Returns the duration of the motion in seconds; `None` if nothing moves.
    pub(super) fn duration(&self) -> Option<f64> {
        self.clock.as_ref().map(Clock::duration)
    }

    /// Returns this view with the arm at this time of the motion.
    pub(super) fn moving(&self, time: f64) -> Self {
        let mut view = self.clone();
        let world =
            self.motions.iter().take_while(|motion| motion.from <= time).last().map_or(0, |motion| motion.world);
        view.still.time = time;
        view.still.now = self.clock.as_ref().map(|clock| (clock.at(time).into(), world));
        view
    }

    /// Returns the current world; without a motion, the initial one.
    pub(super) fn world_now(&self) -> &WorldView {
        &self.worlds[self.still.now.map_or(0, |(_, world)| world)]
    }

    /// Adds the blocking obstacles of a motion, and the configuration where it gets stuck.
    #[must_use]
    pub fn with_stuck(mut self, stuck: Stuck) -> Self {
        self.still.stuck = Some(stuck);
        self
    }

    /// Returns the initial world.
    pub(super) fn first_world(&self) -> &WorldView {
        &self.worlds[0]
    }

    /// Returns configurations that should be reached and are not, each with its world.
    pub(super) fn unreached(&self) -> impl Iterator<Item = (usize, Configuration)> {
        let worlds = self.worlds.iter().enumerate();
        worlds.flat_map(|(index, world)| world.unreached.iter().map(move |&q| (index, q.into())))
    }

    /// Returns the goals of the motions in a panel, with the number of the step. The flag is true if a motion ends
    /// there (or if no path was found).
    pub(super) fn ends(&self, panel: &PanelView) -> Vec<(Configuration, usize, bool)> {
        let paths = panel.paths.iter().map(|&index| &self.paths[index]).filter(|path| !path.grows);
        let is_alone = paths.clone().next().is_none();
        let goals = self.goals.iter().map(|&q| (q.into(), 0, is_alone));
        let unreached = &self.worlds[panel.worlds[0]].unreached;
        let unreached = unreached.iter().map(|&q| (q.into(), panel.fails.unwrap_or(0), false));
        goals.chain(unreached).chain(paths.map(|path| (path.goal(), path.step, true))).collect()
    }

    /// Returns the document that the page's code reads.
    ///
    /// # Panics
    /// Never: all keys are strings.
    #[must_use]
    pub fn json(&self) -> String {
        let reach = self.still.reach.as_ref().map(|reach| ReachView::new(reach, Grain::of(&self.arm)));
        let stuck = self.still.stuck.as_ref();
        let document = Document { view: self, legend: legend::on_pages(self), stuck, reach };
        serde_json::to_string(&document).expect("numbers and strings")
    }
}
