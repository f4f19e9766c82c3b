//! `cplan recheck`: whether a proof that there is no path holds, or the bound on how short a path can be.

use super::exit::DONE;
use super::failure::Failure;
use super::files::Files;
use super::query_args::QueryArgs;
use super::sinks;
use crate::check::{ProofFormatError, read_proof};
use crate::engine::{Bound, checked_bound};
use crate::input::{self, Source};
use crate::model::MotionProblem;
use crate::text::counted;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Share of a bound that its check may not see: each allows for rounding of its own.
const UNSEEN: f64 = 1e-6;

/// Check a proof that there is no path, or a bound on the shortest, with code that shares nothing with the search that made it.
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
    /// A result of the main job, with the proof that there is no path or a bound on the shortest (`optimum`): .json.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub proof: PathBuf,
    #[command(flatten)]
    pub query: QueryArgs,
}

/// Checks what a result file proves against the two input files. That it was made for them is not taken on trust.
///
/// # Errors
/// Bad input, a file without anything to check, and what does not hold.
pub fn run(args: &RecheckArgs) -> Result<u8, Failure> {
    let loaded = input::load(args.files.robot(), &args.files.world, &args.query.overrides())?;
    loaded.robot.warnings.iter().for_each(|w| sinks::say(&format!("warning: {w}")));
    let failed = |why: String| Failure::Option(format!("{}: {why}", args.proof.display()));
    let source = Source::read(&args.proof)?;
    let problem = &loaded.problem;
    let claim = match read_proof(source.text()) {
        Ok(claim) => claim,
        Err(missing @ ProofFormatError::Missing) => {
            // What holds neither need be no recording.
            let stated = if source.text().contains("\"optimum\"") { stated(args, problem)? } else { None };
            let stated = stated.ok_or_else(|| failed(format!("{missing}, and it has no bound in \"optimum\"")))?;
            sinks::print(&bound_holds(problem, &stated).map_err(failed)?)?;
            return Ok(DONE);
        }
        Err(error) => return Err(failed(error.to_string())),
    };
    let proof = claim
        .checked(problem.scene(), problem.start(), problem.goals(), problem.scene().workspace().clearance)
        .map_err(|error| failed(format!("the proof does not hold: {error}")))?;
    sinks::print(&format!(
        "the proof holds: collisions separate the start from every goal ({})\n",
        counted(proof.stuck().len(), "box")
    ))?;
    Ok(DONE)
}

/// The bound in the result file.
fn stated(args: &RecheckArgs, problem: &MotionProblem) -> Result<Option<Bound>, Failure> {
    let scene = input::load_scene(args.files.robot(), &args.files.world)?;
    let claims = input::load_recording(&args.proof, &scene)?.claims.unwrap_or_default();
    let speeds = problem.scene().arm().joints.each_ref().map(|joint| joint.velocity);
    Ok(claims.optimum.and_then(|optimum| {
        let metric = optimum.metric(speeds)?;
        Some(Bound { metric, lower: optimum.lower_bound, upper: optimum.length })
    }))
}

/// That the bound holds, or why not, in words.
fn bound_holds(problem: &MotionProblem, stated: &Bound) -> Result<String, String> {
    let is_length = |length: f64| length.is_finite() && length >= 0.0;
    if !is_length(stated.lower) || !is_length(stated.upper) || stated.lower > stated.upper {
        return Err(format!("`optimum`: {} to {} are no bounds on a length", stated.lower, stated.upper));
    }
    let seen = checked_bound(problem, stated);
    if seen.length() < stated.lower * (1.0 - UNSEEN) {
        return Err(format!(
            "the bound is not seen to hold: none below {} is stated, none below {} is seen",
            stated.lower,
            seen.length()
        ));
    }
    Ok(format!("the bound holds: no motion is shorter than {:.6}, as {} slices show\n", seen.length(), seen.slices()))
}
