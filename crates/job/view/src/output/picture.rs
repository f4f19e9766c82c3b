//! Pictures and pages of a plan.

use super::motion_summary::second_attempt;
use super::summary::facts;
use crate::{DrawError, Figure, KeyFigures, Moments, Picture, Section, TaskPicture, View};
use cplan_engine::{Detail, Motion, Plan};
use cplan_handling::{Task, TimedScene};
use cplan_legs::TaskAnswer;
use cplan_model::{MotionProblem, Outcome, Scene, Status};
use cplan_motion::{PlaceTime, WaitReason};
use cplan_planners::cspace::{CObstacle, c_obstacles, exact_c_obstacles};
use cplan_solver::{Answer, Bound, Options, solve};
use cplan_text::{counted, joined, length_down, percent};
use std::path::Path;
use thiserror::Error;

/// A format of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// Vector graphics, as SVG.
    Svg,
    /// Pixels, as PNG.
    #[cfg(feature = "png")]
    Png,
    /// Animated pixels, as GIF.
    #[cfg(feature = "png")]
    Gif,
    /// An HTML page with both spaces, in which the arm can be moved.
    Html,
}

/// The reason why a file's name does not determine a picture format.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PictureFormatError {
    /// The extension is unknown.
    #[error("{file}: a picture's name must end in .svg, .png, .gif or .html")]
    Unknown {
        /// The name as given.
        file: String,
    },
    /// The format is pixels, and this build of the program cannot write them.
    #[error("{file}: this program was built without pixels (feature png); use .svg or .html")]
    WithoutPng {
        /// The name as given.
        file: String,
    },
}

/// Pixels of a PNG picture per unit of the SVG.
#[cfg(feature = "png")]
const PNG_SCALE: f64 = 2.0;

/// Width of a GIF picture, pixels.
#[cfg(feature = "png")]
const GIF_WIDTH: f64 = 960.0;

/// Largest deviation of C-obstacles' contours in pictures, as a fraction of the arm's reach. It is less than a pixel.
pub(super) const PICTURE_TOLERANCE: f64 = 1e-3;

impl PictureFormat {
    /// Returns the format for the extension of a picture's file, in upper or lower case.
    ///
    /// # Errors
    /// Any other extension than `.svg`, `.png`, `.gif` and `.html`, and `.png` and `.gif` without the feature `png`.
    pub fn from_path(path: &Path) -> Result<Self, PictureFormatError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        let file = || path.display().to_string();
        match extension.as_deref() {
            Some("svg") => Ok(Self::Svg),
            #[cfg(feature = "png")]
            Some("png") => Ok(Self::Png),
            #[cfg(feature = "png")]
            Some("gif") => Ok(Self::Gif),
            #[cfg(not(feature = "png"))]
            Some("png" | "gif") => Err(PictureFormatError::WithoutPng { file: file() }),
            Some("html") => Ok(Self::Html),
            _ => Err(PictureFormatError::Unknown { file: file() }),
        }
    }

    /// Returns true if the format can show how the planner found its answer. Its view should have a replay
    /// (`PlanOutput::view_with_replay`).
    pub fn is_animated(self) -> bool {
        #[cfg(feature = "png")]
        let is_still = matches!(self, Self::Svg | Self::Png);
        #[cfg(not(feature = "png"))]
        let is_still = self == Self::Svg;
        !is_still
    }

    /// Returns the file's content.
    ///
    /// # Errors
    /// A picture that cannot be rendered.
    pub fn bytes(self, view: &View) -> Result<Vec<u8>, DrawError> {
        self.bytes_with(view, &mut |_, _| ())
    }

    /// Returns the file's content. `progress` receives the number of finished pictures of an animation, and the number
    /// of all.
    ///
    /// # Errors
    /// Same as for [`PictureFormat::bytes`].
    #[cfg_attr(not(feature = "png"), expect(unused_variables, reason = "nothing moves without pixels"))]
    pub fn bytes_with(self, view: &View, progress: &mut dyn FnMut(usize, usize)) -> Result<Vec<u8>, DrawError> {
        match self {
            #[cfg(feature = "png")]
            Self::Gif => crate::gif(view, GIF_WIDTH, progress),
            _ => self.bytes_of(|| crate::figure(view), || crate::page(view)),
        }
    }

    /// Returns the content of a file: `page` as HTML, or `figure` in any other format. A GIF has a single picture.
    ///
    /// # Errors
    /// A picture that cannot be rendered.
    pub fn bytes_of(
        self,
        figure: impl FnOnce() -> Figure,
        page: impl FnOnce() -> String,
    ) -> Result<Vec<u8>, DrawError> {
        Ok(match self {
            Self::Svg => figure().svg().into_bytes(),
            #[cfg(feature = "png")]
            Self::Png => figure().png(PNG_SCALE)?,
            #[cfg(feature = "png")]
            Self::Gif => figure().gif(GIF_WIDTH)?,
            Self::Html => page().into_bytes(),
        })
    }
}

/// Clearance, in metres, that is too small for a machine to keep its arm free of collisions.
const LEAST_CLEARANCE: f64 = 1e-3;

/// Clearance, in metres, that is planned in addition if the motion keeps less than [`LEAST_CLEARANCE`].
const USUAL_CLEARANCE: f64 = 0.01;

/// Largest number of pairs of shapes for which a path with [`USUAL_CLEARANCE`] is planned. With more, planning takes seconds.
const MAX_PAIRS: usize = 1000;

/// Returns true if a motion keeps less than [`LEAST_CLEARANCE`], because no clearance was required.
pub(super) fn is_tight(plan: &Plan) -> bool {
    let is_less = plan.clearance().is_some_and(|clearance| clearance < LEAST_CLEARANCE);
    plan.status() == Status::Found && is_less && plan.problem().scene().workspace().clearance == 0.0
}

/// Returns [`USUAL_CLEARANCE`] and the length of a path that keeps it, if the plan's motion [`is_tight`]. `None` if no such path
/// is found.
pub(super) fn with_usual_clearance(plan: &Plan) -> Option<[f64; 2]> {
    let (problem, _) = plan.motion().filter(|_| is_tight(plan))?;
    let scene = problem.scene();
    if !scene.loose_obstacles().is_empty() || scene.pairs().len() > MAX_PAIRS {
        return None;
    }
    let scene = scene.clone().with_clearance(USUAL_CLEARANCE).ok()?;
    let problem = MotionProblem::new(scene, problem.start(), problem.goals().clone()).ok()?;
    let answer = solve(&problem, plan.options(), &mut |_| ());
    answer.path().map(|path| [USUAL_CLEARANCE, path.length()])
}

/// Adds a replay of the planner, and the length of a path with a usual clearance.
pub fn replayed(plan: &Plan, mut view: View) -> View {
    view.figures.with_clearance = with_usual_clearance(plan);
    let view = if let Some(replay) = plan.replay() { view.with_replay(&replay) } else { view };
    if let Some(replay) = plan.task_replay() { view.with_task_replay(&replay) } else { view }
}

/// Returns the view. If the plan is a single motion, `contours` computes its C-obstacles.
pub fn view_with(plan: &Plan, contours: impl FnOnce(&Scene) -> Vec<CObstacle>) -> View {
    let view = match plan.detail() {
        Detail::Motion { problem, answer } => motion_view(plan, problem, answer, &contours(problem.scene())),
        Detail::Task { task, answer } => View::of_task(&task_picture(plan, task, answer, plan.place_time().as_ref())),
    };
    let view = view.with_figures(key_figures(plan));
    match plan.trajectory() {
        Some(_) => view.with_section(Section::of_data("budget", plan.margins())),
        None => view,
    }
}

/// Returns the key figures of a plan; none unless a motion was found. Among moving obstacles, the bound on the optimum says too
/// little to be a key figure.
fn key_figures(plan: &Plan) -> KeyFigures {
    if plan.status() != Status::Found {
        return KeyFigures::default();
    }
    let (gap, fastest) = match plan.task() {
        None => (plan.bound().as_ref().map(Bound::gap), false),
        Some((_, answer)) => (answer.gap(), true),
    };
    let is_static = plan.problem().timed().scene.loose_obstacles().is_empty();
    let gap = gap.filter(|gap| is_static && gap.is_finite());
    KeyFigures { duration: plan.duration(), gap, fastest, clearance: plan.clearance(), with_clearance: None }
}

fn motion_view(plan: &Plan, problem: &MotionProblem, answer: &Answer<Motion>, contours: &[CObstacle]) -> View {
    let scene = problem.scene();
    let timed = plan.problem().timed();
    let moments =
        plan.duration().map_or_else(Vec::new, |duration| contours_in_time(timed, [0.0, duration], MAX_MOMENTS));
    let method = answer.method;
    let outline = answer.outcome.found().map(|motion| motion.timed.curve.outline());
    let detail = match &answer.outcome {
        Outcome::Found(motion) => {
            let length = scene.arm().format_length(motion.path.path().length());
            format!("{method}: length {length}, {}", describe_clearance(plan.clearance()))
        }
        Outcome::Infeasible(proof) => format!("{method}: there is no path; {}", proof.describe()),
        Outcome::Unknown(_) => method.to_string(),
    };
    View::of_picture(&Picture {
        title: [title_of(scene), detail].into_iter().chain(second_attempt(plan, answer)).collect(),
        status: status(plan.status()).into(),
        ending: Some(plan.status()),
        facts: facts(plan),
        goals: problem.goals().pieces(),
        paths: outline.iter().map(|path| (method.to_string(), path)).collect(),
        trajectory: plan.trajectory(),
        plane: plan.place_time().as_ref(),
        waits: plan.timing().map_or(&[][..], |timing| &timing.waits),
        trace: Some(&answer.drawn()),
        proof: answer.outcome.infeasible(),
        c_obstacles: contours,
        moments: &moments,
        ..Picture::new(timed, problem.start())
    })
}

/// Returns the content of a task's picture.
fn task_picture<'a>(
    plan: &'a Plan,
    task: &'a Task,
    answer: &'a TaskAnswer,
    plane: Option<&'a PlaceTime>,
) -> TaskPicture<'a> {
    let (steps, planner) = (counted(answer.legs.len(), "step"), plan.options().planner.method());
    let before = || format!("{planner}: {steps} before it");
    let (status, detail) = match plan.status() {
        Status::Found => {
            let kept = describe_clearance(plan.clearance());
            ("found, certified", format!("{planner}: {steps} in {:.3} s, {kept}", answer.duration()))
        }
        Status::Infeasible => ("proven", before()),
        Status::Unknown => ("unknown", before()),
    };
    TaskPicture {
        title: vec![title_of(plan.problem().scene()), detail],
        status: status.into(),
        ending: Some(plan.status()),
        facts: facts(plan),
        task,
        answer,
        plane,
        c_obstacles: contours_of(plan.options()),
        in_time: contours_in_time,
    }
}

/// Returns the result as a sentence: that of a motion that was found, or the reason why it is not known whether a single motion
/// exists. `None` for other results.
pub fn headline(plan: &Plan) -> Option<String> {
    if let Some(Outcome::Unknown(unknown)) = plan.motion().map(|(_, answer)| &answer.outcome) {
        return Some(format!("Not known: {}", unknown.reason));
    }
    let seconds = format!("{:.2} s", plan.duration()?);
    if plan.status() != Status::Found {
        return None;
    }
    let figures = key_figures(plan);
    if let Some((_, answer)) = plan.task() {
        let steps = counted(answer.legs.len(), "step");
        let gap = figures.gap.map(|gap| format!(", proven within {} of the fastest", percent(gap)));
        return Some(format!("All {steps} in {seconds}{}", gap.unwrap_or_default()));
    }
    if let Some(timing) = plan.timing() {
        let reasons = plan.place_time().map(|plane| plane.reasons(&timing.waits)).unwrap_or_default();
        return Some(match &reasons[..] {
            [] => format!("Passes the moving obstacles without waiting, in {seconds}"),
            reasons => format!("Waits {}", joined(&reasons.iter().map(WaitReason::words).collect::<Vec<_>>())),
        });
    }
    let (_, answer) = plan.motion()?;
    let length = plan.arm().format_length(answer.path()?.length());
    Some(match figures.gap {
        Some(gap) => format!("The shortest path: {length}, proven within {}", percent(gap)),
        None => format!("A path from start to goal: {length}, certified"),
    })
}

/// Returns a verdict in a word or two.
pub fn status(status: Status) -> &'static str {
    match status {
        Status::Found => "found, certified",
        Status::Infeasible => "infeasible: proven",
        Status::Unknown => "unknown",
    }
}

/// Describes the proven clearance of a motion.
fn describe_clearance(clearance: Option<f64>) -> String {
    clearance.map_or("no obstacle within reach".into(), |c| format!("proven clearance {}", length_down(c)))
}

/// Returns the title of a scene: the names of the workspace and of the robot.
pub fn title_of(scene: &Scene) -> String {
    match scene.workspace().name.as_str() {
        "" => scene.arm().name.clone(),
        name => format!("{name}: {}", scene.arm().name),
    }
}

/// Largest number of times during a motion for which C-obstacles of moving obstacles are computed. Each time costs as much as a
/// picture of a static world.
const MAX_MOMENTS: usize = 60;

/// Returns the C-obstacles of moving obstacles from `from` to `to`, 20 times per second, or at `most + 1` evenly spaced times if
/// that is fewer.
fn contours_in_time(TimedScene { scene, trajectories }: TimedScene, [from, to]: [f64; 2], most: usize) -> Moments {
    if trajectories.is_empty() {
        return Vec::new();
    }
    let alone = scene.reshaped(|_| (), |_| Vec::new());
    let alone = TimedScene { scene: &alone, trajectories };
    let standing = scene.workspace().obstacles.len();
    let count = ((to - from) * 20.0).ceil().clamp(1.0, most.max(1) as f64);
    let moment = |k: f64| {
        let time = from + (to - from) * k / count;
        let mut all = contours(&alone.frozen(time));
        all.retain(|c_obstacle| (standing..standing + trajectories.len()).contains(&c_obstacle.obstacle));
        all.iter_mut().for_each(|c_obstacle| c_obstacle.obstacle -= standing);
        (time, all)
    };
    (0..=count as usize).map(|k| moment(k as f64)).collect()
}

/// Returns the function that computes the C-obstacles in a plan's pictures.
pub(super) fn contours_of(options: &Options) -> fn(&Scene) -> Vec<CObstacle> {
    if options.planner.is_exact() { exact_contours } else { contours }
}

/// Returns the exact C-obstacles for pictures if the arm has them. Otherwise does the same as [`contours`].
fn exact_contours(scene: &Scene) -> Vec<CObstacle> {
    exact_c_obstacles(scene).unwrap_or_else(|| contours(scene))
}

/// Returns C-obstacles for pictures.
pub fn contours(scene: &Scene) -> Vec<CObstacle> {
    let tolerance = PICTURE_TOLERANCE * scene.arm().reach();
    c_obstacles(scene, tolerance, tolerance)
}
