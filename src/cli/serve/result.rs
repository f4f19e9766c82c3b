//! Plans as answers to a page.

use super::contours::Contours;
use super::options::Options;
use super::protocol::{AnswerReply, Figures};
use crate::check::CertifiedCurve;
use crate::cli::output;
use crate::cli::plan;
use crate::cli::planned::{self, Planned};
use crate::cli::{task, task_summary};
use crate::cspace::CObstacle;
use crate::draw::{Ending, Picture, View};
use crate::engine::task::{Manner, TaskReport, TaskVerdict};
use crate::engine::{Answer, Effort, Method, Verdict, solve};
use crate::input::LoadedTask;
use crate::model::{Problem, Scene};
use crate::motion::Report;
use crate::space::{Configuration, Segment};
use serde_json::value::RawValue;

/// A scene with its configuration space, and no path: why not, in a word or two.
pub fn bare(scene: &Scene, ends: (Configuration, &[Segment]), status: &str, contours: &Contours) -> AnswerReply {
    let contours = contours.of(scene);
    let (start, goals) = ends;
    let picture = Picture { status: status.into(), ..picture(scene, start, goals, &contours) };
    AnswerReply { view: drawn(&View::of_picture(&picture, Ending::Shown, Vec::new(), None)), ..AnswerReply::default() }
}

/// What can be shown while something moves: a path, certified, but neither its bound nor its motion.
pub fn quick(problem: &Problem, method: Method, effort: &Effort, contours: &Contours) -> AnswerReply {
    let effort = Effort { bounded: false, gap: None, ..*effort };
    let answer = solve(problem, method, &effort, &mut |_| ());
    let contours = contours.of(problem.scene());
    let mut reply = judged(&answer.verdict);
    reply.figures.size = Some(answer.run.size.to_string());
    let mut picture = Picture {
        trace: Some(&answer.run.trace),
        proof: answer.verdict.proof(),
        status: planned::status(&answer.verdict).into(),
        ..picture(problem.scene(), problem.start(), problem.goals().pieces(), &contours)
    };
    if let Verdict::Found(path) = &answer.verdict {
        reply.figures.length = Some(effort.metric.length(path.path()));
        reply.figures.clearance = Some(path.clearance()).filter(|clearance| clearance.is_finite());
        picture.paths.push((method.to_string(), path.path()));
    }
    let ending = ending(&answer.verdict);
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
        proof: &[],
        c_obstacles,
    }
}

/// What is planned for, in a line; so that a page keeps its lines while something moves.
fn arm_of(scene: &Scene) -> String {
    let [first, second] = scene.arm().joints.each_ref().map(|joint| joint.name.as_str());
    format!("{} arm, joints {first} and {second}", scene.arm().kind())
}

fn ending(verdict: &Verdict) -> Ending {
    match verdict {
        Verdict::Found(_) => Ending::Found,
        Verdict::Infeasible(_) => Ending::Infeasible,
        Verdict::Unknown(_) => Ending::Unknown,
    }
}

/// The verdict in the page's words.
fn judged(verdict: &Verdict) -> AnswerReply {
    let (verdict, certified, reason) = match verdict {
        Verdict::Found(_) => ("found", true, None),
        Verdict::Infeasible(_) => ("infeasible", false, None),
        Verdict::Unknown(reason) => ("unknown", false, Some(reason.clone())),
    };
    AnswerReply { verdict: Some(verdict), certified, reason, ..AnswerReply::default() }
}

fn drawn(view: &View) -> Option<Box<RawValue>> {
    RawValue::from_string(view.json()).ok()
}

/// All that can be known of a problem.
pub struct Found<'a> {
    problem: &'a Problem,
    answer: Answer,
    outcome: Result<(Report, Option<CertifiedCurve>), String>,
    options: &'a Options,
}

impl<'a> Found<'a> {
    /// Plans, bounds and times.
    pub fn in_full(problem: &'a Problem, options: &'a Options, effort: &Effort) -> Self {
        let answer = solve(problem, options.method(), effort, &mut |_| ());
        let mut outcome = plan::report(problem, &answer, options.motion()).map_err(|failure| failure.to_string());
        if let Ok((report, _)) = &mut outcome {
            plan::tell_how(report, &answer, effort);
        }
        Self { problem, answer, outcome, options }
    }

    /// Report and picture.
    ///
    /// # Errors
    /// A trajectory that cannot be made as asked, in words.
    pub fn planned(&self) -> Result<Planned<'_>, String> {
        let (report, curve) = self.outcome.as_ref().map_err(String::clone)?;
        let Self { problem, answer, options, .. } = self;
        Ok(Planned { problem, answer, curve: curve.as_ref(), report, field: options.field() })
    }

    /// For the page.
    ///
    /// # Errors
    /// As [`Found::planned`].
    pub fn answer(&self, contours: &Contours) -> Result<AnswerReply, String> {
        let planned = self.planned()?;
        let report = planned.report;
        let bound = self.answer.bound;
        let figures = Figures {
            length: bound.map(|bound| bound.upper).or(report.length),
            lower_bound: bound.map(|bound| bound.lower),
            clearance: report.clearance,
            closest: report.closest.clone(),
            duration: report.trajectory.as_ref().map(|trajectory| trajectory.duration()),
            ..Figures::of_size(self.answer.run.size)
        };
        let judged = judged(&self.answer.verdict);
        let reason = judged.reason.clone().or(report.reason.clone());
        Ok(AnswerReply {
            reason,
            figures,
            view: drawn(&planned.view_among(&contours.of(self.problem.scene()))),
            ..judged
        })
    }
}

/// All that can be known of a task.
pub fn of_task(loaded: &LoadedTask, options: &Options, effort: Effort) -> AnswerReply {
    let manner = Manner { method: options.method(), effort, drive: options.drive() };
    let answer = crate::engine::task::plan(&loaded.task, &manner, &mut |_| ());
    let report = TaskReport::new(options.method().name(), &loaded.task, &answer);
    let (verdict, certified, ending) = match answer.verdict {
        TaskVerdict::Done => ("found", true, Ending::Found),
        TaskVerdict::Infeasible(_) => ("infeasible", false, Ending::Infeasible),
        TaskVerdict::Unknown(_) => ("unknown", false, Ending::Unknown),
    };
    let facts = task_summary::facts(&loaded.task, &answer, &report);
    let view = View::of_task(&task::picture(loaded, &answer, &report), ending, facts);
    let figures = Figures {
        clearance: report.clearance(),
        duration: report.seconds().0,
        ..Figures::of_size(format!("{} motions planned", answer.motions))
    };
    AnswerReply {
        verdict: Some(verdict),
        certified,
        reason: report.reason().map(str::to_owned),
        figures,
        view: drawn(&view),
        ..AnswerReply::default()
    }
}
