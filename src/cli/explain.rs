//! `cplan explain`: reasons why there is no motion, and changes that open a path. If there is a motion: the obstacles
//! that make it longer.

use super::exit::code_of;
use super::failure::Failure;
use super::files::Files;
use super::headings::{OUTPUT, QUERY};
use super::outputs::{Outputs, drawn, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::query_args::QueryArgs;
use super::sinks;
use super::theme::ThemeArgs;
use super::values::time_limit;
use crate::engine::explain::{self, Explanation, MotionQuestion, StepFailure, TIME_LIMIT, explain, explain_step};
use crate::engine::task::raising_at_start;
use crate::engine::{Options, Plan, Problem, plan};
use crate::input::{self, DiagnosticKind, InputError, LoadedScene, Overrides, Rules};
use crate::model::{Action, Status};
use crate::output::PlanOutput as _;
use crate::text::for_a_shell;
use crate::view::View;
use clap::{Args, ValueHint};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Duration;

/// Explain why no path exists and which change opens one.
///
/// If a path exists, the explanation names the obstacles that make it longer.
#[derive(Debug, Args)]
#[command(after_help = "\
If no path exists, the explanation names a set of blockers: obstacles, joint
limits, the clearance. Together they exclude every path (proven); without any
one of them a path exists (certified). For each blocker, the explanation gives
the smallest change that opens a path. It lies between two values: with one,
there is no path (proven), with the other, there is a path (certified).

A blocked start or goal, which `cplan plan` refuses, is explained in the same
way. In a world with steps, the explanation is about the step that fails.

The explanation ends after 5 s, or --time SECONDS, counted from the moment when
it is decided whether a path exists. It may then lack changes, and states if the
set of blockers may be reducible. The same input gives the same output unless
the time ran out.

Examples:
  cplan explain robots/planar_2r.urdf workspaces/no_path.toml
  cplan explain robots/planar_2r.urdf workspaces/limits_closed.toml \\
    --picture why.svg
  cplan explain robots/planar_2r.urdf workspaces/shelf.toml --json
  cplan explain robots/planar_2r.urdf workspaces/shelf.toml --goal-tip 5,0
  cplan explain robots/planar_2r.urdf workspaces/no_path.toml --time 60

Exit codes: 0 a path was found, 1 bad input or I/O, 2 wrong command line, 3
infeasible: proven that there is no path, 4 unknown.")]
pub struct ExplainArgs {
    #[command(flatten)]
    pub files: Files,
    #[command(flatten)]
    pub query: QueryArgs,
    /// Draw workspace and configuration space with the blockers and the place where reachable space ends: .svg, .png,
    /// .gif or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    /// Time limit for the explanation, seconds, counted from the moment when it is decided whether a path exists.
    #[arg(long, value_name = "SECONDS", default_value_t = TIME_LIMIT.as_secs_f64(), value_parser = time_limit, allow_hyphen_values = true)]
    #[arg(help_heading = QUERY)]
    pub time: f64,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// Explains a query, and prints the explanation.
///
/// # Errors
/// Bad input and I/O. A missing motion is no error, because the command explains it.
pub fn run(args: &ExplainArgs) -> Result<u8, Failure> {
    let outputs = Outputs::of_pictures(&args.picture, [])?;
    let loaded = input::load_scene(args.files.robot(), &args.files.world)?;
    refuse_to_overwrite_inputs(outputs.paths(), &loaded.files())?;
    loaded.robot.warnings.iter().for_each(|warning| args.print.print_status(&format!("warning: {warning}")));
    let explained = ExplanationResult::of(loaded, &args.query.overrides(), Duration::from_secs_f64(args.time))?;
    outputs.write_pictures(vec![], drawn(|| args.theme.apply(explained.view())))?;
    let code = code_of(explained.status());
    args.print.report(code, || sinks::pretty(&explained.to_json()), || explained.summary())?;
    Ok(code)
}

/// Returns the command that explains a query. `None` if the query cannot be explained.
pub fn hint(files: &Files, query: &QueryArgs) -> Option<String> {
    let loaded = input::load_scene(files.robot(), &files.world).ok()?;
    let overrides = query.overrides();
    let has_ends = match loaded.is_task() {
        true => Problem::of_scene(loaded.clone(), &overrides).map_or_else(|error| is_about_start(&error), |_| true),
        false => loaded.clone().resolve(&overrides, Rules::Unchecked).is_ok(),
    };
    let words = ["cplan".to_owned(), "explain".to_owned()].into_iter().chain(files.words()).chain(query.words());
    let command = words.map(|word| for_a_shell(&word)).collect::<Vec<_>>().join(" ");
    (has_ends && loaded.trajectories.is_empty()).then_some(command)
}

/// The explanation of a world's motion or task.
#[derive(Debug)]
pub enum ExplanationResult {
    /// The explanation of the motion, or of the motion of a failed step, and notes about the input.
    Motion(Box<Explanation>, Vec<String>),
    /// All steps can be done, so there is nothing to explain.
    Done(Box<Plan>),
}

impl ExplanationResult {
    /// Explains the world's motion or task. `overrides` replace the world's start, goal and clearance. `limit` is the
    /// time limit, see [`MotionQuestion::with_time_limit`].
    ///
    /// # Errors
    /// Overrides that do not suit the world, and an invalid task.
    pub fn of(loaded: LoadedScene, overrides: &Overrides, limit: Duration) -> Result<Self, Failure> {
        loaded.require_static_obstacles("explanations need static obstacles")?;
        let options = Options::default();
        let (question, notes) = if loaded.is_task() {
            match Problem::of_scene(loaded.clone(), overrides) {
                Ok(problem) => {
                    let plan = plan(&problem, &options)?;
                    let explained = failed_step(&plan, limit, &options);
                    return Ok(match explained {
                        Some((explanation, note)) => Self::Motion(Box::new(explanation), vec![note]),
                        None => Self::Done(Box::new(plan)),
                    });
                }
                Err(error) if is_about_start(&error) => blocked_start(loaded, overrides)?,
                Err(error) => return Err(error.into()),
            }
        } else {
            question_of(loaded, overrides, Rules::Unchecked)?
        };
        Ok(Self::Motion(Box::new(explain(&question.with_time_limit(limit), &options)), notes))
    }

    /// Returns the status of the motion or task.
    pub fn status(&self) -> Status {
        match self {
            Self::Motion(explanation, _) => explanation.status(),
            Self::Done(plan) => plan.status(),
        }
    }

    /// Returns the explanation as a JSON object.
    pub fn to_json(&self) -> Value {
        match self {
            Self::Motion(explanation, _) => explanation.to_json(),
            Self::Done(plan) => json!({ "status": plan.status() }),
        }
    }

    /// Returns the explanation as text.
    pub fn summary(&self) -> String {
        match self {
            Self::Motion(explanation, notes) => explain::summary(explanation, notes),
            Self::Done(_) => "found: a motion exists for every step, so there is nothing to explain\n".into(),
        }
    }

    /// Returns the content of pictures and pages.
    pub fn view(&self) -> View {
        match self {
            Self::Motion(explanation, _) => explain::view(explanation),
            Self::Done(plan) => plan.view(),
        }
    }
}

/// Returns true if a world is refused only because its start is blocked.
fn is_about_start(error: &InputError) -> bool {
    error.diagnostics().iter().all(|found| found.kind == DiagnosticKind::Start)
}

/// Returns the question about the motion under these rules for reading the world, and notes about the input.
fn question_of(
    loaded: LoadedScene,
    overrides: &Overrides,
    rules: Rules,
) -> Result<(MotionQuestion, Vec<String>), InputError> {
    let query = loaded.resolve(overrides, rules)?;
    let start = query.problem.start();
    Ok((MotionQuestion::of_goals(query.problem.into_scene(), start, &query.stated_goals), query.notes))
}

/// Returns the question about the blocked start of a task, with the tool at its height at the start, and notes about the input.
fn blocked_start(loaded: LoadedScene, overrides: &Overrides) -> Result<(MotionQuestion, Vec<String>), InputError> {
    // Another defect of the world may hide the values of the tool's joints.
    let task = loaded.clone().resolve(overrides, Rules::Recording).ok().and_then(|loaded| loaded.task);
    let raising = task.as_ref().and_then(raising_at_start);
    let (question, mut notes) = question_of(loaded, overrides, Rules::Start)?;
    notes.push("the start is blocked, so no step can begin; this explanation is only about the start".into());
    let standstills = [raising.into_iter().collect(), Vec::new()];
    Ok((question.with_standstills(standstills), notes))
}

/// Explains the failed step of a task, and describes the step in a note. `None` if no step fails.
pub fn failed_step(plan: &Plan, limit: Duration, options: &Options) -> Option<(Explanation, String)> {
    let (task, answer) = plan.task()?;
    let failed = answer.failed()?;
    let (status, verdict, reasons) = (plan.status(), plan.reason().unwrap_or_default(), failed.reasons.clone());
    let explanation = explain_step(failed, StepFailure { status, verdict, reasons }, limit, options);
    let step = &failed.step;
    let (number, what, place) = (step.number, step.action.describe(&task.objects), &step.place);
    let note = match &step.action {
        Action::Follow(_) => format!(
            "step {number} fails: {what} ({place}); `cplan follow` names the place where the line cannot be followed"
        ),
        _ => format!("step {number} fails: {what} ({place}); this explanation is about the motion of this step"),
    };
    Some((explanation, note))
}
