//! A quick path that is about the shortest.

use super::Verdict;
use super::settle::{checked, decide};
use super::subdivision::taut;
use super::taut::pulled_taut;
use crate::certify::{Channel, Connectivity, short_slab_channel};
use crate::model::Problem;
use crate::space::Configuration;

/// Distance from obstacles that rows keep beyond the clearance asked for, as a share of the arm's reach: room for the
/// certificate.
const KEPT: f64 = 1e-5;

/// Rows at most.
const MOST_ROWS: usize = 20_000;

/// Answers `problem` with about the shortest path: within `tolerance` (a share of its length) of the shortest in its
/// class, as far as adding rows tells, and in the class that looks shortest at the slabs' resolution. Certified; a proof
/// where there is none; and whatever [`decide`] says where the attempt fails.
#[must_use]
pub fn shorten(problem: &Problem, tolerance: f64, slabs: usize) -> Verdict {
    let scene = problem.scene();
    let clearance = scene.workspace().clearance;
    let found = match short_slab_channel(scene, problem.start(), problem.goals(), clearance, slabs) {
        Connectivity::Connected(channel) => {
            pulled_taut(scene, &places(&channel), tolerance, KEPT, MOST_ROWS).map(Verdict::Found)
        }
        Connectivity::Disconnected(proof) => checked(problem, proof).map(Verdict::Infeasible),
        Connectivity::Undecided { .. } => None,
    };
    found.unwrap_or_else(|| decide(problem, slabs))
}

/// Places on the way through a channel of slabs: where it begins and ends, and between two slabs.
fn places(channel: &Channel) -> Vec<Configuration> {
    // Doors across the seam of joint 2 lie within a slab; rows know no seam.
    let doors = channel.doors().iter().filter(|[left, right]| left[0] == right[0]);
    let mut places = vec![channel.start()];
    places.extend(doors.map(|[left, right]| (left + right) / 2.0));
    places.push(taut(channel).goal());
    places
}
