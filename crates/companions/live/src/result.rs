//! Converts plans to answers for a page.

use super::contours::Contours;
use super::protocol::{AnswerReply, Figures};
use cplan_engine::{Detail, Problem, plan};
use cplan_handling::TimedScene;
use cplan_model::space::{Configuration, Metric, Segment};
use cplan_model::{Scene, Status};
use cplan_planners::cspace::CObstacle;
use cplan_solver::Options;
use cplan_tasks::SEARCHES;
use cplan_view::output;
use cplan_view::output::{replayed, view_with};
use cplan_view::{Picture, View};
use serde_json::value::RawValue;

/// Returns the answer for a scene without a path: its configuration space, and a short reason.
pub fn without_path(
    scene: TimedScene,
    ends: (Configuration, &[Segment]),
    status: &str,
    contours: &Contours,
) -> AnswerReply {
    let contours = contours.of(scene.scene);
    let (start, goals) = ends;
    let picture = Picture { status: status.into(), ..picture(scene, start, goals, &contours) };
    AnswerReply { view: drawn(&View::of_picture(&picture)), ..AnswerReply::default() }
}

/// Returns an answer for display during a drag. Its path is certified, but it has neither a bound nor a motion.
///
/// # Errors
/// The reason, if the requested trajectory cannot be made.
pub fn quick_answer(problem: &Problem, options: &Options, contours: &Contours) -> Result<AnswerReply, String> {
    let plan = plan(problem, &Options { bounded: false, ..*options }, SEARCHES, &mut |_| ())
        .map_err(|error| error.to_string())?;
    let Some((problem, answer)) = plan.motion() else {
        return Err("this page cannot plan steps in worlds with moving obstacles; use `cplan plan`".into());
    };
    let timed = plan.problem().timed();
    let contours = contours.of(timed.scene);
    let mut picture = Picture {
        trace: Some(&answer.run.trace),
        proof: answer.outcome.infeasible(),
        status: output::status(plan.status()).into(),
        ending: Some(plan.status()),
        ..picture(timed, problem.start(), problem.goals().pieces(), &contours)
    };
    let mut figures = Figures { clearance: plan.clearance(), ..Figures::of_size(answer.run.size) };
    if let Some(path) = answer.path() {
        let arm = problem.scene().arm();
        let metric = options.planner.metric(arm);
        (figures.length, figures.length_unit) = (Some(metric.length(path)), arm.unit_in(metric));
        picture.paths.push((answer.method.to_string(), path));
    }
    let view = drawn(&View::of_picture(&picture));
    Ok(AnswerReply { reason: plan.reason(), figures, view, ..reply_with_status(plan.status()) })
}

fn picture<'a>(
    scene: TimedScene<'a>,
    start: Configuration,
    goals: &'a [Segment],
    c_obstacles: &'a [CObstacle],
) -> Picture<'a> {
    let title = vec![output::title_of(scene.scene), arm_of(scene.scene)];
    Picture { title, goals, c_obstacles, ..Picture::new(scene, start) }
}

/// Describes the arm in one line. So the page has the same number of lines throughout a drag.
fn arm_of(scene: &Scene) -> String {
    let [first, second] = scene.arm().joints.each_ref().map(|joint| joint.name.as_str());
    format!("{} arm, joints {first} and {second}", scene.arm().kind())
}

/// Creates an answer with this verdict, in the page's word for it.
fn reply_with_status(status: Status) -> AnswerReply {
    AnswerReply { verdict: Some(status.name()), certified: status == Status::Found, ..AnswerReply::default() }
}

fn drawn(view: &View) -> Option<Box<RawValue>> {
    RawValue::from_string(view.json()).ok()
}

/// Returns a complete answer. On request, it includes the replay of the planner's search.
///
/// # Errors
/// The reason, if the requested trajectory cannot be made.
pub fn full_answer(
    problem: &Problem,
    options: &Options,
    contours: &Contours,
    think: bool,
) -> Result<AnswerReply, String> {
    let plan = plan(problem, options, SEARCHES, &mut |_| ()).map_err(|error| error.to_string())?;
    let view = view_with(&plan, |scene| contours.of(scene));
    let view = if think { replayed(&plan, view) } else { view };
    let (bound, arm) = (plan.bound(), problem.scene().arm());
    let (size, length) = match plan.detail() {
        Detail::Motion { answer, .. } => {
            (answer.run.size.to_string(), bound.map(|bound| bound.upper).or_else(|| plan.length()))
        }
        Detail::Task { answer, .. } => (format!("{} motions planned", answer.motions), None),
    };
    let figures = Figures {
        length,
        length_unit: arm.unit_in(bound.map_or(Metric::Euclidean, |bound| bound.metric)),
        // The bound ignores moving obstacles, so it says little in their presence.
        lower_bound: bound.filter(|_| problem.timed().trajectories.is_empty()).map(|bound| bound.lower),
        clearance: plan.clearance(),
        closest: plan.closest(),
        duration: plan.duration(),
        ..Figures::of_size(size)
    };
    Ok(AnswerReply { reason: plan.reason(), figures, view: drawn(&view), ..reply_with_status(plan.status()) })
}
