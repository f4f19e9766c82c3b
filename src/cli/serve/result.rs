//! Plans as answers to a page.

use super::contours::Contours;
use super::protocol::{AnswerReply, Figures};
use crate::cspace::CObstacle;
use crate::draw::{Picture, View};
use crate::engine::{Effort, MotionPlan, Options, Problem, TaskPlan, Verdict, plan, solve};
use crate::model::{MotionProblem, Scene, Status};
use crate::output;
use crate::space::{Configuration, Segment};
use serde_json::value::RawValue;

/// A scene with its configuration space, and no path: why not, in a word or two.
pub fn bare(scene: &Scene, ends: (Configuration, &[Segment]), status: &str, contours: &Contours) -> AnswerReply {
    let contours = contours.of(scene);
    let (start, goals) = ends;
    let picture = Picture { status: status.into(), ..picture(scene, start, goals, &contours) };
    AnswerReply { view: drawn(&View::of_picture(&picture, None, Vec::new(), None)), ..AnswerReply::default() }
}

/// What can be shown while something moves: a path, certified, but neither its bound nor its motion.
pub fn quick(problem: &MotionProblem, options: &Options, contours: &Contours) -> AnswerReply {
    let (method, effort) = (options.planner.method(), options.effort(problem.scene()));
    let effort = Effort { bounded: false, gap: None, ..effort };
    let answer = solve(problem, method, &effort, &mut |_| ());
    let contours = contours.of(problem.scene());
    let mut reply = judged(answer.verdict.status());
    if let Verdict::Unknown(reason) = &answer.verdict {
        reply.reason = Some(reason.clone());
    }
    reply.figures.size = Some(answer.run.size.to_string());
    let mut picture = Picture {
        trace: Some(&answer.run.trace),
        proof: answer.verdict.proof(),
        status: output::status(&answer.verdict).into(),
        ..picture(problem.scene(), problem.start(), problem.goals().pieces(), &contours)
    };
    if let Verdict::Found(path) = &answer.verdict {
        reply.figures.length = Some(effort.metric.length(path.path()));
        reply.figures.clearance = Some(path.clearance()).filter(|clearance| clearance.is_finite());
        picture.paths.push((method.to_string(), path.path()));
    }
    let ending = Some(answer.verdict.status());
    AnswerReply { view: drawn(&View::of_picture(&picture, ending, Vec::new(), None)), ..reply }
}

fn picture<'a>(
    scene: &'a Scene,
    start: Configuration,
    goals: &'a [Segment],
    c_obstacles: &'a [CObstacle],
) -> Picture<'a> {
    Picture {
        title: vec![output::title_of(scene), arm_of(scene)],
        status: String::new(),
        scene,
        start,
        goals,
        paths: Vec::new(),
        trace: None,
        proof: None,
        c_obstacles,
    }
}

/// What is planned for, in a line; so that a page keeps its lines while something moves.
fn arm_of(scene: &Scene) -> String {
    let [first, second] = scene.arm().joints.each_ref().map(|joint| joint.name.as_str());
    format!("{} arm, joints {first} and {second}", scene.arm().kind())
}

/// The verdict in the page's words.
fn judged(status: Status) -> AnswerReply {
    AnswerReply { verdict: Some(status.name()), certified: status == Status::Found, ..AnswerReply::default() }
}

fn drawn(view: &View) -> Option<Box<RawValue>> {
    RawValue::from_string(view.json()).ok()
}

/// All that can be known of a problem.
///
/// # Errors
/// A trajectory that cannot be made as asked, in words.
pub fn in_full(problem: &Problem, options: &Options, contours: &Contours) -> Result<AnswerReply, String> {
    let plan = plan(problem, options).map_err(|error| error.to_string())?;
    let (view, figures, reason) = if let Some(MotionPlan { problem, answer, report, .. }) = plan.motion() {
        let figures = Figures {
            length: answer.bound.map(|bound| bound.upper).or(report.length),
            lower_bound: answer.bound.map(|bound| bound.lower),
            clearance: report.clearance,
            closest: report.closest.clone(),
            duration: report.trajectory.as_ref().map(|trajectory| trajectory.duration()),
            ..Figures::of_size(answer.run.size)
        };
        (plan.view_among(&contours.of(problem.scene())), figures, report.reason.clone())
    } else if let Some(TaskPlan { answer, report, .. }) = plan.task() {
        let figures = Figures {
            clearance: report.clearance(),
            duration: report.seconds().0,
            ..Figures::of_size(format!("{} motions planned", answer.motions))
        };
        (plan.view_among(&[]), figures, report.reason().map(str::to_owned))
    } else {
        return Err("there is nothing to show".into());
    };
    Ok(AnswerReply { reason, figures, view: drawn(&view), ..judged(plan.status()) })
}
