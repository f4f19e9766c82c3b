//! A motion along a line, for pictures and pages: the distance of the tip from the line, the limits that determine the speed, and
//! the IK solutions. Everything is computed from the samples of the motion, interpolated as controllers do.

mod drawing;
mod feet;
mod limits;
mod played;
mod solutions;
#[cfg(test)]
mod tests;
pub mod strip;
mod view;

pub use drawing::*;
pub use feet::{Foot, Tracker};
pub use limits::Stretch;
use limits::{active_limits, stops, stretches, with_wrist};
pub use played::Played;
pub use solutions::{SolutionPart, solutions};
pub use view::{LineView, MoveMark, document};

use cplan_handling::Piece;
use cplan_model::Arm;
use cplan_motion::Trajectory;
use cplan_toolpath::Toolpath;

/// Number of times between two samples at which the distance from the line is measured.
const PLACES_PER_SPAN: u32 = 4;

/// Number of equal intervals of time for which pictures show the least and the greatest distance.
const DEVIATION_BINS: usize = 480;

/// Number of points along a motion at which pictures show the speed of the tip.
const SPEED_POINTS: usize = 1200;

/// Shortest duration of the stretches that pictures show, as a share of the motion's duration.
const SHORTEST_STRETCH: f64 = 1.0 / 1000.0;

/// The settings of a motion along a line.
#[derive(Debug, Clone, Copy)]
pub struct LineSettings {
    /// Greatest distance of the tip from the line, metres.
    pub tolerance: f64,
    /// Greatest speed of the tip, metres per second. It replaces the speeds of the line.
    pub speed: Option<f64>,
    /// Top speed and greatest acceleration of a wrist that turns the tool, radians and seconds.
    pub wrist: Option<[f64; 2]>,
}

/// The position at which the tip is farthest from the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Farthest {
    /// Time, seconds.
    pub time: f64,
    /// Distance to the left of the line, metres; negative to the right.
    pub offset: f64,
    /// Place of the tip, metres.
    pub tip: [f64; 2],
}

/// A motion along a line, as pictures show it.
#[derive(Debug, Clone, PartialEq)]
pub struct FollowedMotion {
    /// Stretches with the same limit, in order of time, without gaps.
    pub stretches: Vec<Stretch>,
    /// Times at which the arm rests, seconds.
    pub stops: Vec<f64>,
    /// The place at which the tip is farthest from the line, among those measured.
    pub farthest: Farthest,
    /// Least and greatest distance from the line in equal intervals of time, metres: positive to the left.
    pub deviations: Vec<[f64; 2]>,
    /// Times in seconds and speeds of the tip in metres per second.
    pub speeds: Vec<[f64; 2]>,
    /// The motion between the samples.
    pub played: Played,
}

impl FollowedMotion {
    pub fn new(arm: &Arm, line: &Toolpath, trajectory: &Trajectory, settings: LineSettings) -> Self {
        let played = Played::new(arm, trajectory);
        let pieces = &played.pieces;
        let duration = played.duration().max(f64::MIN_POSITIVE);
        let mut tracker = Tracker::new(line, settings.tolerance);
        let mut farthest = Farthest { time: 0.0, offset: 0.0, tip: arm.tip_at(played.at(0.0)).into() };
        let mut deviations = vec![None; DEVIATION_BINS];
        let mut tip_limits = Vec::with_capacity(pieces.len());
        for piece in pieces {
            for place in 1..=PLACES_PER_SPAN {
                let share = f64::from(place) / f64::from(PLACES_PER_SPAN);
                let (time, tip) = (piece.time(share), arm.tip_at(piece.at(share)).into());
                let Foot { piece: index, offset, .. } = tracker.advance(tip);
                if offset.abs() > farthest.offset.abs() {
                    farthest = Farthest { time, offset, tip };
                }
                let bin = ((time / duration * DEVIATION_BINS as f64) as usize).min(DEVIATION_BINS - 1);
                let [least, greatest] = deviations[bin].unwrap_or([offset; 2]);
                deviations[bin] = Some([f64::min(least, offset), f64::max(greatest, offset)]);
                if 2 * place == PLACES_PER_SPAN {
                    let own = &line.pieces()[index];
                    tip_limits.push(if own.is_travel { None } else { settings.speed.or(own.speed) });
                }
            }
        }
        let limits = active_limits(arm, pieces, &tip_limits);
        let limits = match settings.wrist {
            Some(most) if trajectory.wrist.len() == pieces.len() + 1 => {
                with_wrist(limits, &trajectory.wrist_pieces(), most)
            }
            _ => limits,
        };
        Self {
            stretches: stretches(pieces, &limits, SHORTEST_STRETCH * duration),
            stops: stops(trajectory),
            farthest,
            deviations: filled(deviations),
            speeds: speeds(arm, pieces),
            played,
        }
    }
}

/// Fills intervals without a measurement with the value before them, or, at the beginning, with the first value.
fn filled(measured: Vec<Option<[f64; 2]>>) -> Vec<[f64; 2]> {
    let mut last = measured.iter().flatten().next().copied().unwrap_or_default();
    let filled = measured.into_iter().map(|value| {
        last = value.unwrap_or(last);
        last
    });
    filled.collect()
}

/// Returns the speed of the tip at both ends of each piece. Many pieces are divided evenly into groups, each with its least and
/// greatest speed, so that no stop is lost.
fn speeds(arm: &Arm, pieces: &[Piece]) -> Vec<[f64; 2]> {
    let ends = pieces.iter().map(|piece| (piece, 1.0));
    let first = pieces.first().map(|piece| (piece, 0.0));
    let all: Vec<[f64; 2]> =
        first.into_iter().chain(ends).map(|(piece, u)| [piece.time(u), limits::tip_speed(arm, piece, u)]).collect();
    if all.len() <= SPEED_POINTS {
        return all;
    }
    let Some(&last) = all.last() else { return all };
    let group = |points: &[[f64; 2]]| {
        let mut ends = [0, points.len() - 1];
        for (i, point) in points.iter().enumerate() {
            if point[1] < points[ends[0]][1] {
                ends[0] = i;
            }
            if point[1] > points[ends[1]][1] {
                ends[1] = i;
            }
        }
        ends.sort_unstable();
        ends.map(|i| points[i])
    };
    let mut chosen: Vec<[f64; 2]> = Vec::with_capacity(SPEED_POINTS + 2);
    let (mut begin, step) = (0, 2.0 * last[0] / SPEED_POINTS as f64);
    for i in 1..=all.len() {
        if i == all.len() || (all[i][0] / step).floor() > (all[begin][0] / step).floor() {
            chosen.extend(group(&all[begin..i]));
            begin = i;
        }
    }
    chosen.push(last);
    chosen.dedup();
    chosen
}
