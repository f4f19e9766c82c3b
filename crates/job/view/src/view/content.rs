//! The content of pictures and pages.

use super::arm;
use super::height::TurnsView;
use super::motion::{Clock, MotionView, PathView};
use super::numbers::Chain;
use super::phase::{MotionReplayView, PhaseView};
use super::steps::Row;
use super::strip::StripView;
use super::tool_angle;
use super::trace::TraceView;
use super::world::{ObstacleView, WorldView};
use crate::Object;
use crate::blocking::BlockingView;
use crate::checked::CheckedView;
use crate::flow::FieldLines;
use crate::followed::LineView;
use crate::section::Section;
use cplan_handling::WristJoint;
use cplan_model::space::Configuration;
use cplan_model::{Arm, Status};
use cplan_motion::Trajectory;
use serde::{Serialize, Serializer};

/// Serialises the outcome, which determines colours and symbols of pages. A view without a query (a comparison, or a single
/// configuration) has the outcome `shown`.
fn ending<S: Serializer>(status: &Option<Status>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(status.map_or("shown", Status::name))
}

/// Key figures of a result, which pages show first.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct KeyFigures {
    /// Duration of the motion, in seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// Proven upper bound on how much longer the motion is than the optimum, as a fraction. `None` if nothing is proven.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<f64>,
    /// True if the optimum is the fastest motion; false if it is the shortest path.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub fastest: bool,
    /// Proven lower bound on the distance between arm and obstacles, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// Only if the motion keeps too little clearance for any machine, because none was required: a usual clearance, in metres,
    /// and the length of the path that keeps it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub with_clearance: Option<[f64; 2]>,
}

impl KeyFigures {
    /// Returns true if there is nothing to show.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// The content of a picture or a page. Lengths are in metres, angles in radians, times in seconds. Numbers are rounded to the
/// visible resolution.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct View {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// The outcome, in a word or two.
    pub status: String,
    /// The outcome, which determines colours and symbols. `Found` for a checked configuration that is free. `None` for a view
    /// without a query.
    #[serde(serialize_with = "ending")]
    pub ending: Option<Status>,
    /// Facts about the result: names and values, such as `length` and `4.4963 rad`.
    pub facts: Vec<[String; 2]>,
    /// Key figures of a result; empty without one.
    #[serde(skip_serializing_if = "KeyFigures::is_empty")]
    pub figures: KeyFigures,
    /// The arm without a payload.
    #[serde(serialize_with = "arm::document")]
    pub(crate) arm: Arm,
    /// The visible part of the workspace: least and greatest value of each coordinate.
    pub(crate) frame: [[f64; 2]; 2],
    pub(crate) start: [f64; 2],
    pub(crate) goals: Vec<[f64; 2]>,
    /// Goals along segments: both ends of each.
    pub(crate) goal_lines: Vec<Chain>,
    /// The worlds; the first is the initial one.
    pub(crate) worlds: Vec<WorldView>,
    pub(crate) paths: Vec<PathView>,
    pub(super) motions: Vec<MotionView>,
    pub(super) clock: Option<Clock>,
    pub(crate) frames: Vec<FrameView>,
    /// The strip of progress against time. `None` unless obstacles move.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) strip: Option<StripView>,
    /// The strip of the tool's height against time. `None` unless the tool is lowered.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) height: Option<Object>,
    /// The strip of the wrist's turns against time. `None` unless the wrist turns.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) turns: Option<TurnsView>,
    /// The strip of the tool's angle along lines. `None` unless a wrist turns the tool there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) tool: Option<Object>,
    /// The phases of the planner's search, in order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) replay: Vec<PhaseView>,
    /// The phases of the search for each motion of a task.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) replays: Vec<MotionReplayView>,
    #[serde(skip)]
    pub(crate) still: StillContent,
}

/// A coordinate frame, see [`AxesFrame`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct FrameView {
    pub name: String,
    pub at: [f64; 2],
    pub axes: [[f64; 3]; 3],
}

/// Content of pictures. Pages show it over time, or not at all.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct StillContent {
    /// The configuration spaces; empty for the view of an arm alone.
    pub panels: Vec<PanelView>,
    /// The lines of a field to draw.
    pub field_lines: FieldLines,
    /// Objects at the places where the task puts them. Each place occurs once.
    pub placed: Vec<ObstacleView>,
    /// The sections of companions.
    pub sections: Vec<Section>,
    /// The line that the tip should follow.
    pub line: Option<LineView>,
    /// During an animation, the arm's configuration and the index of the current world. `None` in a still picture.
    pub now: Option<([f64; 2], usize)>,
    /// The time of `now`, in seconds since the start of the motion.
    pub time: f64,
    /// The obstacles that block the motion.
    pub stuck: Option<BlockingView>,
    /// The findings about a checked configuration.
    pub checked: Option<CheckedView>,
    /// True for pictures with a dark background.
    pub is_dark: bool,
    /// True if a page can light up each path.
    pub lights_paths: bool,
    /// Indices of paths that are drawn above the others, the topmost first.
    pub top_paths: Vec<usize>,
    /// The arm's final configuration, and the index of the world at the end.
    pub end: Option<([f64; 2], usize)>,
    /// The steps of a task, below the names of the columns; empty for single motions.
    pub steps: Vec<Row>,
}

/// A configuration space, with its motions.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PanelView {
    /// The text above the panel.
    pub title: String,
    /// A second line above the panel; empty without one.
    pub subtitle: String,
    /// Indices of the worlds of this space. They differ only in the obstacles that link 2 may reach into.
    pub worlds: Vec<usize>,
    /// Indices of the paths to draw. If a path is repeated, only one is listed.
    pub paths: Vec<usize>,
    /// Configurations at which motions of the arm begin and no other motion ends.
    pub starts: Vec<[f64; 2]>,
    /// The number of the failed step, if it is in this space.
    pub fails: Option<usize>,
}

impl View {
    /// Returns true for the view of a task, whose steps have numbers.
    pub(crate) fn is_task(&self) -> bool {
        !self.still.steps.is_empty()
    }

    /// Returns true for the view of a motion or a query, false for that of a single configuration.
    pub(crate) fn moves(&self) -> bool {
        let has_goal = !self.goals.is_empty() || !self.goal_lines.is_empty() || self.unreached().next().is_some();
        has_goal || !self.paths.is_empty() || self.is_task()
    }

    /// Returns the traces of the planner for the motions of a task. Empty if the view does not show them.
    pub(crate) fn traces_of_steps(&self) -> impl Iterator<Item = &TraceView> {
        self.replays.iter().filter_map(|replay| replay.trace.as_ref())
    }

    /// Returns the view with these field lines, for pictures. On pages, the user shows and hides them.
    #[must_use]
    pub fn with_field_lines(mut self, lines: FieldLines) -> Self {
        self.still.field_lines = lines;
        self
    }

    /// Adds a number to the labels of a wavefront, whose first label is 0 otherwise.
    #[must_use]
    pub fn with_labels_from(mut self, first: u32) -> Self {
        for trace in self.worlds.iter_mut().filter_map(|world| world.trace.as_mut()) {
            trace.shift_labels(first);
        }
        self
    }

    /// Returns the view with the key figures of a result.
    #[must_use]
    pub fn with_figures(mut self, figures: KeyFigures) -> Self {
        self.figures = figures;
        self
    }

    /// Adds a section of a companion crate.
    #[must_use]
    pub fn with_section(mut self, section: Section) -> Self {
        self.still.sections.push(section);
        self
    }

    /// Returns the visible part of the workspace: least and greatest value along x and along y.
    pub fn frame(&self) -> [[f64; 2]; 2] {
        self.frame
    }

    /// Returns the view with the line that the tip should follow.
    #[must_use]
    pub fn with_line(mut self, mut line: LineView) -> Self {
        line.focus_within(self.frame, &self.arm);
        self.clock = line.clock.take().or(self.clock);
        self.still.line = Some(line);
        self
    }

    /// Adds the angle of the tool, which this joint turns during a motion.
    #[must_use]
    pub fn with_tool(mut self, arm: &Arm, joint: &WristJoint, trajectory: &Trajectory) -> Self {
        self.tool = tool_angle::of_line(arm, joint, trajectory);
        self
    }

    /// Returns the duration of the motion in seconds. `None` if nothing moves.
    pub(crate) fn duration(&self) -> Option<f64> {
        self.clock.as_ref().map(Clock::duration)
    }

    /// Returns the view at this time of the motion.
    pub(crate) fn moving(&self, time: f64) -> Self {
        let mut view = self.clone();
        let world =
            self.motions.iter().take_while(|motion| motion.from <= time).last().map_or(0, |motion| motion.world);
        view.still.time = time;
        view.still.now = self.clock.as_ref().map(|clock| (clock.at(time).into(), world));
        let payload = view.worlds.get_mut(world).and_then(|world| world.payload.as_mut());
        if let (Some(payload), Some(turned)) = (payload, self.turns.as_ref().and_then(|turns| turns.angle_at(time))) {
            payload.turn_to(turned);
        }
        view
    }

    /// Returns the current world of an animation, or the initial world of a still picture.
    pub(crate) fn world_now(&self) -> &WorldView {
        &self.worlds[self.still.now.map_or(0, |(_, world)| world)]
    }

    /// Adds the obstacles that block a motion, and the place where the arm gets stuck.
    #[must_use]
    pub fn with_blocking(mut self, stuck: BlockingView) -> Self {
        self.still.stuck = Some(stuck);
        self
    }

    /// Returns the view for pictures on a dark or light background. Pages follow the setting of the reader's system.
    #[must_use]
    pub fn on_background(mut self, is_dark: bool) -> Self {
        self.still.is_dark = is_dark;
        self
    }

    /// Returns the view with the findings about its configuration.
    #[must_use]
    pub fn with_findings(mut self, checked: CheckedView) -> Self {
        self.ending = Some(if checked.is_blocked() { Status::Infeasible } else { Status::Found });
        self.still.checked = Some(checked);
        self
    }

    /// Returns the initial world.
    pub(crate) fn first_world(&self) -> &WorldView {
        &self.worlds[0]
    }

    /// Returns the goals that no motion reaches, each with its world's index.
    pub(crate) fn unreached(&self) -> impl Iterator<Item = (usize, Configuration)> {
        let worlds = self.worlds.iter().enumerate();
        worlds.flat_map(|(index, world)| world.unreached.iter().map(move |&q| (index, q.into())))
    }

    /// Returns the ends of the motions in a panel, found or intended. Each item has the configuration, the number of the step (0
    /// for a goal of the query), and true if the marker is filled. The marker of a goal that no motion reaches is hollow. Without
    /// paths, the goals of the query are filled.
    pub(crate) fn ends(&self, panel: &PanelView) -> Vec<(Configuration, usize, bool)> {
        let paths = panel.paths.iter().map(|&index| &self.paths[index]).filter(|path| !path.grows);
        let is_alone = paths.clone().next().is_none();
        let goals = self.goals.iter().map(|&q| (q.into(), 0, is_alone));
        let unreached = &self.worlds[panel.worlds[0]].unreached;
        let unreached = unreached.iter().map(|&q| (q.into(), panel.fails.unwrap_or(0), false));
        goals.chain(unreached).chain(paths.map(|path| (path.goal(), path.step, true))).collect()
    }
}
