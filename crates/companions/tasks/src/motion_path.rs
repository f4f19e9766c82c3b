//! Paths of the motions of a task: inexpensive checks, and planning with only those objects that matter.

use super::refusal::{Blockers, Refusal, require_unobstructed};
use cplan_judge::{CertifiedPath, CheckedProof, certify};
use cplan_model::space::{Configuration, Path};
use cplan_model::{MotionProblem, Outcome, Scene};
use cplan_proofs::{Connectivity, slab_connectivity};
use cplan_solver::{Answer, BoundedPath, LARGE_PROOF_BOXES, Options, Unknown, solve};
use std::collections::BTreeSet;

/// Fraction by which a path may be longer than the shortest one.
const PATH_GAP: f64 = 0.01;

/// Knowledge about a motion's path before it is planned.
pub(super) enum PathStatus {
    /// The certified straight path. No path is shorter in any metric.
    Straight(CertifiedPath),
    /// The straight path is not free, but other paths are not ruled out.
    Undecided,
    /// There is no path.
    Infeasible(Refusal),
}

/// Number of slabs that an inexpensive proof of infeasibility may use. It takes some milliseconds. If they do not
/// suffice, the planner must decide.
const DECISION_SLABS: usize = 2_000;

/// Number of attempts to plan with only some of the objects before all of them are included.
const ATTEMPTS_AMONG_FEW: usize = 3;

/// Samples per segment when collecting the objects that a path hits.
const SAMPLES_PER_SEGMENT: u32 = 16;

/// Returns the options for planning the motions of a task. A task minimises duration, not length, and a slightly longer
/// path permits faster motions.
pub(super) fn of_legs(options: &Options) -> Options {
    let planner = options.planner.with_gap(options.planner.gap().unwrap_or(PATH_GAP));
    Options { planner, bounded: false, ..*options }
}

/// Plans with only a few objects, and adds those that the path hits. Returns a path that is free among all objects, or
/// a proof that there is no path even among the few. Returns `None` if the path must be planned among all objects. The
/// first `own` obstacles are not objects. `plan` plans a path among some objects.
pub(super) fn plan_among_few(
    scene: &Scene,
    own: usize,
    mut plan: impl FnMut(&BTreeSet<usize>) -> Result<CertifiedPath, Refusal>,
) -> Option<Result<CertifiedPath, Refusal>> {
    let hit_at = |q: Configuration| {
        let hits = scene.obstructions(q).into_iter().map(|hit| hit.contact.pair.obstacle);
        hits.filter_map(|obstacle| obstacle.checked_sub(own)).collect::<Vec<_>>()
    };
    let mut among: BTreeSet<usize> = BTreeSet::new();
    for _ in 0..ATTEMPTS_AMONG_FEW {
        let found = match plan(&among) {
            Ok(found) => found.path().clone(),
            Err(refusal) if refusal.proven => return Some(Err(refusal)),
            Err(_) => return None,
        };
        if let Ok(path) = certify(scene, found.clone()) {
            return Some(Ok(path));
        }
        let before = among.len();
        for ends in found.waypoints().windows(2) {
            for part in 0..=SAMPLES_PER_SEGMENT {
                among.extend(hit_at(ends[0].lerp(&ends[1], f64::from(part) / f64::from(SAMPLES_PER_SEGMENT))));
            }
        }
        if among.len() == before {
            return None;
        }
    }
    None
}

/// Plans a motion of a task again, with the same steps as before: first among few objects, then among all. Returns the
/// problem and the planner's answer. `None` if an optimising planner is chosen and the straight path is certified, as
/// no planner ran then.
pub(super) fn planned_again(
    scene: &Scene,
    own: usize,
    [from, to]: [Configuration; 2],
    options: &Options,
) -> Option<(MotionProblem, Answer)> {
    let asked = |scene: Scene| {
        let problem = MotionProblem::trusted(scene, from, to);
        let answer = solve(&problem, options, &mut |_| {});
        (problem, answer)
    };
    if !options.planner.method().optimizes() {
        return Some(asked(scene.clone()));
    }
    if certified_straight_path(scene, from, to).is_some() {
        return None;
    }
    let mut last = None;
    let found = plan_among_few(scene, own, |among| {
        let (_, answer) = last.insert(asked(scene_with_objects(scene, own, among)));
        path_or_refusal(answer.outcome.clone())
    });
    match found {
        Some(Ok(_)) => last,
        _ => Some(asked(scene.clone())),
    }
}

/// Returns the scene with only some of its objects. The others keep their indices, but have no shape.
fn scene_with_objects(scene: &Scene, own: usize, among: &BTreeSet<usize>) -> Scene {
    let mut number = 0;
    scene.reshaped(
        |_| {},
        |obstacle| {
            number += 1;
            let stays = number <= own || among.contains(&(number - 1 - own));
            if stays { obstacle.pieces.clone() } else { Vec::new() }
        },
    )
}

/// Returns the straight path between two configurations. `None` if it is not certified.
fn certified_straight_path(scene: &Scene, from: Configuration, to: Configuration) -> Option<CertifiedPath> {
    let straight = Path::new(vec![from, scene.arm().topology().lift(to, from)]);
    certify(scene, straight).ok()
}

/// Examines the path between two configurations by inexpensive checks.
pub(super) fn examine_path(scene: &Scene, from: Configuration, to: Configuration) -> PathStatus {
    let ends = require_unobstructed(scene, from, "at its beginning")
        .map_err(|refusal| Refusal { blockers: Blockers::Unknown, ..refusal })
        .and_then(|()| require_unobstructed(scene, to, "at its end"));
    if let Err(refusal) = ends {
        return PathStatus::Infeasible(refusal);
    }
    let clearance = scene.workspace().clearance;
    if let Some(path) = certified_straight_path(scene, from, to) {
        return PathStatus::Straight(path);
    }
    let goal = to.into();
    match slab_connectivity(scene, from, &goal, clearance, DECISION_SLABS, LARGE_PROOF_BOXES) {
        Connectivity::Disconnected(proof) => proof
            .checked(scene, from, &goal, clearance)
            .map_or(PathStatus::Undecided, |proof| PathStatus::Infeasible(Refusal::proven(proof))),
        _ => PathStatus::Undecided,
    }
}

/// Returns the planner's path from one configuration to another.
pub(super) fn path(
    scene: &Scene,
    from: Configuration,
    to: Configuration,
    options: &Options,
) -> Result<CertifiedPath, Refusal> {
    let problem = MotionProblem::trusted(scene.clone(), from, to);
    path_or_refusal(solve(&problem, options, &mut |_| {}).outcome)
}

/// Converts the planner's outcome to a path, or to the reason for the refusal.
fn path_or_refusal(outcome: Outcome<BoundedPath, CheckedProof, Unknown>) -> Result<CertifiedPath, Refusal> {
    match outcome {
        Outcome::Found(path) => Ok(path.certified),
        Outcome::Infeasible(proof) => Err(Refusal::proven(proof)),
        Outcome::Unknown(unknown) => Err(Refusal::new(unknown.reason, false)),
    }
}
