//! The command line's words.

use super::batch::BatchArgs;
use super::compare::CompareArgs;
use super::completions::CompletionsArgs;
use super::converge::ConvergeArgs;
use super::demo::DemoArgs;
use super::explain::ExplainArgs;
use super::explore::ExploreArgs;
use super::import::ImportArgs;
use super::init::InitArgs;
use super::man::ManArgs;
use super::message_args::MessageArgs;
use super::print_args::PrintArgs;
use super::reach::ReachArgs;
use super::schema::SchemaArgs;
#[cfg(feature = "serve")]
use super::serve::ServeArgs;
#[cfg(feature = "study")]
use super::study::StudyArgs;
use crate::draw::FieldLines;
use crate::engine::Method;
use crate::grammar::{MotionArgs, PlannerArgs, PlannerWords, number_in, word};
use crate::input::{JointValues, Overrides, RobotFile, TipPoint};
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum, ValueHint};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Plans motions of a planar two-joint arm among polygonal obstacles: a path that is certified free of collision,
/// a proof that there is none, or "unknown".
#[derive(Debug, Parser)]
#[command(name = "cplan", version, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(after_help = "\
Examples:
  cplan demo
  cplan init cell
  cplan robots/planar_2r.urdf workspaces/shelf.toml --output plan.json --picture plan.svg
  cplan robots/scara.urdf workspaces/scara_tray.toml --planner wavefront --goal-tip 0.25,0.3
  cplan robots/planar_2r.urdf workspaces/shelf.toml --planner wavefront --search astar --neighbors 8
  cplan robots/planar_2r.urdf workspaces/u_trap.toml --planner harmonic --field oriented --epsilon 0.5 --direction 0,-1
  cplan robots/scara.urdf workspaces/tasks/kitting_cell.toml --output kit.json
  cplan import workspaces/drawings/cell.dxf --output cell.toml
  cplan compare robots/planar_2r.urdf workspaces/shelf.toml
  cplan compare --suite workspaces --output report.html
  cplan serve robots/planar_2r.urdf workspaces/shelf.toml
  cplan study workspaces/studies/base.toml --output base.csv --output base.html
  cplan check robots/planar_2r.urdf workspaces/shelf.toml --at 10deg,45deg
  cplan explain robots/planar_2r.urdf workspaces/no_path.toml
  cplan inspect robots/scara.urdf workspaces/scara_cell.toml --picture scara.svg
  cplan robots/planar_2r.urdf workspaces/singular_closed.toml --output proof.json
  cplan recheck robots/planar_2r.urdf workspaces/singular_closed.toml --proof proof.json
  cplan verify robots/planar_2r.urdf workspaces/shelf.toml recorded.csv
  cplan verify robots/scara.urdf workspaces/tasks/kitting_cell.toml kit.json

Lengths are metres, angles radians (or 30deg), times seconds. `cplan help check` and so on explain the other jobs.

Exit codes: 0 found and certified, 1 bad input or I/O, 2 wrong command line, 3 proven that there is no path, 4 unknown.")]
pub struct Cli {
    /// Other jobs than planning.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Files of the main job; there unless another job is.
    #[command(flatten)]
    pub files: Option<Files>,
    #[command(flatten)]
    pub plan: PlanArgs,
}

impl Cli {
    /// The grammar. What planners can be told is left out of the main job's help, a line an option, which has no room for it.
    pub fn grammar() -> clap::Command {
        let planners: BTreeSet<String> =
            PlannerWords::command().get_opts().map(|option| option.get_id().to_string()).collect();
        let names = Method::ALL.map(|method| method.name()).join(", ");
        let help = format!("Planner: {names}; `cplan help planners` tells of each and of its options");
        Self::command().mut_args(|argument| match argument.get_id().as_str() {
            "planner" => argument.hide_possible_values(true).help(help.clone()),
            "joints" => argument.hide_possible_values(true),
            id if planners.contains(id) => argument.hide(true),
            _ => argument,
        })
    }
}

/// Jobs with a word of their own.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run every planner on the same problem, or on many, side by side.
    Compare(CompareArgs),
    /// Answer problems as JSON lines, a result a line: one process for thousands.
    Batch(BatchArgs),
    /// Tell how relaxations of the harmonic planner's fields converge: errors and sweeps, by relaxation, order, factor and drift.
    Converge(ConvergeArgs),
    /// Tell why there is no motion and what opens a way, or what shapes the one that there is.
    Explain(ExplainArgs),
    /// Plan in a world that is only seen bit by bit: what the sensor has not seen is solid.
    Explore(ExploreArgs),
    /// Tell why a configuration is (not) free: limits, penetrations, crossing sides.
    Check(CheckArgs),
    /// Make a world of a drawing: DXF, SVG or GeoJSON.
    Import(ImportArgs),
    /// Tell what is made of a robot: tree, plane, limits, outlines, and what keeps it from being planned with.
    Inspect(InspectArgs),
    /// Tell where the tip can get, with which IK solutions: certified, or proven out of reach.
    Reach(ReachArgs),
    /// Check a proof that there is no path, or a bound on the shortest, with code that shares nothing with the search that made it.
    Recheck(RecheckArgs),
    /// Check a joint path or trajectory, whoever made it: the whole motion, not samples of it.
    Verify(VerifyArgs),
    /// Open a live page: move obstacles, start and goal in the browser, and the plan follows.
    #[cfg(feature = "serve")]
    Serve(ServeArgs),
    /// Plan in many layouts: numbers of robot and world that differ, a row each, and the best.
    #[cfg(feature = "study")]
    Study(StudyArgs),
    /// Plan a built-in SCARA cell, with no files of yours: writes plan.json and plan.html.
    Demo(DemoArgs),
    /// Write a commented world and a robot to start from.
    Init(InitArgs),
    /// Print what a shell needs to complete commands, options and their values.
    Completions(CompletionsArgs),
    /// Print the manual page, or write those of all commands.
    Man(ManArgs),
    /// Tell what each planner can be told: these options are options of the main job.
    Planners(PlannersArgs),
    /// Print the JSON schema of world files, for editors, or of configuration spaces.
    Schema(SchemaArgs),
}

/// The two files.
#[derive(Debug, Args)]
pub struct Files {
    /// The arm: a URDF, or xacro.
    #[arg(value_name = "URDF", value_hint = ValueHint::FilePath)]
    pub urdf: PathBuf,
    /// The workspace, TOML.
    #[arg(value_name = "WORLD", value_hint = ValueHint::FilePath)]
    pub world: PathBuf,
    // As in `XacroArgs`, which an optional group cannot hold.
    /// Argument of a robot that is xacro, in place of its default. Can be repeated.
    #[arg(long = "xacro-arg", value_name = "NAME=VALUE", value_parser = xacro_argument)]
    pub xacro_args: Vec<(String, String)>,
}

impl Files {
    /// The arm's file with its arguments.
    pub fn robot(&self) -> RobotFile {
        RobotFile { path: self.urdf.clone(), xacro_args: self.xacro_args.clone() }
    }
}

/// Arguments of robots that are xacro.
#[derive(Debug, Default, Args)]
pub struct XacroArgs {
    /// Argument of a robot that is xacro, in place of its default. Can be repeated.
    #[arg(long = "xacro-arg", value_name = "NAME=VALUE", value_parser = xacro_argument)]
    pub xacro_args: Vec<(String, String)>,
}

impl XacroArgs {
    /// A robot's file with the arguments.
    pub fn robot(&self, path: &Path) -> RobotFile {
        RobotFile { path: path.to_owned(), xacro_args: self.xacro_args.clone() }
    }
}

/// `NAME=VALUE`, or `NAME:=VALUE` as ROS has it.
fn xacro_argument(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("an argument of xacro is written NAME=VALUE")?;
    Ok((name.strip_suffix(':').unwrap_or(name).to_owned(), value.to_owned()))
}

/// What can be said instead of the world file.
#[derive(Debug, Args)]
pub struct QueryArgs {
    /// Start configuration instead of the world's, such as 0.3,-1 or 20deg,-60deg.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true)]
    pub start: Option<JointValues>,
    /// Goal configuration instead of the world's.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with = "goal_tip")]
    pub goal: Option<JointValues>,
    /// Goal position of the tip instead of the world's goal, metres: any IK solution that reaches it.
    #[arg(long, value_name = "x,y", allow_hyphen_values = true)]
    pub goal_tip: Option<TipPoint>,
    /// Least distance to keep from every obstacle, metres, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance, allow_hyphen_values = true)]
    pub clearance: Option<f64>,
}

impl QueryArgs {
    /// The same for the input layer.
    #[must_use]
    pub fn overrides(&self) -> Overrides {
        Overrides { start: self.start, goal: self.goal, goal_tip: self.goal_tip, clearance: self.clearance }
    }
}

pub(super) fn clearance(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x >= 0.0, "of metres, finite and not negative")
}

/// The longest time that a job can be given, seconds: some thirty years.
const LONGEST_JOB: f64 = 1e9;

/// Seconds that a job may take.
pub fn time_limit(text: &str) -> Result<f64, String> {
    number_in(text, |x| x > 0.0 && x <= LONGEST_JOB, &format!("of seconds, more than 0 and at most {LONGEST_JOB:e}"))
}

fn time(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x >= 0.0, "of seconds, finite and not negative")
}

/// Options of the main job.
#[derive(Debug, Args)]
pub struct PlanArgs {
    /// Planner.
    #[arg(long, value_parser = word::<Method>(), value_name = "NAME", default_value_t = Method::Shortest)]
    pub planner: Method,
    #[command(flatten)]
    pub query: QueryArgs,
    #[command(flatten)]
    pub motion: MotionArgs,
    /// Write the result: .json, .csv, .yaml (ROS 2 JointTrajectory) or .mcap (recording of ROS 2 topics); or the configuration
    /// space with what the planner saw in it: cspace.json, NAME.cspace.json or .geojson. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Vec<PathBuf>,
    /// Write the motion of each step into a .csv or .yaml file of its own, from rest to rest: plan-001.yaml, plan-002.yaml
    /// and so on for --output plan.yaml (worlds with steps).
    #[arg(long)]
    pub per_step: bool,
    #[command(flatten)]
    pub message: MessageArgs,
    /// Draw workspace and configuration space side by side: .svg, .png, .gif (how the planner came to its answer, then the motion), or .html
    /// (a page that plays the same, and in which the arm can be moved).
    /// Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    /// What pictures of a field show (.svg, .png, .gif; pages show and hide each).
    #[arg(long, value_enum, value_name = "LINES", default_value_t = FieldLinesName::Equipotentials)]
    pub field_lines: FieldLinesName,
    /// Write the evidence for the answer, found or infeasible, which `cplan-check URDF WORLD FILE` checks in exact arithmetic. If FILE is a
    /// .json of --output, too, it becomes the member `certificate` of that. Infeasible tasks have none.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub certificate: Option<PathBuf>,
    #[command(flatten)]
    pub print: PrintArgs,
    /// Tell also how the robot was read: the plane, the tip, the outline of each link.
    #[arg(long, short)]
    pub verbose: bool,
    /// Put the time that each stage took into the JSON; without it the same input gives the same bytes.
    #[arg(long)]
    pub timings: bool,
    // Last, because its headings are for all that follows.
    #[command(flatten)]
    pub options: PlannerArgs,
}

/// Field lines in words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FieldLinesName {
    /// Lines of equal potential.
    Equipotentials,
    /// Lines of steepest ascent, with an arrow each.
    Flow,
    // Needs no help.
    Both,
}

impl From<FieldLinesName> for FieldLines {
    fn from(name: FieldLinesName) -> Self {
        match name {
            FieldLinesName::Equipotentials => Self::Equipotentials,
            FieldLinesName::Flow => Self::Flow,
            FieldLinesName::Both => Self::Both,
        }
    }
}

/// Arguments of `planners`.
#[derive(Debug, Args)]
#[command(after_help = "\
The same words follow a planner's name in `cplan compare --with \"PLANNER OPTIONS\"` and on the live page.

Examples:
  cplan robots/planar_2r.urdf workspaces/shelf.toml --gap 0.01
  cplan robots/planar_2r.urdf workspaces/shelf.toml --planner wavefront --search astar --neighbors 8
  cplan robots/planar_2r.urdf workspaces/shelf.toml --planner prm --seed 7 --search greedy --backward
  cplan robots/planar_2r.urdf workspaces/u_trap.toml --planner harmonic --field oriented --epsilon 0.5 --direction 0,-1

Exit codes: 0 the options are printed, 2 wrong command line.")]
pub struct PlannersArgs {
    /// Planner that searches; which options are for which planner stands with each.
    #[arg(long, value_parser = word::<Method>(), value_name = "NAME", default_value_t = Method::Shortest)]
    pub planner: Method,
    #[command(flatten)]
    pub options: PlannerArgs,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Depths and distances are in metres. If the configuration is not free, the nearest free one is named as well.

Examples:
  cplan check robots/planar_2r.urdf workspaces/shelf.toml --at 10deg,45deg
  cplan check robots/planar_2r.urdf workspaces/shelf.toml --at 0.14,0 --clearance 0.02 --picture why.html
  cplan check robots/scara.urdf workspaces/scara_cell.toml --at=-1,-0.9 --json

Exit codes: 0 whether it is free or not, 1 bad input or I/O, 2 wrong command line.")]
pub struct CheckArgs {
    #[command(flatten)]
    pub files: Files,
    /// The configuration, such as 0.3,-1 or 20deg,-60deg.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true)]
    pub at: JointValues,
    /// The time at which obstacles that move are where they are, seconds since the motion begins.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = time, allow_hyphen_values = true)]
    pub time: f64,
    /// Least distance to keep from every obstacle, metres, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance, allow_hyphen_values = true)]
    pub clearance: Option<f64>,
    /// Draw workspace and configuration space with the configuration: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    /// Print the findings as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `inspect`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan inspect robots/planar_2r.urdf
  cplan inspect robots/scara.urdf workspaces/scara_cell.toml --picture scara.svg
  cplan inspect robots/scara.urdf.xacro --xacro-arg reach=0.6 --expanded scara_expanded.urdf

Exit codes: 0 the robot can be planned with, 1 it cannot (the report is printed all the same), or I/O, 2 wrong command line.")]
pub struct InspectArgs {
    /// The robot: a URDF or xacro, which may be broken or no planar arm at all.
    #[arg(value_name = "URDF", value_hint = ValueHint::FilePath)]
    pub urdf: PathBuf,
    /// The workspace, TOML: its [robot] table decides what the URDF leaves open.
    #[arg(value_name = "WORLD", value_hint = ValueHint::FilePath)]
    pub world: Option<PathBuf>,
    #[command(flatten)]
    pub xacro: XacroArgs,
    /// Write the URDF that a robot in xacro expands to, for `cplan-check` and other programs: .urdf. Beside the xacro file it finds the
    /// same meshes.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub expanded: Option<PathBuf>,
    /// Draw the arm at zero with the frames of its joints: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    /// Print the report as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `recheck`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan robots/planar_2r.urdf workspaces/singular_closed.toml --output proof.json
  cplan recheck robots/planar_2r.urdf workspaces/singular_closed.toml --proof proof.json
  cplan robots/planar_2r.urdf workspaces/shelf.toml --output bound.json
  cplan recheck robots/planar_2r.urdf workspaces/shelf.toml --proof bound.json

Exit codes: 0 the proof or bound holds, 1 it does not, or bad input or I/O, 2 wrong command line.")]
pub struct RecheckArgs {
    #[command(flatten)]
    pub files: Files,
    /// A result of the main job, with the proof that there is no path or a bound on the shortest (`optimum`); or a certificate: .json.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub proof: PathBuf,
    #[command(flatten)]
    pub query: QueryArgs,
}

/// Arguments of `verify`.
#[derive(Debug, Args)]
#[command(after_help = "\
Between samples the motion is what the reader of the format makes of it: of a ROS 2 JointTrajectory a quintic where
accelerations are stated, of positions and velocities a cubic, of positions alone straight lines in joint space; cplan's JSON
says it itself. It has to lead from the world's start to its goal, and what a result of cplan's says of it has to be true. CSV
columns are named after the joints (elbow, elbow_velocity, ...; time in seconds), the values are radians or metres. In a world with steps a result of cplan's for it (.json) is judged step by step: that the steps are the world's,
each motion with what is carried and objects where they lie then, grasps, places, turns of the wrist and rests.

Examples:
  cplan verify robots/planar_2r.urdf workspaces/shelf.toml recorded.csv
  cplan verify robots/planar_2r_continuous.urdf workspaces/wrap_around.toml turns.csv --unwrap --clearance 0.01
  cplan verify robots/scara.urdf workspaces/tasks/kitting_cell.toml kit.json

Exit codes: 0 free and within all limits, 1 bad input, 2 wrong command line, 3 proven collision, limit broken, not from
start to goal, not the task asked for, or something false in the file, 4 undecided.")]
pub struct VerifyArgs {
    #[command(flatten)]
    pub files: Files,
    /// The motion: .json (a result of cplan), .csv, .yaml (ROS 2 JointTrajectory) or .mcap (ROS 2 recording).
    #[arg(value_name = "TRAJECTORY", value_hint = ValueHint::FilePath)]
    pub trajectory: PathBuf,
    /// Topic of an .mcap recording that is judged, if several have both of the arm's joints.
    #[arg(long, value_name = "NAME")]
    pub topic: Option<String>,
    /// Least distance to keep from every obstacle, metres, instead of the world's.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub clearance: Option<f64>,
    /// Where it is to begin instead of the world's start, such as 0.3,-1 or 20deg,-60deg.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with = "anywhere")]
    pub start: Option<JointValues>,
    /// Where it is to end instead of the world's goal.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true, conflicts_with_all = ["goal_tip", "anywhere"])]
    pub goal: Option<JointValues>,
    /// Where the tip is to end instead of the world's goal, metres.
    #[arg(long, value_name = "x,y", allow_hyphen_values = true, conflicts_with = "anywhere")]
    pub goal_tip: Option<TipPoint>,
    /// Let a motion begin and end anywhere, whatever the world's start and goal.
    #[arg(long)]
    pub anywhere: bool,
    /// Let joints without limits go the short way from sample to sample: for angles recorded within one turn.
    #[arg(long)]
    pub unwrap: bool,
    /// Hold the joints' torques to the efforts that the URDF or the world gives, though the world does not say so; what has torques in it is
    /// held to them anyway.
    #[arg(long)]
    pub torque: bool,
    /// Draw workspace and configuration space with the motion: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    /// Write the evidence that an accepted motion is free, and of a task that it does all steps, which `cplan-check URDF WORLD FILE` checks in exact
    /// arithmetic.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub certificate: Option<PathBuf>,
    #[command(flatten)]
    pub print: PrintArgs,
}
