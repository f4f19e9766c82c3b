//! Arguments of `compare`.

use crate::cli::files::XacroArgs;
use crate::cli::headings::{COMPARISON, OUTPUT};
use crate::cli::query_args::QueryArgs;
use crate::cli::theme::ThemeArgs;
use crate::cli::variant::Variant;
use crate::engine::Method;
use crate::options::{EffortArgs, MotionArgs, planners, word};
use clap::{ArgGroup, Args, ValueHint};
use std::path::PathBuf;

/// Greatest number of pairs. The results for this many pairs still fit into memory.
const MAX_QUERIES: i64 = 100_000;

/// Run all planners on one problem or on many, side by side.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("format").args(["wide", "json", "csv", "markdown"]))]
#[command(after_help = "\
Examples:
  cplan compare robots/planar_2r.urdf workspaces/shelf.toml \\
    --picture paths.svg
  cplan compare robots/planar_2r.urdf workspaces/shelf.toml --queries 200 \\
    --output report.html
  cplan compare --suite workspaces --output report.html --output runs.csv \\
    --output arena.log
  cplan compare robots/scara.urdf --suite my_worlds \\
    --planner visibility --planner wavefront
  cplan compare robots/planar_2r.urdf workspaces/shelf.toml --paths results

A suite is a folder with a suite.toml, which names a robot and a world for each
problem:
  [[problem]]
  robot = \"../robots/scara.urdf\"   # relative to suite.toml
  world = \"tray.toml\"
Worlds with steps are left out: only `cplan plan` plans tasks.

Each run begins with the problem and ends with a certificate or a proof. It
builds its own maps; times for build, query and certify are reported separately.
The table compares each length with a proven lower bound on the length of all
motions. Memory is the peak of a run's allocations.

Exit codes: for one problem, 0 a planner found a path, 3 a planner proved that
there is none, 4 unknown. For several problems: 0 all runs were made. For both:
1 bad input, planners that contradict each other, or (after all other runs)
problems of a suite that cannot be read or whose start or goal is blocked; 2
wrong command line.")]
pub struct CompareArgs {
    /// Robot: a URDF or xacro file. With --suite: the robot for all worlds of the folder.
    #[arg(value_name = "URDF", required_unless_present = "suite")]
    pub urdf: Option<PathBuf>,
    /// World file (TOML).
    #[arg(value_name = "WORLD", required_unless_present = "suite", conflicts_with = "suite")]
    pub world: Option<PathBuf>,
    #[command(flatten)]
    pub xacro: XacroArgs,
    /// Folder with many problems. Without a URDF: the problems in its suite.toml. With a URDF: all worlds of the folder
    /// with this robot.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, conflicts_with_all = ["start", "goal", "goal_tip"])]
    #[arg(help_heading = COMPARISON)]
    pub suite: Option<PathBuf>,
    /// Number of random start-goal pairs in each world, instead of the world's own pair. The pairs are independent and
    /// uniform over the free configurations.
    #[arg(long, value_name = "N", conflicts_with_all = ["start", "goal", "goal_tip"],
          value_parser = clap::value_parser!(u32).range(1..=MAX_QUERIES), help_heading = COMPARISON)]
    pub queries: Option<u32>,
    /// Seed of the random pairs. The same seed gives the same pairs in this and all later versions; fewer queries are
    /// the first of these pairs.
    #[arg(long, value_name = "S", default_value_t = 1, requires = "queries", help_heading = COMPARISON)]
    pub seed: u64,
    /// Number of simultaneous runs. With more than one, computing times are less exact, and memory is not reported.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = COMPARISON)]
    pub jobs: u16,
    /// Run only this planner; can be repeated. Each row is about the planner's default path. For planners with two
    /// kinds of paths (see --path in `cplan help planners`), the report lists length and clearance of both kinds.
    #[arg(long, value_parser = word(planners()), value_name = "NAME", help_heading = COMPARISON)]
    pub planner: Vec<Method>,
    /// Add a row for a planner with its own options, such as --with "harmonic --field oriented --epsilon 0.5
    /// --direction 0,-1" or --with "trapezoid --path own"; can be repeated.
    #[arg(long, value_name = "PLANNER OPTIONS", value_parser = Variant::parse, help_heading = COMPARISON)]
    pub with: Vec<Variant>,
    /// Add the paths of other planners: a folder with one folder for each planner, which has a file for each problem, such as
    /// DIR/mine/shelf.csv (or .json, .yaml). They are judged as by `cplan verify`.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, help_heading = COMPARISON)]
    pub paths: Option<PathBuf>,
    #[command(flatten)]
    pub query: QueryArgs,
    #[command(flatten)]
    pub effort: EffortArgs,
    #[command(flatten)]
    pub motion: MotionArgs,
    /// Print tables with all columns, wider than 80 characters. The additional columns are the size of the searched
    /// space, the time of each stage, and both kinds of paths.
    #[arg(long, help_heading = OUTPUT)]
    pub wide: bool,
    /// Print the results as JSON. For several problems: all runs, distributions and the summary.
    #[arg(long, help_heading = OUTPUT)]
    pub json: bool,
    /// Print the results as CSV, one line per run.
    #[arg(long, help_heading = OUTPUT)]
    pub csv: bool,
    /// Print the tables as Markdown.
    #[arg(long, help_heading = OUTPUT)]
    pub markdown: bool,
    /// Write the results: .md, .csv or .json as above, .html (one page with charts and paths), .log (for OMPL's Planner
    /// Arena). Can be repeated.
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Draw all paths in one picture: .svg or .png. Only for one problem. Can be repeated.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["suite", "queries"], help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    /// Print no progress.
    #[arg(long, help_heading = OUTPUT)]
    pub quiet: bool,
}

impl CompareArgs {
    /// Returns true if one problem is compared, not several.
    pub fn is_single(&self) -> bool {
        self.suite.is_none() && self.queries.is_none()
    }
}
