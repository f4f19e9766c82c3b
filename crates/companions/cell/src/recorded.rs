//! The judgement of two given motions between the arms, on one clock.

use crate::Cell;
use crate::between::Between;
use crate::curve::Curve;
use crate::judged::{Judgement, NearestPlace, judge, sampled_too_near};
use crate::stage::StagePairs;
use cplan_handling::Piece;
use cplan_model::space::Configuration;

/// A place of two motions at which the arms are near to each other.
#[derive(Debug, Clone, PartialEq)]
pub struct NearPlace {
    /// The time on the clock of each arm, seconds.
    pub times: [f64; 2],
    /// The configuration of each arm.
    pub at: [Configuration; 2],
    /// The distance of the arms, metres; negative if they overlap.
    pub distance: f64,
    /// The links, such as `"forearm" of left and "upper arm" of right`.
    pub links: String,
    /// The place in the cell, metres: a point of the first link that is nearest to the second, or deepest in it.
    pub point: [f64; 2],
}

/// The finding about two motions between the arms.
#[derive(Debug, Clone, PartialEq)]
pub enum BetweenFinding {
    /// Proven: the arms keep the clearance.
    Free {
        /// Proven lower bound on the distance, metres. Infinite if no links can meet.
        clearance: f64,
        /// The nearest place that was seen.
        nearest: Option<NearPlace>,
    },
    /// Proven: the arms collide, or are nearer than the clearance.
    TooNear {
        /// The first place that was seen.
        first: NearPlace,
        /// The nearest place that was seen.
        nearest: NearPlace,
    },
    /// Neither is proven.
    Undecided,
}

/// Judges two motions between the arms of a cell: both clocks may differ by up to `skew` seconds. Each arm rests at its first
/// place before its motion, and at its last place after it.
pub fn judge_between(cell: &Cell, motions: [Vec<Piece>; 2], skew: f64) -> BetweenFinding {
    let scenes = cell.arms.each_ref().map(|arm| arm.problem.scene());
    let pairs = StagePairs::single(Between::new(scenes, cell.is_one_robot, scenes[0].workspace().clearance));
    let curves = with_rests(motions.map(Curve::of_pieces), skew);
    judged_between(cell, &pairs, &curves, skew)
}

/// Judges two curves with rests between the arms of a cell.
pub(crate) fn judged_between(cell: &Cell, pairs: &StagePairs, curves: &[Curve; 2], skew: f64) -> BetweenFinding {
    let names = cell.arms.each_ref().map(|arm| arm.name.as_str());
    let described = |place: NearestPlace| {
        let NearestPlace { times, distance, stages, pair } = place;
        let (between, at) = (pairs.between(stages), [0, 1].map(|arm| curves[arm].at(times[arm])));
        let (links, point) = (between.describe(pair, names), between.contact(pair, at).into());
        NearPlace { times, at, distance, links, point }
    };
    match judge(pairs, curves, skew) {
        Judgement::Apart { clearance, nearest } => BetweenFinding::Free { clearance, nearest: nearest.map(described) },
        Judgement::TooClose(place) => {
            let (first, nearest) = sampled_too_near(pairs, curves, skew, place);
            BetweenFinding::TooNear { first: described(first), nearest: described(nearest) }
        }
        Judgement::Undecided => BetweenFinding::Undecided,
    }
}

/// Returns both curves with rests: they begin and end at the same times, and may be shifted by the skew.
pub(crate) fn with_rests(curves: [Curve; 2], skew: f64) -> [Curve; 2] {
    let [one, two] = curves.each_ref().map(Curve::ends);
    let [begin, end] = [one[0].min(two[0]) - skew, one[1].max(two[1]) + skew];
    curves.map(|curve| curve.resting(begin, end))
}
