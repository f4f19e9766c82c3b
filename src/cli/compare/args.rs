//! Arguments of `compare`.

use crate::cli::files::XacroArgs;
use crate::cli::query_args::QueryArgs;
use crate::cli::variant::Variant;
use crate::engine::Method;
use crate::grammar::{EffortArgs, MotionArgs, word};
use clap::{ArgGroup, Args, ValueHint};
use std::path::PathBuf;

/// Greatest number of pairs: their results still fit into memory.
const MOST_QUERIES: i64 = 100_000;

/// Run every planner on the same problem, or on many, side by side.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("format").args(["wide", "json", "csv", "markdown"]))]
#[command(after_help = "\
Examples:
  cplan compare robots/planar_2r.urdf workspaces/shelf.toml --picture paths.svg
  cplan compare robots/planar_2r.urdf workspaces/shelf.toml --queries 200 --output report.html
  cplan compare --suite workspaces --output report.html --output runs.csv --output arena.log
  cplan compare robots/scara.urdf --suite my_worlds --planner visibility --planner wavefront

A suite is a folder with a suite.toml, which names a robot and a world for each problem:
  [[problem]]
  robot = \"../robots/scara.urdf\"   # relative to suite.toml
  world = \"tray.toml\"
Worlds with steps are left out: only the main job plans tasks.

Each run is a whole one, from the problem to a certificate or a proof: maps are built anew for each query, and their time
is told apart (build, query, certify). Length over the proven optimum is measured against a lower bound that no motion is
below. Memory is what a run allocates at the same time, at the most.

Exit codes: of one problem, that of the best answer (0 found, 3 proven that there is no path, 4 unknown); of several,
0 if all ran; 1 bad input, planners that contradict each other, or (after all others ran, and are reported) problems of a suite
that cannot be read or whose start or goal is blocked; 2 wrong command line.")]
pub struct CompareArgs {
    /// The arm. With --suite: the arm for all worlds of the folder.
    #[arg(value_name = "URDF", required_unless_present = "suite")]
    pub urdf: Option<PathBuf>,
    /// The workspace, TOML.
    #[arg(value_name = "WORLD", required_unless_present = "suite", conflicts_with = "suite")]
    pub world: Option<PathBuf>,
    #[command(flatten)]
    pub xacro: XacroArgs,
    /// Many problems: those that DIR/suite.toml lists; or, after an URDF, all worlds of DIR with that robot.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, conflicts_with_all = ["start", "goal", "goal_tip"])]
    pub suite: Option<PathBuf>,
    /// Random start-goal pairs, so many in each world, in place of the world's own: independent, uniform over the free
    /// configurations.
    #[arg(long, value_name = "N", conflicts_with_all = ["start", "goal", "goal_tip"],
          value_parser = clap::value_parser!(u32).range(1..=MOST_QUERIES))]
    pub queries: Option<u32>,
    /// Number that the random pairs follow from: the same number gives the same pairs, in this and all later versions, and
    /// fewer queries are the first of more.
    #[arg(long, value_name = "S", default_value_t = 1, requires = "queries")]
    pub seed: u64,
    /// Runs at the same time. More than one disturb each other's times, and their memory is not told apart.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    #[command(flatten)]
    pub query: QueryArgs,
    #[command(flatten)]
    pub effort: EffortArgs,
    #[command(flatten)]
    pub motion: MotionArgs,
    /// Only these planners; can be repeated. Each row is about the planner's usual path; of those that have two (see --path of
    /// the main job) length and clearance of both are listed.
    #[arg(long, value_parser = word::<Method>(), value_name = "NAME")]
    pub planner: Vec<Method>,
    /// One more row: a planner with options of its own, such as --with "harmonic --field oriented --epsilon 0.5
    /// --direction 0,-1" or --with "trapezoid --path own"; can be repeated.
    #[arg(long, value_name = "PLANNER OPTIONS", value_parser = Variant::parse)]
    pub with: Vec<Variant>,
    /// Print tables with all there is, however wide: also the size of what was searched, the time of each stage, both paths.
    #[arg(long)]
    pub wide: bool,
    /// Print the results as JSON: of several problems all runs, distributions and the summary.
    #[arg(long)]
    pub json: bool,
    /// Print the results as CSV, a line a run.
    #[arg(long)]
    pub csv: bool,
    /// Print the tables as Markdown.
    #[arg(long)]
    pub markdown: bool,
    /// Write the results: .md, .csv or .json as above, .html (one page with charts and paths), .log (for OMPL's Planner
    /// Arena). Can be repeated.
    #[arg(long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Draw all paths in one picture: .svg or .png; of one problem only. Can be repeated.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["suite", "queries"])]
    pub picture: Vec<PathBuf>,
    /// No progress.
    #[arg(long)]
    pub quiet: bool,
}

impl CompareArgs {
    /// Returns true if one problem is compared, not several.
    pub fn is_single(&self) -> bool {
        self.suite.is_none() && self.queries.is_none()
    }
}
