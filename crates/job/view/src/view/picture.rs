//! The content of a picture of a scene: with one motion, with several motions to compare, or with none.

use super::arm;
use super::content::{FrameView, KeyFigures, PanelView, StillContent, View};
use super::extent;
use super::motion::{Clock, MotionView, PathView};
use super::numbers::{RoundingSteps, number};
use super::strip::StripView;
use super::trace::TraceView;
use super::world::{ObstacleView, WorldView};
use cplan_geometry::Point;
use cplan_handling::TimedScene;
use cplan_judge::CheckedProof;
use cplan_model::Status;
use cplan_model::space::{Configuration, Measure, Metric, Path, Segment};
use cplan_motion::{PlaceTime, Trajectory, Wait};
use cplan_planners::cspace::CObstacle;
use cplan_planners::planner::Trace;
use cplan_theme::PlannerPen;
use nalgebra::Vector3;

/// The content of a picture of a scene. With one path, the picture shows the arm's poses along it. Several paths are compared in
/// different colours and dashes. Without a path, the picture shows the problem.
#[derive(Debug, Clone)]
pub struct Picture<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// Outcome in a word or two.
    pub status: String,
    /// Outcome for colours and symbols; `None` if there was no task.
    pub ending: Option<Status>,
    /// Facts about the result: names and values.
    pub facts: Vec<[String; 2]>,
    /// Arm and obstacles, with the trajectories of moving obstacles.
    pub scene: TimedScene<'a>,
    /// Start configuration.
    pub start: Configuration,
    /// Goals: single configurations and segments. Without a path, the picture shows the arm at the first goal; on a segment, in
    /// the configuration nearest to the start.
    pub goals: &'a [Segment],
    /// Paths with their names, in unwrapped values.
    pub paths: Vec<(String, &'a Path)>,
    /// Colours and dashes of the paths if planners are compared, otherwise empty.
    pub pens: &'a [PlannerPen],
    /// The motion along the only path.
    pub trajectory: Option<&'a Trajectory>,
    /// The times at which moving obstacles block places on that motion. `None` if no obstacle moves.
    pub plane: Option<&'a PlaceTime>,
    /// Waits of that motion for moving obstacles.
    pub waits: &'a [Wait],
    /// The planner's trace.
    pub trace: Option<&'a Trace>,
    /// Proof of infeasibility, if that is the answer.
    pub proof: Option<&'a CheckedProof>,
    /// Contours of the C-obstacles in joint space.
    pub c_obstacles: &'a [CObstacle],
    /// C-obstacles of moving obstacles at several times, ascending, in seconds. Their `obstacle` is the index of the moving
    /// obstacle.
    pub moments: &'a [(f64, Vec<CObstacle>)],
}

/// A coordinate frame that is drawn as three axes.
#[derive(Debug, Clone, PartialEq)]
pub struct AxesFrame {
    /// Text beside the frame.
    pub name: String,
    /// Origin, in plane coordinates.
    pub at: Point,
    /// Directions of the axes x, y and z, each by its components along the plane's coordinates and along its normal.
    pub axes: [Vector3<f64>; 3],
}

impl<'a> Picture<'a> {
    /// Creates a picture with the arm at `start`, and nothing else.
    pub fn new(scene: impl Into<TimedScene<'a>>, start: Configuration) -> Self {
        Self {
            title: Vec::new(),
            status: String::new(),
            ending: None,
            facts: Vec::new(),
            scene: scene.into(),
            start,
            goals: &[],
            paths: Vec::new(),
            pens: &[],
            trajectory: None,
            plane: None,
            waits: &[],
            trace: None,
            proof: None,
            c_obstacles: &[],
            moments: &[],
        }
    }

    /// Returns the strip of progress against time. `None` unless obstacles move.
    fn strip(&self, world: &WorldView) -> Option<StripView> {
        Some(StripView::new(self.plane?, self.trajectory?.duration(), self.waits, std::slice::from_ref(world)))
    }

    /// Returns the goals that are single configurations. Without a path, also returns the place nearest to the start on each
    /// segment.
    fn single_goals(&self) -> Vec<Configuration> {
        let shown = self.goals.iter().filter(|goal| goal.is_point() || self.paths.is_empty());
        shown.map(|goal| goal.nearest(Measure::from(Metric::Euclidean), self.start)).collect()
    }
}

impl View {
    /// Returns the view of a picture.
    pub fn of_picture(picture: &Picture) -> Self {
        let Picture { scene: timed, start, .. } = *picture;
        let scene = timed.scene;
        let grain = RoundingSteps::of(scene.arm());
        let trace = picture.trace.and_then(|trace| TraceView::new(trace, &scene.arm().topology(), grain));
        let world = WorldView::new(timed, String::new(), picture.c_obstacles, grain);
        let world = world.proven(picture.proof, grain).traced(trace).timed(picture.moments, grain);
        let count = picture.paths.len();
        let named = picture.paths.iter().enumerate();
        let path_view = |path: PathView, i: usize| match picture.pens.get(i) {
            Some(&pen) => path.of_planner(pen),
            None => path,
        };
        let paths: Vec<PathView> =
            named.map(|(i, (name, path))| path_view(PathView::of_several(name, path, [i, count], grain), i)).collect();
        let goals = picture.single_goals();
        let ends = picture.paths.iter().map(|(_, path)| path.goal());
        let shown: Vec<Configuration> = [start].into_iter().chain(goals.iter().copied()).chain(ends).collect();
        let goals: Vec<[f64; 2]> = goals.into_iter().map(|q| grain.configuration(q)).collect();
        let segments = picture.goals.iter().filter(|goal| !goal.is_point());
        let end = paths.first().map(|path| path.goal().into()).or(goals.first().copied());
        // Without a motion, pages show moving obstacles at 0 s.
        let shown_at_start = world.movers.iter().filter(|_| picture.trajectory.is_none());
        let moving: Vec<ObstacleView> = shown_at_start.map(|mover| mover.at(0.0)).collect();
        Self {
            title: picture.title.clone(),
            status: picture.status.clone(),
            ending: picture.ending,
            facts: picture.facts.clone(),
            figures: KeyFigures::default(),
            arm: arm::empty_handed(scene, grain),
            frame: extent::sides(scene, &shown, &moving).map(|(lower, upper)| [lower, upper].map(|x| grain.length(x))),
            start: grain.configuration(start),
            goals,
            goal_lines: segments.map(|goal| grain.configurations(&goal.ends())).collect(),
            motions: picture.trajectory.map(|t| MotionView::only(t.duration())).into_iter().collect(),
            clock: picture.trajectory.map(|trajectory| Clock::new(trajectory, grain)),
            frames: Vec::new(),
            strip: picture.strip(&world),
            height: None,
            turns: None,
            tool: None,
            replay: Vec::new(),
            replays: Vec::new(),
            still: StillContent {
                panels: vec![PanelView {
                    title: "Configuration space".to_owned(),
                    subtitle: String::new(),
                    worlds: vec![0],
                    paths: (0..count).collect(),
                    starts: vec![grain.configuration(start)],
                    fails: None,
                }],
                end: end.map(|q| (q, 0)),
                ..StillContent::default()
            },
            worlds: vec![world],
            paths,
        }
    }

    /// Returns the view of an arm in one configuration, with coordinate frames but without its configuration space.
    pub fn of_arm(picture: &Picture, frames: &[AxesFrame]) -> Self {
        let grain = RoundingSteps::of(picture.scene.scene.arm());
        let frame = |frame: &AxesFrame| FrameView {
            name: frame.name.clone(),
            at: grain.point(frame.at).into(),
            axes: frame.axes.map(|axis| [axis.x, axis.y, axis.z].map(number)),
        };
        let frames = frames.iter().map(frame).collect();
        Self { frames, still: StillContent::default(), ..Self::of_picture(picture) }
    }
}
