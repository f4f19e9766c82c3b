//! Checks whether a result's claims about its motion are true.
//!
//! The samples of a result are the motion. All other statements in the result are claims about that motion.

mod follow;
mod steps;

pub use steps::{false_step_claims, false_task_claims};

use cplan_handling::{BlendsClaim, Claims, OptimumClaim, Recording, TimedScene};
use cplan_judge::{Rejection, certify, certify_at};
use cplan_model::space::{Configuration, Path};
use cplan_model::{Arm, Scene};
use cplan_motion::recorded::{CollisionCheck, check_collision};
use cplan_text::length_unlike;
use follow::follows;
use std::fmt::Display;
use thiserror::Error;

/// Allowed relative difference between a stated and a recomputed number. The number may be a sum over all waypoints.
const NUMBER_TOLERANCE: f64 = 1e-9;

/// Allowed difference between a stated and a recomputed time, in seconds. It is far greater than the rounding of
/// clocks, and far smaller than the precision of grippers.
const TIME_TOLERANCE: f64 = 1e-6;

/// A statement in a result that is false.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{claim}: {why}")]
pub struct FalseClaim {
    /// Name of the JSON member that makes the statement.
    pub claim: String,
    /// The reason why the statement is false, in words.
    pub why: String,
}

/// A list of the false claims that were found.
#[derive(Default)]
struct Ledger {
    found: Vec<FalseClaim>,
    /// Prefix of the members' names, such as `steps[2].`.
    within: String,
}

impl Ledger {
    fn note(&mut self, claim: &str, why: String) {
        self.found.push(FalseClaim { claim: format!("{}{claim}", self.within), why });
    }

    /// Records a false claim if a stated value differs from the actual one.
    fn check_equal<T: PartialEq + Display>(&mut self, claim: &str, stated: &T, is: &T) {
        if stated != is {
            self.note(claim, format!("stated as {stated}, but it is {is}"));
        }
    }

    /// Records a stated clearance that exceeds an actual distance. `what` is subject and verb of the message, such as
    /// "link 2 and shelf come".
    fn too_large(&mut self, claim: &str, stated: f64, distance: f64, what: &str) {
        let [stated, distance] = [length_unlike(stated, distance), length_unlike(distance, stated)];
        self.note(claim, format!("stated as {stated}, but {what} as near as {distance}"));
    }

    /// Records a false claim if a stated number differs from the actual number `is` by more than `within`.
    fn number(&mut self, claim: &str, stated: Option<f64>, is: f64, within: f64) {
        if let Some(stated) = stated.filter(|stated| (stated - is).abs() > within) {
            self.note(claim, format!("stated as {stated}, but it is {is}"));
        }
    }

    /// Checks that a stated lower bound is at most `length` (or time), and that the stated gap is `length / lower_bound
    /// - 1`.
    fn gap(&mut self, at: &str, length: f64, lower_bound: Option<f64>, gap: Option<f64>) {
        let Some(bound) = lower_bound else { return };
        if bound.is_nan() || bound > length * (1.0 + NUMBER_TOLERANCE) {
            self.note(
                &format!("{at}lower_bound"),
                format!("stated as {bound}, but a motion of length {length} exists"),
            );
        }
        if bound > 0.0 {
            let is = length / bound - 1.0;
            self.number(&format!("{at}gap"), gap, is, NUMBER_TOLERANCE * (1.0 + is.abs()));
        }
    }

    /// Checks a path, its length, and its cut corners against the motion.
    fn path(
        &mut self,
        scene: &Scene,
        recording: &Recording,
        path: &[Configuration],
        length: Option<f64>,
        blends: Option<BlendsClaim>,
    ) {
        let Some((&first, &last)) = path.first().zip(path.last()) else {
            return self.note("path", "has no waypoint".into());
        };
        let path = Path::new(path.to_vec());
        self.number("length", length, path.length(), NUMBER_TOLERANCE * (1.0 + path.length()));
        if let Some(BlendsClaim { count, largest_radius }) = blends {
            let corners = path.waypoints().len().saturating_sub(2);
            if count > corners {
                self.note("blends.count", format!("stated as {count}, but the path has {corners} corners"));
            }
            let longest = path.segments().map(|(a, b)| (b - a).norm()).fold(0.0, f64::max);
            if !(0.0..=longest * (1.0 + NUMBER_TOLERANCE)).contains(&largest_radius) {
                let why = format!("stated as {largest_radius}, but the longest straight piece is {longest}");
                self.note("blends.largest_radius", why);
            }
        }
        if let Err(departure) = follows(&path, recording, blends.map(|blends| blends.largest_radius)) {
            self.note("path", departure);
        }
        let ends = [(first, 0, "begins"), (last, recording.positions().len() - 1, "ends")];
        for (end, sample, what) in ends {
            let at = recording.positions()[sample];
            if (end - at).amax() > follow::PATH_TOLERANCE {
                self.note(
                    "path",
                    format!("{what} at ({}, {}), but the motion {what} at ({}, {})", end[0], end[1], at[0], at[1]),
                );
            }
        }
        match certify(scene, path) {
            Err(Rejection::TooClose(nearest)) => {
                let (pair, at) = (scene.describe(nearest.contact.pair), nearest.at);
                let distance = nearest.contact.separation.distance;
                let why = format!(
                    "the path is not free: {pair} are {} apart at ({}, {})",
                    cplan_text::length(distance),
                    at[0],
                    at[1]
                );
                self.note("path", why);
            }
            Err(Rejection::OutOfLimits { waypoint, limited }) => {
                let limit = scene.arm().describe_limit(limited);
                self.note("path", format!("waypoint {waypoint} is beyond the limits of {limit}"));
            }
            // The clearance is met, or the distance equals it up to the resolution of the check.
            Err(Rejection::Undecided(_)) | Ok(_) => {}
        }
    }

    /// Checks a stated clearance in a scene. `found` is the collision check with the required clearance. If it does not
    /// decide the claim, the motion is checked again with the stated clearance.
    fn clearance(
        &mut self,
        stated: Option<Option<f64>>,
        timed: TimedScene,
        recording: &Recording,
        found: &CollisionCheck,
    ) {
        let scene = timed.scene;
        let Some(stated) = stated else { return };
        let nearest = match found {
            CollisionCheck::Free { nearest, clearance } => {
                if stated.is_some_and(|stated| stated <= *clearance) {
                    return;
                }
                nearest.map(|nearest| nearest.contact)
            }
            CollisionCheck::Collision { deepest, .. } => Some(deepest.contact),
            CollisionCheck::Undecided(nearest) => Some(nearest.contact),
        };
        let Some(nearest) = nearest else { return };
        let Some(stated) = stated else {
            let pair = scene.describe(nearest.pair);
            return self.note("clearance", format!("stated as null (no obstacle within reach), but {pair} can meet"));
        };
        if let Some((distance, pair)) = nearer(timed, recording, stated, nearest.separation.distance, nearest.pair) {
            self.too_large("clearance", stated, distance, &format!("{} come", scene.describe(pair)));
        }
    }
}

/// Returns a distance on the motion that is below the stated one, with its pair of shapes. `None` if there is none.
fn nearer(
    scene: TimedScene,
    recording: &Recording,
    stated: f64,
    seen: f64,
    pair: cplan_model::Pair,
) -> Option<(f64, cplan_model::Pair)> {
    // Distances that are computed by two methods may differ by this much.
    let stated = stated - NUMBER_TOLERANCE * stated.abs() - NUMBER_TOLERANCE * f64::EPSILON.sqrt();
    if seen < stated {
        return Some((seen, pair));
    }
    match check_collision(scene, recording, stated.max(0.0)) {
        CollisionCheck::Collision { deepest, .. } => Some((deepest.contact.separation.distance, deepest.contact.pair)),
        _ => None,
    }
}

/// Returns the false claims of a result. `found` is the collision check of its motion with the scene's clearance.
///
/// The function checks:
/// - that there is a motion (`status`, `certified`), and its `units` and `duration`;
/// - that the motion follows the `path`, and that the path itself is free and as long as stated;
/// - that no obstacle is nearer than the stated `clearance`;
/// - that bounds and gaps agree with lengths.
///
/// It does not check that lower bounds are valid.
pub fn false_claims<'a>(
    scene: impl Into<TimedScene<'a>>,
    recording: &Recording,
    claims: &Claims,
    found: &CollisionCheck,
) -> Vec<FalseClaim> {
    let timed = scene.into();
    let scene = timed.scene;
    let mut ledger = Ledger::default();
    ledger.general(scene.arm(), recording, claims);
    if let Some(path) = &claims.path {
        ledger.path(scene, recording, path, claims.length, claims.blends);
        ledger.optimum(scene, path, claims.optimum.as_ref());
    }
    ledger.clearance(claims.clearance, timed, recording, found);
    if let (Some(Some(stated)), Some(path)) = (claims.clearance, claims.path.as_ref().filter(|path| !path.is_empty())) {
        ledger.clearance_of_path(scene, Path::new(path.clone()), stated);
    }
    ledger.found
}

impl Ledger {
    /// Checks the claims about any motion.
    fn general(&mut self, arm: &Arm, recording: &Recording, claims: &Claims) {
        // The motion of an exploration may have any of these outcomes. Any other result must state that a motion was found.
        let of_exploration = ["reached", "explored", "unreachable", "unknown"];
        if let Some(status) = claims.status.as_ref().filter(|status| !of_exploration.contains(&status.as_str())) {
            self.check_equal("status", status, &"found".to_owned());
        }
        if let Some(certified) = claims.certified {
            self.check_equal("certified", &certified, &true);
        }
        if let Some(units) = &claims.units {
            let is = arm.joints.each_ref().map(|joint| joint.unit()).join(", ");
            self.check_equal("units", &units.join(", "), &is);
        }
        if let Some(duration) = recording.duration() {
            self.number("duration", claims.duration, duration, TIME_TOLERANCE);
        }
    }

    fn optimum(&mut self, scene: &Scene, path: &[Configuration], claim: Option<&OptimumClaim>) {
        let Some(claim) = claim.filter(|_| !path.is_empty()) else { return };
        match claim.metric(scene.arm()) {
            Some(metric) => {
                let length = metric.length(&Path::new(path.to_vec()));
                self.number("optimum.length", Some(claim.length), length, NUMBER_TOLERANCE * (1.0 + length));
            }
            None => self.note("optimum.metric", format!("\"{}\" is none", claim.metric)),
        }
        self.gap("optimum.", claim.length, Some(claim.lower_bound), claim.gap);
    }

    fn clearance_of_path(&mut self, scene: &Scene, path: Path, stated: f64) {
        let asked = stated - NUMBER_TOLERANCE * stated.abs() - NUMBER_TOLERANCE * f64::EPSILON.sqrt();
        if let Err(Rejection::TooClose(nearest)) = certify_at(scene, path, asked.max(0.0)) {
            let what = format!("on the path {} come", scene.describe(nearest.contact.pair));
            self.too_large("clearance", stated, nearest.contact.separation.distance, &what);
        }
    }
}
