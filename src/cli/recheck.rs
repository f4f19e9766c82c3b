//! `cplan recheck`: checks the proof or the bound of a result, or a certificate, by independent checkers.

use super::exit::DONE;
use super::failure::Failure;
use super::files::Files;
use super::plan::with_ends;
use super::query_args::QueryArgs;
use super::sinks;
use crate::check::{CollisionBox, ProofFormatError, read_proof};
use crate::engine::{Bound, certificate_of_bound, certificate_of_boxes};
use crate::input::{self, LoadedScene, Overrides, Source};
use crate::model::MotionProblem;
use crate::text::counted;
use clap::{Args, ValueHint};
use cplan_check_files::{CheckError, Input, check_beside};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Greatest fraction of a bound that may be lost when the bound is recomputed from its evidence. Some is lost because
/// walls are found at finitely many points.
const EVIDENCE_LOSS: f64 = 1e-3;
/// Greatest lost fraction of a bound that is attributed to rounding, and not reported.
const UNREPORTED_LOSS: f64 = 1e-6;

/// Check a proof, a bound or a certificate independently.
///
/// The checker shares no code with the searches that found the evidence.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan plan robots/planar_2r.urdf workspaces/singular_closed.toml \\
    --output proof.json
  cplan recheck robots/planar_2r.urdf workspaces/singular_closed.toml \\
    --proof proof.json
  cplan plan robots/planar_2r.urdf workspaces/shelf.toml --output bound.json
  cplan recheck robots/planar_2r.urdf workspaces/shelf.toml --proof bound.json

Exit codes: 0 the evidence holds, 1 it does not, or bad input or I/O, 2 wrong
command line.")]
pub struct RecheckArgs {
    #[command(flatten)]
    pub files: Files,
    /// File with the evidence (.json): a certificate, or a result of `cplan plan` with a proof that there is no path or with
    /// a bound on the shortest path (`optimum`).
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub proof: PathBuf,
    #[command(flatten)]
    pub query: QueryArgs,
}

/// Checks the claims of a result file against the two input files, which may be other ones than those of the result.
///
/// # Errors
/// Bad input, a file without claims, and claims that do not hold.
pub fn run(args: &RecheckArgs) -> Result<u8, Failure> {
    let scene = input::load_scene(args.files.robot(), &args.files.world)?;
    scene.robot.warnings.iter().for_each(|w| sinks::print_status(&format!("warning: {w}")));
    let source = Source::read(&args.proof)?;
    let asked = args.query.overrides();
    let evidence = Evidence::of(source.text());
    // A certificate itself states start and goal.
    let stated_ends = if asked == Overrides::default() && evidence.certificate {
        format!("the certificate holds: {}", check_certificate(args, "certificate", source.text())?)
    } else {
        let problem = scene.clone().problem(&asked)?.problem;
        let asked = with_ends(asked, scene.resolved_ends(), &problem);
        match read_proof(source.text()) {
            Ok(claim) => proof_holds(args, &problem, claim.collision_boxes(), &asked)?,
            Err(missing @ ProofFormatError::Missing) => {
                // A file with neither a proof nor a bound need not be a result.
                let stated = if evidence.bound { read_stated_bound(args, &scene)? } else { None };
                let none = || evidence_failure(args, format!("{missing}, and no bound in \"optimum\""));
                bound_holds(args, &problem, &stated.ok_or_else(none)?, &asked)?
            }
            Err(error) => return Err(evidence_failure(args, error)),
        }
    };
    sinks::print(&(stated_ends + "\n"))?;
    Ok(DONE)
}

/// Creates a failure about the file with the evidence.
fn evidence_failure(args: &RecheckArgs, why: impl Display) -> Failure {
    Failure::Refused(format!("{}: {why}", args.proof.display()))
}

/// The kinds of evidence that a file has.
#[derive(Default)]
struct Evidence {
    /// True for a certificate, and for a result that contains one.
    certificate: bool,
    /// True for a result with a bound on the optimum.
    bound: bool,
}

impl Evidence {
    /// Returns the kinds of evidence in a text, by the names of the members of its JSON object. Other texts have none.
    fn of(text: &str) -> Self {
        #[derive(Deserialize)]
        struct Members {
            format: Option<IgnoredAny>,
            certificate: Option<IgnoredAny>,
            optimum: Option<IgnoredAny>,
        }
        serde_json::from_str(text).map_or_else(
            |_| Self::default(),
            |Members { format, certificate, optimum }| Self {
                certificate: format.is_some() || certificate.is_some(),
                bound: optimum.is_some(),
            },
        )
    }
}

/// Checks a certificate, and returns the statement of the checker. `what` names the evidence in messages.
///
/// # Errors
/// Evidence that does not hold, and files that the checker does not understand.
fn check_certificate(args: &RecheckArgs, what: &str, certificate: &str) -> Result<String, Failure> {
    let (robot, world) = (args.files.robot(), &args.files.world);
    let at = |path: &Path, why: &dyn Display| Failure::Refused(format!("{}{why}", path.display()));
    let whole = |path: &Path| std::fs::read_to_string(path).map_err(|error| at(path, &format!(": {error}")));
    let urdf = robot.read()?;
    let urdf = if urdf.is_converted() { urdf.text().to_owned() } else { whole(&robot.path)? };
    check_beside([&urdf, &whole(world)?, certificate], [&robot.path, world]).map_err(|error| match error {
        CheckError::Fails(why) => evidence_failure(args, format!("the {what} does not hold: {why}")),
        CheckError::Input { input: Input::Certificate, message, .. } => evidence_failure(args, message),
        CheckError::Input { input, line, message } => {
            let path = if input == Input::Urdf { &robot.path } else { world };
            let line = line.map_or_else(String::new, |line| format!(":{line}"));
            at(path, &format!("{line}: {message}"))
        }
    })
}

/// Reads the lower bound that a result file states; `None` without a bound.
fn read_stated_bound(args: &RecheckArgs, scene: &LoadedScene) -> Result<Option<Bound>, Failure> {
    let claims = input::load_recording(&args.proof, scene)?.claims.unwrap_or_default();
    Ok(claims.optimum.and_then(|optimum| {
        let metric = optimum.metric(scene.scene.arm())?;
        Some(Bound { metric, lower: optimum.lower_bound, upper: optimum.length })
    }))
}

/// Checks that boxes prove that there is no path, and returns a statement about it.
///
/// # Errors
/// Boxes that prove nothing.
fn proof_holds(
    args: &RecheckArgs,
    problem: &MotionProblem,
    stuck: &[CollisionBox],
    asked: &Overrides,
) -> Result<String, Failure> {
    let never = |odd| evidence_failure(args, format!("the proof does not hold: the shapes of box {odd} cannot meet"));
    let certificate = certificate_of_boxes(problem, stuck, asked).map_err(never)?;
    check_certificate(args, "proof", &certificate)?;
    let count = counted(stuck.len(), "box");
    Ok(format!("the proof holds: collisions separate the start from every goal ({count})"))
}

/// Checks that a bound holds, and returns a statement about it.
///
/// # Errors
/// A bound that does not hold.
fn bound_holds(
    args: &RecheckArgs,
    problem: &MotionProblem,
    stated: &Bound,
    asked: &Overrides,
) -> Result<String, Failure> {
    let (lower, upper) = (stated.lower, stated.upper);
    let is_length = |length: f64| length.is_finite() && length >= 0.0;
    if !is_length(lower) || !is_length(upper) || lower > upper {
        return Err(evidence_failure(args, format!("`optimum`: {lower} and {upper} are not valid bounds on a length")));
    }
    let unconfirmed = |why: String| evidence_failure(args, format!("the bound is not confirmed: {why}"));
    let found = certificate_of_bound(problem, stated, asked).ok_or_else(|| {
        unconfirmed(
            "there are no certificates of bounds if the goal leaves a joint free, or if the arm is nearly stretched there"
                .into(),
        )
    })?;
    if found.length < lower * (1.0 - EVIDENCE_LOSS) {
        return Err(unconfirmed(format!("the file states {lower}, but only {} is proven", found.length)));
    }
    check_certificate(args, "bound", &found.text)?;
    let segments = counted(found.walls, "segment");
    let missed = 1.0 - found.length / lower;
    let (holds, stated) = if missed > UNREPORTED_LOSS {
        (format!("holds within {:.1e} %", 100.0 * missed), format!(" (the file states {lower:.6})"))
    } else {
        ("holds".to_owned(), String::new())
    };
    Ok(format!(
        "the bound {holds}: no motion is shorter than {:.6}{stated}; proven by {segments} of colliding configurations",
        found.length
    ))
}
