//! `cplan planners`: the options of each planner.

use super::exit::DONE;
use super::failure::Failure;
use super::program::Program;
use super::sinks;
use crate::engine::Method;
use crate::grammar::{PlannerArgs, word};
use clap::Args;

/// Tell what each planner can be told: these options are options of the main job.
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

/// Prints the options. The rest of the command line is only checked against the grammar.
///
/// # Errors
/// I/O.
pub fn run(_: &PlannersArgs, program: &Program) -> Result<u8, Failure> {
    let mut grammar = (program.grammar)();
    let help = grammar.find_subcommand_mut("planners").map(|command| command.render_long_help().to_string());
    sinks::print(&help.unwrap_or_default())?;
    Ok(DONE)
}
