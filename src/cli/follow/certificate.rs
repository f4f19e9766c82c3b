//! The certificate of an answer.

use super::Answered;
use crate::cli::sinks;
use crate::engine::{CertifiedLine, ExcludedSolution, NoCertificate};
use crate::input::Overrides;
use crate::model::{Outcome, Status};
use cplan_follow::{Cause, Exclusion, Infeasible, Obstacle};
use std::path::Path;

/// Returns the text of the certificate. If the answer has no certificate, prints a warning about its file.
pub fn text(answered: &Answered, path: &Path) -> Option<String> {
    let Answered { args, loaded, line, answer, digests, .. } = answered;
    let asked = &Overrides { clearance: args.clearance, calibration: args.calibration, ..Overrides::default() };
    let (scene, tolerance, files) = (&loaded.scene, answered.tolerance, digests.as_ref());
    let certified = CertifiedLine { scene, line, tolerance, elbow: answered.elbow, asked, files };
    let text = match answer {
        Outcome::Found(found) => Ok(certified.of_motion(&found.timed.trajectory)),
        Outcome::Infeasible(Infeasible { cause: Cause::TooLarge { .. }, .. }) => Err(NoCertificate::Placement),
        Outcome::Infeasible(infeasible) => {
            let excluded: Option<Vec<ExcludedSolution>> = infeasible.evidence.iter().map(excluded).collect();
            let of_exclusions = |excluded: Vec<_>| certified.of_exclusions(&infeasible.place, &excluded);
            excluded.map_or(Err(NoCertificate::Wrist), of_exclusions)
        }
        Outcome::Unknown(_) => Err(NoCertificate::Answer(Status::Unknown)),
    };
    text.map_err(|why| sinks::print_status(&format!("warning: {} is not written: {why}", path.display()))).ok()
}

/// Returns the exclusion for a certificate. `None` if the wrist excludes the solution, which a certificate cannot show.
fn excluded(exclusion: &Exclusion) -> Option<ExcludedSolution> {
    let Exclusion { place, solution, q, by } = exclusion;
    let pair = match by {
        Obstacle::Limit(_) => None,
        Obstacle::Collision(pair) => Some(*pair),
        Obstacle::Wrist(_) => return None,
    };
    Some(ExcludedSolution { place: *place, solution: *solution, q: *q, pair })
}
