//! Pictures and pages of a plan.

use super::summary::facts;
use crate::{DrawError, Moments, Picture, TaskPicture, View};
use cplan_core::cspace::{CObstacle, c_obstacles, exact_c_obstacles};
use cplan_core::model::{MotionProblem, Outcome, Scene, Status, Task};
use cplan_engine::task::TaskAnswer;
use cplan_engine::{Answer, Detail, Motion, Options, Plan};
use cplan_text::{at_least, counted};
use std::path::Path;
use thiserror::Error;

/// A format of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// Vector graphics.
    Svg,
    /// Pixels.
    #[cfg(feature = "png")]
    Png,
    /// Pixels in motion.
    #[cfg(feature = "png")]
    Gif,
    /// A page with both spaces, in which the arm can be moved.
    Html,
}

/// Why a file's name does not tell a format of pictures.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PictureFormatError {
    /// The extension is none of ours.
    #[error("{file}: a picture's name must end in .svg, .png, .gif or .html")]
    Unknown {
        /// The name as given.
        file: String,
    },
    /// The format is one that this build of the program does not have.
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

/// Share of the arm's reach by which contours of C-obstacles may deviate in pictures: less than a pixel.
pub(super) const PICTURE_TOLERANCE: f64 = 1e-3;

impl PictureFormat {
    /// The format that a picture's extension stands for; upper and lower case are the same.
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

    /// Whether it has time, so that it can show how the planner came to its answer: then the view is better one with a replay
    /// (`PlanOutput::view_with_replay`).
    #[must_use]
    pub fn plays(self) -> bool {
        match self {
            Self::Svg => false,
            #[cfg(feature = "png")]
            Self::Png => false,
            #[cfg(feature = "png")]
            Self::Gif => true,
            Self::Html => true,
        }
    }

    /// The file's content.
    ///
    /// # Errors
    /// A picture that cannot be plan of pixels.
    pub fn bytes(self, view: &View) -> Result<Vec<u8>, DrawError> {
        self.bytes_with(view, &mut |_, _| ())
    }

    /// The same; `progress` hears how many of how many pictures of a picture in motion are done.
    ///
    /// # Errors
    /// As [`PictureFormat::bytes`].
    #[cfg_attr(not(feature = "png"), expect(unused_variables, reason = "nothing moves without pixels"))]
    pub fn bytes_with(self, view: &View, progress: &mut dyn FnMut(usize, usize)) -> Result<Vec<u8>, DrawError> {
        match self {
            #[cfg(feature = "png")]
            Self::Gif => crate::gif(view, GIF_WIDTH, progress),
            _ => self.bytes_of(|| crate::svg(view), || crate::page(view)),
        }
    }

    /// The same of anything that can be an SVG document and a page; as a GIF it is a single picture.
    ///
    /// # Errors
    /// A picture that cannot be plan of pixels.
    pub fn bytes_of(self, svg: impl FnOnce() -> String, page: impl FnOnce() -> String) -> Result<Vec<u8>, DrawError> {
        Ok(match self {
            Self::Svg => svg().into_bytes(),
            #[cfg(feature = "png")]
            Self::Png => crate::png(&svg(), PNG_SCALE)?,
            #[cfg(feature = "png")]
            Self::Gif => crate::still_gif(&svg(), GIF_WIDTH)?,
            Self::Html => page().into_bytes(),
        })
    }
}

/// What pictures and pages of it show.
#[must_use]
pub fn view(plan: &Plan) -> View {
    view_with(plan, contours_of(plan.options()))
}

/// The same with how the planner came to its answer, for pictures and pages that play.
#[must_use]
pub fn view_with_replay(plan: &Plan) -> View {
    replayed(plan, view(plan))
}

/// A view of it with how the planner came to its answer.
pub fn replayed(plan: &Plan, view: View) -> View {
    let view = if let Some(replay) = plan.replay() { view.with_replay(&replay) } else { view };
    if let Some(replay) = plan.task_replay() { view.with_task_replay(&replay) } else { view }
}

/// The same where somebody knows the contours of the C-obstacles of single motions.
#[must_use]
pub fn view_with(plan: &Plan, contours: impl FnOnce(&Scene) -> Vec<CObstacle>) -> View {
    match plan.detail() {
        Detail::Motion { problem, answer } => motion_view(plan, problem, answer, &contours(problem.scene())),
        Detail::Task { task, answer } => View::of_task(&task_picture(plan, task, answer)),
    }
}

fn motion_view(plan: &Plan, problem: &MotionProblem, answer: &Answer<Motion>, contours: &[CObstacle]) -> View {
    let scene = problem.scene();
    let moments =
        plan.duration().map_or_else(Vec::new, |duration| contours_in_time(scene, [0.0, duration], MOST_MOMENTS));
    let method = answer.method;
    let outline = answer.outcome.found().map(|motion| motion.timed.curve.outline());
    let detail = match &answer.outcome {
        Outcome::Found(motion) => {
            format!("{method}: length {:.4}, {}", motion.path.path().length(), kept(plan.clearance()))
        }
        Outcome::Infeasible(proof) => format!("{method}: there is no path; {}", proof.describe()),
        Outcome::Unknown(_) => method.to_string(),
    };
    View::of_picture(&Picture {
        title: vec![title_of(scene), detail],
        status: status(plan.status()).into(),
        ending: Some(plan.status()),
        facts: facts(plan),
        goals: problem.goals().pieces(),
        paths: outline.iter().map(|path| (method.to_string(), path)).collect(),
        trajectory: plan.trajectory(),
        trace: Some(&answer.drawn()),
        proof: answer.outcome.infeasible(),
        c_obstacles: contours,
        moments: &moments,
        ..Picture::new(scene, problem.start())
    })
}

/// What a picture of a task shows.
fn task_picture<'a>(plan: &'a Plan, task: &'a Task, answer: &'a TaskAnswer) -> TaskPicture<'a> {
    let (steps, planner) = (counted(answer.legs.len(), "step"), plan.options().planner.method());
    let before = || format!("{planner}: {steps} before it");
    let (status, detail) = match plan.status() {
        Status::Found => {
            let kept = kept(plan.clearance());
            ("done, certified", format!("{planner}: {steps} in {:.3} s, {kept}", answer.duration()))
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
        c_obstacles: contours_of(plan.options()),
        in_time: contours_in_time,
    }
}

/// A verdict in a word or two.
#[must_use]
pub fn status(status: Status) -> &'static str {
    match status {
        Status::Found => "found, certified",
        Status::Infeasible => "no path: proven",
        Status::Unknown => "unknown",
    }
}

/// How far from obstacles a motion is known to stay.
fn kept(clearance: Option<f64>) -> String {
    clearance.map_or("nothing to hit".into(), |c| format!("proven clearance {} m", at_least(c, 6)))
}

/// Workspace and robot, as a title.
#[must_use]
pub fn title_of(scene: &Scene) -> String {
    match scene.workspace().name.as_str() {
        "" => scene.arm().name.clone(),
        name => format!("{name}: {}", scene.arm().name),
    }
}

/// Times of a motion at which C-obstacles of what moves are drawn, at the most.
const MOST_MOMENTS: usize = 60;

/// C-obstacles of what moves, some times a second, so many at the most.
fn contours_in_time(scene: &Scene, [from, to]: [f64; 2], most: usize) -> Moments {
    if scene.workspace().movers.is_empty() {
        return Vec::new();
    }
    let alone = scene.reshaped(|_| (), |_| Vec::new());
    let standing = scene.workspace().obstacles.len();
    let count = ((to - from) * 20.0).ceil().clamp(1.0, most.max(1) as f64);
    let moment = |k: f64| {
        let time = from + (to - from) * k / count;
        let mut all = contours(&alone.frozen(time));
        all.retain(|c_obstacle| (standing..standing + scene.workspace().movers.len()).contains(&c_obstacle.obstacle));
        all.iter_mut().for_each(|c_obstacle| c_obstacle.obstacle -= standing);
        (time, all)
    };
    (0..=count as usize).map(|k| moment(k as f64)).collect()
}

/// How the C-obstacles of a plan are traced for its pictures.
fn contours_of(options: &Options) -> fn(&Scene) -> Vec<CObstacle> {
    if options.planner.is_exact() { exact_contours } else { contours }
}

/// Exact C-obstacles for pictures, where the arm has any.
fn exact_contours(scene: &Scene) -> Vec<CObstacle> {
    exact_c_obstacles(scene).map_or_else(|| contours(scene), |(exact, _)| exact)
}

/// C-obstacles for pictures.
#[must_use]
pub fn contours(scene: &Scene) -> Vec<CObstacle> {
    let tolerance = PICTURE_TOLERANCE * scene.arm().reach();
    c_obstacles(scene, tolerance, tolerance)
}
