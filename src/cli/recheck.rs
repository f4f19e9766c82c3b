//! `cplan recheck`: whether a proof that there is no path holds.

use super::DONE;
use super::args::RecheckArgs;
use super::failure::Failure;
use super::sinks;
use crate::check::read_proof;
use crate::input::{self, Source};

/// Checks the proof in a result file against the two input files. That it was made for them is not taken on trust.
///
/// # Errors
/// Bad input, a file without a proof, and a proof that does not hold.
pub fn run(args: &RecheckArgs) -> Result<u8, Failure> {
    let loaded = input::load(&args.files.urdf, &args.files.world, &args.query.overrides())?;
    loaded.robot.warnings.iter().for_each(|w| sinks::say(&format!("warning: {w}")));
    let failed = |why: String| Failure::Option(format!("{}: {why}", args.proof.display()));
    let source = Source::read(&args.proof)?;
    let claim = read_proof(source.text()).map_err(|e| failed(e.to_string()))?;
    let problem = &loaded.problem;
    let proof = claim
        .checked(problem.scene(), problem.start(), problem.goals(), problem.scene().workspace().clearance)
        .map_err(|error| failed(format!("the proof does not hold: {error}")))?;
    sinks::print(&format!(
        "the proof holds: {} boxes of collisions separate the start from every goal\n",
        proof.stuck().len()
    ))?;
    Ok(DONE)
}
