//! `cplan planners`: the options of each planner.

use super::exit::DONE;
use super::failure::Failure;
use super::{grammar, sinks};
use crate::engine::Method;
use crate::options::{PlannerArgs, planners, word};
use clap::Args;

/// List the options of each planner.
///
/// These options belong to `cplan plan`, `cplan demo` and `cplan explore`.
#[derive(Debug, Args)]
#[command(after_help = "\
The same options follow a planner's name in `cplan compare --with \"PLANNER
OPTIONS\"` and on the live page.

Examples:
  cplan plan robots/planar_2r.urdf workspaces/shelf.toml --gap 0.01
  cplan plan robots/planar_2r.urdf workspaces/shelf.toml \\
    --planner wavefront --search astar --neighbors 8
  cplan plan robots/planar_2r.urdf workspaces/shelf.toml \\
    --planner prm --seed 7 --search greedy --backward
  cplan plan robots/planar_2r.urdf workspaces/u_trap.toml \\
    --planner harmonic --field oriented --epsilon 0.5 --direction 0,-1

Exit codes: 0 the options are printed, 2 wrong command line.")]
pub struct PlannersArgs {
    /// Planner. Each option below names the planners that read it.
    #[arg(long, value_parser = word(planners()), value_name = "NAME", default_value_t = Method::Shortest)]
    pub planner: Method,
    #[command(flatten)]
    pub options: PlannerArgs,
}

/// Prints the options. The other arguments of the command line have no effect.
///
/// # Errors
/// I/O.
pub fn run(_: &PlannersArgs) -> Result<u8, Failure> {
    let mut grammar = grammar();
    // Subcommands get their full names, and the width of the help.
    grammar.build();
    let help = grammar.find_subcommand_mut("planners").map(|command| command.render_long_help().to_string());
    sinks::print(&help.unwrap_or_default())?;
    Ok(DONE)
}
