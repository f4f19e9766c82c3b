//! What there is to see.

use super::arm;
use super::motion::{Clock, MotionView, PathView};
use super::numbers::Chain;
use super::phase::{MotionReplayView, PhaseView};
use super::steps::Row;
use super::trace::TraceView;
use super::world::{ObstacleView, WorldView};
use crate::flow::FieldLines;
use crate::stuck::Stuck;
use cplan_core::model::{Arm, Status};
use cplan_core::space::Configuration;
use cplan_explain::Reach;
use serde::{Serialize, Serializer};

/// How what is shown ended, for colours and symbols; `shown` where nothing was asked for: a comparison, a configuration.
fn ending<S: Serializer>(status: &Option<Status>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(status.map_or("shown", Status::name))
}

/// What a picture or a page shows. Lengths in metres, angles in radians, times in seconds, rounded to what can be seen.
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
    /// Empty-handed.
    #[serde(serialize_with = "arm::document")]
    pub(crate) arm: Arm,
    /// What of the workspace is shown: least and greatest of both coordinates.
    pub(crate) frame: [[f64; 2]; 2],
    pub(crate) start: [f64; 2],
    pub(crate) goals: Vec<[f64; 2]>,
    /// Goals along segments: both ends of each.
    pub(crate) goal_lines: Vec<Chain>,
    /// The first is the one that is there at first.
    pub(crate) worlds: Vec<WorldView>,
    pub(crate) paths: Vec<PathView>,
    pub(super) motions: Vec<MotionView>,
    pub(super) clock: Option<Clock>,
    pub(crate) frames: Vec<FrameView>,
    /// How the planner came to its answer: phases, one after the other.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) replay: Vec<PhaseView>,
    /// The same of a task's motions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) replays: Vec<MotionReplayView>,
    #[serde(skip)]
    pub(crate) still: Still,
}

/// A frame, drawn by its axes: see [`AxesFrame`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct FrameView {
    pub name: String,
    pub at: [f64; 2],
    pub axes: [[f64; 3]; 3],
}

/// What pictures show side by side, and pages one after the other: these have time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Still {
    /// None of an arm alone.
    pub panels: Vec<PanelView>,
    /// What is drawn of a field.
    pub field_lines: FieldLines,
    /// Objects where they are put, each place once.
    pub placed: Vec<ObstacleView>,
    /// Where the tip can get.
    pub reach: Option<Reach>,
    /// Where the arm is now, and in which world, while it moves.
    pub now: Option<([f64; 2], usize)>,
    /// What time it is then, seconds.
    pub time: f64,
    /// What is in the way.
    pub stuck: Option<Stuck>,
    /// Where the arm is in the end, and in which world.
    pub end: Option<([f64; 2], usize)>,
    /// The steps of a task, below what the columns are called; none of single motions.
    pub steps: Vec<Row>,
}

/// A configuration space, and what takes place in it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PanelView {
    /// The text above it.
    pub title: String,
    /// These differ in what link 2 may reach into alone.
    pub worlds: Vec<usize>,
    /// Those that are drawn; those that are repeated once.
    pub paths: Vec<usize>,
    /// Where the arm is at first.
    pub start: [f64; 2],
    /// The step that fails here, if one does.
    pub fails: Option<usize>,
}

impl View {
    /// Whether it is that of a task, whose steps have numbers.
    pub(crate) fn is_task(&self) -> bool {
        !self.still.steps.is_empty()
    }

    /// What the planner saw on its way to each motion of a task, as far as that is told.
    pub(crate) fn traces_of_steps(&self) -> impl Iterator<Item = &TraceView> {
        self.replays.iter().filter_map(|replay| replay.trace.as_ref())
    }

    /// The same with these lines of a field in pictures; pages show and hide each kind.
    #[must_use]
    pub fn with_field_lines(mut self, lines: FieldLines) -> Self {
        self.still.field_lines = lines;
        self
    }

    /// The same with the places that the tip can get to.
    #[must_use]
    pub fn with_reach(mut self, reach: &Reach) -> Self {
        self.still.reach = Some(reach.clone());
        self
    }

    /// How long the motion takes, seconds; none where nothing moves.
    pub(crate) fn duration(&self) -> Option<f64> {
        self.clock.as_ref().map(Clock::duration)
    }

    /// The same with the arm where it is at this time of the motion.
    pub(crate) fn moving(&self, time: f64) -> Self {
        let mut view = self.clone();
        let world =
            self.motions.iter().take_while(|motion| motion.from <= time).last().map_or(0, |motion| motion.world);
        view.still.time = time;
        view.still.now = self.clock.as_ref().map(|clock| (clock.at(time).into(), world));
        view
    }

    /// The world that is there at first, or now.
    pub(crate) fn world_now(&self) -> &WorldView {
        &self.worlds[self.still.now.map_or(0, |(_, world)| world)]
    }

    /// The same with what is in the way of a motion, and where it gets stuck.
    #[must_use]
    pub fn with_stuck(mut self, stuck: Stuck) -> Self {
        self.still.stuck = Some(stuck);
        self
    }

    /// The world that is there at first.
    pub(crate) fn first_world(&self) -> &WorldView {
        &self.worlds[0]
    }

    /// Configurations that were to be reached and are not, each with its world.
    pub(crate) fn unreached(&self) -> impl Iterator<Item = (usize, Configuration)> {
        let worlds = self.worlds.iter().enumerate();
        worlds.flat_map(|(index, world)| world.unreached.iter().map(move |&q| (index, q.into())))
    }

    /// Where motions end in a panel or were to, the number of the step, and whether one ends there (or none was found).
    pub(crate) fn ends(&self, panel: &PanelView) -> Vec<(Configuration, usize, bool)> {
        let paths = panel.paths.iter().map(|&index| &self.paths[index]).filter(|path| !path.grows);
        let is_alone = paths.clone().next().is_none();
        let goals = self.goals.iter().map(|&q| (q.into(), 0, is_alone));
        let unreached = &self.worlds[panel.worlds[0]].unreached;
        let unreached = unreached.iter().map(|&q| (q.into(), panel.fails.unwrap_or(0), false));
        goals.chain(unreached).chain(paths.map(|path| (path.goal(), path.step, true))).collect()
    }
}
