//! `cplan plan`, the main command: plans a certified motion from two files, or proves that no motion exists.

use super::exit::code_of;
use super::explain;
use super::failure::Failure;
use super::files::Files;
use super::headings::{OUTPUT, PLANNER};
use super::message_args::MessageArgs;
use super::outputs::{Outputs, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::program_args::{ProgramArgs, ProgramWriter};
use super::progress;
use super::query_args::QueryArgs;
use super::result_files::{PlanContent, ResultFiles};
use super::sinks;
use super::theme::ThemeArgs;
use crate::engine::{Method, Options, Plan, Planner, Problem, plan_with};
use crate::input::{self, DiagnosticKind, Digests, InputError, JointValues, LoadedScene, Overrides};
use crate::model::{MotionProblem, Status};
use crate::motion::{Format, write_whole};
use crate::options::{MotionArgs, PlannerArgs, Word, planners, word};
use crate::output::{CSpaceFormat, Line, PlanOutput as _, format_columns, summary_with};
use crate::space::Configuration;
use crate::view::{FieldLines, View};
use clap::{Args, ValueHint};
use cplan_explain::{MotionQuestion, TIME_LIMIT, explain as find_explanation, with_explanation, with_step_explanation};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Plan a motion: certified path, proof of infeasibility, or unknown.
///
/// In a world with steps, plan the whole task.
#[derive(Debug, Args)]
#[command(after_help = "\
`cplan URDF WORLD` is short for `cplan plan URDF WORLD`.

Examples:
  cplan plan robots/planar_2r.urdf workspaces/shelf.toml \\
    --output plan.json --picture plan.svg
  cplan plan robots/planar_2r.urdf workspaces/shelf.toml --clearance 0.02
  cplan plan robots/scara.urdf workspaces/scara_tray.toml \\
    --planner wavefront --goal-tip 0.25,0.3
  cplan plan robots/planar_2r.urdf workspaces/shelf.toml \\
    --planner wavefront --search astar --neighbors 8
  cplan plan robots/scara.urdf workspaces/tasks/kitting_cell.toml \\
    --output kit.json
  cplan plan robots/scara.urdf workspaces/tasks/kitting_cell.toml \\
    --template epson --output kit.prg
  cplan plan robots/planar_2r.urdf workspaces/singular_closed.toml \\
    --certificate proof.json

Exit codes: 0 found and certified, 1 bad input or I/O, 2 wrong command line, 3
proven infeasible, 4 unknown.")]
pub struct PlanCommand {
    #[command(flatten)]
    pub files: Files,
    #[command(flatten)]
    pub plan: PlanArgs,
}

/// Options for planning, also of `cplan demo`.
#[derive(Debug, PartialEq, Args)]
pub struct PlanArgs {
    #[command(flatten)]
    pub query: QueryArgs,
    #[command(flatten)]
    pub motion: MotionArgs,
    /// Write the result (.json, .csv, .yaml for a ROS 2 JointTrajectory, .mcap for a recording of ROS 2 topics), or the
    /// configuration space with the planner's graph or grid (cspace.json, NAME.cspace.json, .geojson), or matrices of a grid
    /// (cspace.csv, potential.csv, heuristic.csv). Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Write the motion of each step, from rest to rest, into a separate .csv or .yaml file: --output plan.yaml writes
    /// plan-001.yaml, plan-002.yaml and so on. Only for worlds with steps.
    #[arg(long, help_heading = OUTPUT)]
    pub per_step: bool,
    #[command(flatten)]
    pub program: ProgramArgs,
    #[command(flatten)]
    pub message: MessageArgs,
    /// Draw workspace and configuration space side by side: .svg, .png, .gif (an animation of the planner's work, then
    /// of the motion) or .html (a page with the same animations, on which you can move the arm). Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    #[command(flatten, next_help_heading = OUTPUT)]
    pub theme: ThemeArgs,
    /// Lines in pictures of a field (.svg, .png, .gif). Pages can show and hide both kinds.
    #[arg(long, value_parser = word(FIELD_LINES), value_name = "LINES", default_value = "equipotentials")]
    #[arg(help_heading = OUTPUT)]
    pub field_lines: FieldLines,
    /// First label of a wavefront, or of another search of a grid, in pictures and files. Most textbooks begin at 0,
    /// some at 1 or 2.
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = OUTPUT)]
    pub labels_from: u32,
    /// Write the evidence for the answer, found or infeasible. `cplan-check URDF WORLD FILE` checks it in exact
    /// arithmetic. If FILE is also a .json of --output, the evidence becomes the member `certificate` of that file.
    /// Infeasible tasks have no certificate.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub certificate: Option<PathBuf>,
    #[command(flatten)]
    pub print: PrintArgs,
    /// Also print how the robot was interpreted: the plane, the tip, the outline of each link.
    #[arg(long, short, help_heading = OUTPUT)]
    pub verbose: bool,
    /// Add the time of each stage to the JSON. Without this option, the same input gives the same bytes.
    #[arg(long, help_heading = OUTPUT)]
    pub timings: bool,
    /// Planner.
    #[arg(long, value_parser = word(planners()), value_name = "NAME", default_value_t = Method::Shortest)]
    #[arg(help_heading = PLANNER)]
    pub planner: Method,
    #[command(flatten)]
    pub options: PlannerArgs,
}

/// Kinds of field lines.
const FIELD_LINES: [Word<FieldLines>; 3] = [
    (FieldLines::Equipotentials, "equipotentials", "Lines of equal potential"),
    (FieldLines::Flow, "flow", "Lines of steepest ascent, with arrows"),
    (FieldLines::Both, "both", "Both kinds of lines"),
];

/// Plans, writes the requested files, and returns the exit code.
///
/// # Errors
/// Bad input and I/O.
pub fn run(PlanCommand { files, plan }: &PlanCommand) -> Result<u8, Failure> {
    answer(plan, Some(files), || input::load_scene(files.robot(), &files.world))
}

/// Plans in the scene that `load` returns. Calls `load` only if the command line is valid.
///
/// # Errors
/// Bad input and I/O.
pub fn answer(
    args: &PlanArgs,
    given: Option<&Files>,
    load: impl FnOnce() -> Result<LoadedScene, InputError>,
) -> Result<u8, Failure> {
    let own_file = args.certificate.clone().filter(|path| !is_member(path, &args.output));
    let content = |path: &Path| PlanContent::of(path, &args.program);
    let outputs = Outputs::new(&args.output, content, &args.picture, own_file)?;
    let has_program = outputs.results.iter().any(|(_, content)| *content == PlanContent::Program);
    let mut program = args.program.writer(has_program, args.motion.blend)?;
    let options = options(args.planner, &args.options, &args.motion, &args.message)?;
    let mut options = Options { timings: args.timings, ..options };
    if program.is_some() {
        options.drive.blend = 0.0;
    }
    require_grid(args, &outputs, &options.planner)?;
    let begun = Instant::now();
    let loaded = load()?;
    let inputs = loaded.files();
    let certified = given.filter(|_| args.certificate.is_some() || program.is_some());
    let about = certified.map(|files| Digests::of(&files.robot(), &files.world, &inputs)).transpose()?;
    let read: Vec<PathBuf> = inputs.iter().cloned().chain(program.iter().flat_map(ProgramWriter::files)).collect();
    refuse_to_overwrite_inputs(outputs.paths(), &read)?;
    if args.per_step && !loaded.is_task() {
        return Err(Failure::Usage("--per-step needs a world with steps ([[step]])".into()));
    }
    let mut asked = args.query.overrides();
    let stated_ends = loaded.resolved_ends();
    // Print warnings first, because they may explain why start or goal is refused.
    let ignored = args.options.effort.ignored(args.planner);
    loaded.robot.warnings.iter().chain(&ignored).for_each(|w| args.print.print_status(&format!("warning: {w}")));
    let problem = match &mut program {
        None => Problem::of_scene(loaded, &asked).map_err(Failure::Input),
        Some(program) => program.problem(loaded, &mut asked),
    };
    let query = QueryArgs { clearance: asked.clearance, ..args.query };
    let explanation = || given.and_then(|files| explain::hint(files, &query));
    let problem = problem.map_err(|failure| with_hint_to_explain(failure, explanation))?.read_since(begun);
    if let Some(lack) = options.planner.missing_preference(&problem.scene().workspace().preferences) {
        return Err(Failure::Usage(lack));
    }
    let steps = problem.task().map_or(1, |task| task.steps().count());
    let files = ResultFiles::new(&outputs, &inputs, args.per_step, steps)?;
    let plan = plan_with(&problem, &options, &mut |text| args.print.print_status(text))?;
    let begun = Instant::now();
    let program = program.map(|program| program.write(&plan, given.zip(about.as_ref()))).transpose()?;
    // If start or goal was given by a tip position, or was moved to a limit, the certificate states its joint values.
    let asked = with_ends(asked, stated_ends, problem.query());
    let hint = if plan.status() == Status::Infeasible { explanation() } else { None };
    let text = program.as_ref().and_then(|program| program.text.as_deref());
    let written = written(&plan, &outputs, &files, (&asked, about.as_ref()), (hint.as_deref(), text), args)?;
    let after = [("write", begun.elapsed())];
    let code = code_of(plan.status());
    let summary = || {
        let program = program.iter().map(|program| ("program", program.summary.clone()));
        let last: Vec<Line> = program.chain(hint.into_iter().map(|hint| ("hint", hint))).collect();
        summary_with(&plan, &written, &after, args.verbose) + &format_columns(&last)
    };
    args.print.report(code, || Ok(plan.to_json()), summary)?;
    Ok(code)
}

/// Adds a hint to an error about a blocked start or goal, if `cplan explain` can explain it.
fn with_hint_to_explain(failure: Failure, hint: impl FnOnce() -> Option<String>) -> Failure {
    let Failure::Input(error) = failure else { return failure };
    let is_end = |kind| matches!(kind, DiagnosticKind::Start | DiagnosticKind::Goal);
    let hint = if error.diagnostics().iter().all(|found| is_end(found.kind)) { hint() } else { None };
    match hint {
        Some(hint) => Failure::Blocked(error, hint),
        None => Failure::Input(error),
    }
}

/// Returns the overrides, completed by the joint values of start and goal if the files do not state these.
pub fn with_ends(asked: Overrides, stated_ends: [Option<Configuration>; 2], query: &MotionProblem) -> Overrides {
    let goal = stated_ends[1].and(query.goals().pieces().first()).map(|goal| goal.ends()[0]);
    let implied = |end: Option<Configuration>, stated_ends| end.filter(|_| end != stated_ends).map(JointValues::from);
    Overrides {
        start: asked.start.or(implied(Some(query.start()), stated_ends[0])),
        goal: asked.goal.or(implied(goal, stated_ends[1]).filter(|_| asked.goal_tip.is_none())),
        ..asked
    }
}

/// Refuses to write the values of a grid, its potential or its estimates, or to number labels, if the planner has none.
fn require_grid(args: &PlanArgs, outputs: &Outputs<PlanContent>, planner: &Planner) -> Result<(), Failure> {
    if args.labels_from > 0 && planner.method() != Method::Wavefront {
        return Err(Failure::Usage("--labels-from needs --planner wavefront: other planners label no cells".into()));
    }
    for (path, content) in &outputs.results {
        let PlanContent::CSpace(format) = content else { continue };
        let needed = match format {
            CSpaceFormat::Csv if planner.space().is_none() => {
                "holds the values of a grid, so it needs --planner wavefront or harmonic"
            }
            CSpaceFormat::PotentialCsv if !planner.has_potential() => {
                "holds the potential of a field, so it needs --planner harmonic, with any field except khatib"
            }
            CSpaceFormat::HeuristicCsv if !planner.estimates_costs() => {
                "holds the estimates of a search, so it needs --planner wavefront --search astar or greedy"
            }
            _ => continue,
        };
        return Err(Failure::Usage(format!("{} {needed}", path.display())));
    }
    Ok(())
}

/// Returns the view for a page, with the search of the planner. If a motion, or a motion of a task, is proven not to
/// exist, the view also has the cards of an explanation: blocking obstacles, and changes that open a path.
pub(super) fn page_view(plan: &Plan) -> View {
    let view = plan.view_with_replay();
    if plan.task().is_some() {
        return explained_task(plan, view);
    }
    let problem = plan.motion().filter(|_| plan.status() == Status::Infeasible).map(|(problem, _)| problem);
    let Some(problem) = problem.filter(|problem| problem.scene().loose_obstacles().is_empty()) else { return view };
    let question = MotionQuestion::from(problem).with_time_limit(TIME_LIMIT);
    with_explanation(view, &find_explanation(&question, &Options::default()))
}

/// Adds the cards of an explanation to the view of a task whose failed step provably has no motion.
fn explained_task(plan: &Plan, view: View) -> View {
    if plan.status() != Status::Infeasible || !plan.problem().timed().trajectories.is_empty() {
        return view;
    }
    match explain::failed_step(plan, TIME_LIMIT, &Options::default()) {
        Some((explanation, _)) => with_step_explanation(view, &explanation),
        None => view,
    }
}

/// Writes results, configuration spaces, programs, pictures and the certificate. Returns the names of the written
/// files.
///
/// # Errors
/// I/O, or a picture that cannot be rendered.
fn written(
    plan: &Plan,
    outputs: &Outputs<PlanContent>,
    files: &ResultFiles,
    (asked, about): (&Overrides, Option<&Digests>),
    (hint, program): (Option<&str>, Option<&str>),
    args: &PlanArgs,
) -> Result<Vec<String>, Failure> {
    let is_member = |path: &Path| is_member(path, &args.output);
    let certificate = args.certificate.as_deref().and_then(|path| match plan.certificate(asked, about) {
        Ok(certificate) => Some((path, certificate)),
        Err(why) => {
            let place = if is_member(path) { "the certificate in " } else { "" };
            sinks::print_status(&format!("warning: {place}{} is not written: {why}", path.display()));
            None
        }
    });
    let member = certificate.as_ref().and_then(|(path, text)| Some((*path, serde_json::from_str(text).ok()?)));
    let mut written = files.write(plan, member)?;
    // Pages and animations show the planner's search, and pages explain why there is no motion.
    let seen = |is_animated: bool| {
        let mut view = if is_animated { page_view(plan) } else { plan.view() };
        view.facts.extend(hint.iter().map(|hint| ["hint".to_owned(), (*hint).to_owned()]));
        args.theme.apply(view).with_field_lines(args.field_lines).with_labels_from(args.labels_from)
    };
    let labeled = || plan.cspaces().with_labels_from(args.labels_from);
    let mut write = |path: &Path, bytes: &[u8]| {
        written.push(path.display().to_string());
        write_whole(path, bytes)
    };
    if let Some((path, certificate)) = certificate.as_ref().filter(|(path, _)| !is_member(path)) {
        write(path, certificate.as_bytes())?;
    }
    let mut spaces = None;
    for (path, content) in &outputs.results {
        let (text, lacks) = match content {
            PlanContent::Result(_) => continue,
            PlanContent::Program => (program.map(Cow::Borrowed), "motion"),
            PlanContent::CSpace(format) => (format.text(spaces.get_or_insert_with(labeled)).map(Cow::Owned), "grid"),
        };
        match text {
            Some(text) => write(path, text.as_bytes())?,
            None => sinks::warn_unwritten(path, lacks),
        }
    }
    let mut views = [None, None];
    for (path, format) in &outputs.pictures {
        let mut progress = progress::pictures_done(path, &args.print);
        let is_animated = format.is_animated();
        let view = views[usize::from(is_animated)].get_or_insert_with(|| seen(is_animated));
        write(path, &format.bytes_with(view, &mut progress)?)?;
    }
    Ok(written)
}

/// Returns true if the certificate in this file is a member of a JSON result.
fn is_member(path: &Path, results: &[PathBuf]) -> bool {
    let is_json = CSpaceFormat::from_path(path).is_none() && matches!(Format::from_path(path), Ok(Format::Json));
    is_json && results.iter().any(|result| result == path)
}

/// Returns the planning options from the command line.
///
/// # Errors
/// Options that contradict each other or the planner, and a missing GPU.
pub fn options(
    planner: Method,
    options: &PlannerArgs,
    motion: &MotionArgs,
    message: &MessageArgs,
) -> Result<Options, Failure> {
    let planner = options.planner(planner).map_err(Failure::Usage)?;
    options.field.missing().map_or(Ok(()), |missing| Err(Failure::Refused(missing)))?;
    Ok(Options {
        levels: options.effort.levels(&planner),
        planner,
        drive: motion.drive(),
        jerk: motion.jerk,
        joints: message.joints,
        accelerations: message.accelerations,
        ..Options::default()
    })
}
