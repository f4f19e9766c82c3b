//! `cplan explain`: the reasons why there is no motion, and the changes that open a path; for a motion, the obstacles
//! that make it longer.

use super::exit::{DONE, INFEASIBLE, UNKNOWN};
use super::failure::Failure;
use super::files::Files;
use super::print_args::PrintArgs;
use super::query_args::QueryArgs;
use super::sinks::{self, Sink};
use super::values::time_limit;
use crate::draw::View;
use crate::engine::explain::{Explanation, Question, TIME_LIMIT, explain};
use crate::engine::task::FailedStep;
use crate::engine::{Options, Plan, Problem, plan};
use crate::input::{self, DiagnosticKind, LoadedEnds, LoadedScene, Overrides};
use crate::model::Status;
use crate::output::PlanOutput as _;
use crate::output::explained;
use crate::space::{GoalSet, Segment};
use clap::{Args, ValueHint};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Duration;

/// Tell why there is no motion and what opens a way, or what shapes the one that there is.
#[derive(Debug, Args)]
#[command(after_help = "\
Where there is no motion it names what is in the way: obstacles, limits of joints, the clearance. All of them together leave no way, proven;
without any one of them there is one, certified. Of each the smallest change that opens a way is told between a path and a proof. A start or goal
that is not free, which the main job refuses, is explained in the same words; of a world with steps the motion of the step that fails.
Where there is a motion, it tells what makes it longer.

After 5 s, or --time SECONDS, it says what it has: sets may then not be irreducible, which it says, and changes may be missing. The time begins
when it is known whether there is a motion. The same input gives the same output unless the time is up.

Examples:
  cplan explain robots/planar_2r.urdf workspaces/no_path.toml
  cplan explain robots/planar_2r.urdf workspaces/limits_closed.toml --picture why.svg
  cplan explain robots/planar_2r.urdf workspaces/shelf.toml --json
  cplan explain robots/planar_2r.urdf workspaces/shelf.toml --goal-tip 5,0
  cplan explain robots/planar_2r.urdf workspaces/no_path.toml --time 60

Exit codes: 0 there is a motion, 1 bad input or I/O, 2 wrong command line, 3 proven that there is none, 4 unknown.")]
pub struct ExplainArgs {
    #[command(flatten)]
    pub files: Files,
    #[command(flatten)]
    pub query: QueryArgs,
    /// Draw workspace and configuration space, with what is in the way and where the motion gets stuck: .svg, .png, .gif or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    /// Time for the explanation once it is known whether there is a motion; then what is known is said.
    #[arg(long, value_name = "SECONDS", default_value_t = TIME_LIMIT.as_secs_f64(), value_parser = time_limit, allow_hyphen_values = true)]
    pub time: f64,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// Explains.
///
/// # Errors
/// Bad input and I/O. A missing motion is no error, because explaining it is the job.
pub fn run(args: &ExplainArgs) -> Result<u8, Failure> {
    let sinks = sinks::sinks(&[], &args.picture)?;
    let loaded = input::load_scene(args.files.robot(), &args.files.world)?;
    sinks::spare_inputs(sinks.iter().map(Sink::path), &loaded.files())?;
    loaded.robot.warnings.iter().for_each(|warning| args.print.say(&format!("warning: {warning}")));
    let explained = Explained::of(loaded, &args.query.overrides(), Duration::from_secs_f64(args.time))?;
    if !sinks.is_empty() {
        let view = explained.view();
        for sink in &sinks {
            if let Sink::Picture(format, path) = sink {
                sinks::save_picture(*format, path, &view)?;
            }
        }
    }
    let code = exit_code(explained.status());
    args.print.tell(code, || sinks::pretty(&explained.to_json()), || explained.summary())?;
    Ok(code)
}

/// An explanation of a world's motion or task.
#[derive(Debug)]
pub enum Explained {
    /// Explains the motion, or that of the failed step, with notes about its input, line by line.
    Motion(Box<Explanation>, Vec<String>),
    /// All steps can be done, so there is nothing to explain.
    Done(Box<Plan>),
}

impl Explained {
    /// Explains the world's motion or task, or `overrides` instead, within a time limit
    /// ([`Question::with_time_limit`]).
    ///
    /// # Errors
    /// Overrides that do not fit the world; an invalid task.
    pub fn of(loaded: LoadedScene, overrides: &Overrides, limit: Duration) -> Result<Self, Failure> {
        loaded.require_standing("what is in the way is told of what stands")?;
        let (question, notes) = if loaded.has_steps() {
            match Problem::of_scene(loaded.clone(), overrides) {
                Ok(problem) => {
                    let plan = plan(&problem, &Options::default())?;
                    match failed_step(&plan) {
                        Some((question, note)) => (question, vec![note]),
                        None => return Ok(Self::Done(Box::new(plan))),
                    }
                }
                Err(error) if error.diagnostics().iter().all(|found| found.kind == DiagnosticKind::Start) => {
                    let LoadedEnds { scene, start, goals, mut notes, .. } = loaded.start_alone(overrides)?;
                    notes.push("no step can begin: this is about the start alone".into());
                    (Question::of_goals(scene, start, &goals), notes)
                }
                Err(error) => return Err(error.into()),
            }
        } else {
            let query = loaded.query(overrides)?;
            (Question::of_goals(query.scene, query.start, &query.goals), query.notes)
        };
        let question = question.with_time_limit(limit);
        Ok(Self::Motion(Box::new(explain(&question, &Options::default())), notes))
    }

    /// Returns true if there is a motion.
    #[must_use]
    pub fn status(&self) -> Status {
        match self {
            Self::Motion(explanation, _) => explanation.status(),
            Self::Done(plan) => plan.status(),
        }
    }

    /// Returns the explanation as a JSON object.
    #[must_use]
    pub fn to_json(&self) -> Value {
        match self {
            Self::Motion(explanation, _) => explanation.to_json(),
            Self::Done(plan) => json!({ "status": plan.status() }),
        }
    }

    /// Returns the explanation as text.
    #[must_use]
    pub fn summary(&self) -> String {
        match self {
            Self::Motion(explanation, notes) => explained::summary(explanation, notes),
            Self::Done(_) => "all steps can be done: there is nothing to explain\n".into(),
        }
    }

    /// Returns the content of pictures and pages.
    #[must_use]
    pub fn view(&self) -> View {
        match self {
            Self::Motion(explanation, _) => explained::view(explanation),
            Self::Done(plan) => plan.view(),
        }
    }
}

/// Returns the motion of the failed step, with the objects and the payload at that time, and the description of the
/// step.
fn failed_step(plan: &Plan) -> Option<(Question, String)> {
    let (task, answer) = plan.task()?;
    let FailedStep { step, scene, from, ik_solutions, .. } = answer.failed()?;
    let goals: GoalSet = ik_solutions.iter().map(|unreached| Segment::point(unreached.ik_solution)).collect();
    let what = step.action.describe(&task.objects);
    let note = format!("this is the motion of step {}, which fails: {what} ({})", step.number, step.place);
    Some((Question::new((**scene).clone(), *from, goals), note))
}

fn exit_code(status: Status) -> u8 {
    match status {
        Status::Found => DONE,
        Status::Infeasible => INFEASIBLE,
        Status::Unknown => UNKNOWN,
    }
}
