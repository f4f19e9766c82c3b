//! Motions with limits on jerks, through the corners of a path.
//!
//! A path with blends is timed without limits on jerks, and the motion is smoothed (`spline`). At corners, the smoothed motion
//! deviates towards the inside, where the obstacle is. If it is not proven free there, the corner is passed more slowly. Finally,
//! `retime` finds the fastest motion along the resulting curve.

use super::clock::{nanoseconds, seconds};
use super::extent::extents;
use super::limits::Limits;
use super::sample::{TimedMotion, Trajectory};
use super::schedule::{TimedTrack, schedule, stopping_at};
use super::spline::Spline;
use crate::{BlendedPath, Rounding, blend};
use cplan_handling::Piece;
use cplan_judge::CertifiedPath;
use cplan_model::Scene;
use std::collections::BTreeSet;

/// Factor by which the speed at a corner is reduced if the motion near it is not proven free.
const SLOWDOWN_FACTOR: f64 = 0.7;

/// Below this fraction of a corner's full speed, the arm stops at the corner instead.
const MIN_SPEED_SHARE: f64 = 1.0 / 128.0;

/// Number of rounds in which speeds at corners are reduced. After that, the arm stops at all corners.
const MAX_ROUNDS: usize = 24;

/// Ratio of an acceleration limit to the limit tried before it. With a lower limit, the jerk needs less time to reverse the
/// acceleration.
const ACCELERATION_FACTOR: f64 = 0.8;

/// Least acceleration limit that is tried, as a share of the full limit.
const MIN_ACCELERATION_SHARE: f64 = 1e-3;

/// A path that is timed within limits.
struct Smoothing<'a> {
    limits: Limits<'a>,
    /// The limits on speeds and accelerations, without those on jerks. Accelerations may be lower than the joints allow.
    base: Limits<'a>,
    /// Least time between acceleration and deceleration on a straight piece, seconds.
    coast: f64,
    period: f64,
    /// True if motions are retimed, that is, driven along their own curves in the least time.
    retimes: bool,
}

/// A motion, with the times at which it passes the corners of its path.
struct SmoothMotion {
    trajectory: Trajectory,
    /// Waypoints, each with the times, in nanoseconds, at which the motion enters and leaves its blend.
    passed: Vec<(usize, [u64; 2])>,
}

/// Returns the fastest motion around the corners of a path that is proven free, shorter than `below` seconds, and off the path
/// only within `greatest` of a corner. `None` if no such motion is found. If requested, the motion is finally driven along its
/// own curve in the least time.
pub(super) fn smoothed(
    scene: &Scene,
    path: &CertifiedPath,
    greatest: f64,
    limits: Limits,
    period: f64,
    below: f64,
    retimes: bool,
) -> Option<TimedMotion> {
    // No extent of a rounding exceeds the longest leg.
    let most = path.path().segments().map(|(a, b)| (b - a).norm()).fold(0.0, f64::max).min(greatest);
    let blended = blend(scene, path, greatest, scene.workspace().clearance);
    let mut curve = blended.curve().clone();
    let rounding = Rounding::new(scene, blended.straight(), scene.workspace().clearance);
    let mut smoothing = Smoothing::new(&curve, limits, period)?;
    let mut shares = vec![1.0; curve.radii().len()];
    let mut plain = None;
    for _ in 0..MAX_ROUNDS {
        let fastest = plain.as_ref().map_or(below, |plain: &TimedMotion| plain.trajectory.duration());
        // Slower corners do not make the motion faster.
        let smooth = smoothing.along(&curve, &shares).filter(|smooth| smooth.trajectory.duration() < fastest);
        let Some(smooth) = smooth else { return plain };
        let pieces = smooth.trajectory.pieces();
        if let Some(tip) = &mut smoothing.base.tip
            && let Some(excess) = limits.tip.and_then(|tip| tip.excess(&pieces))
        {
            tip.speed /= excess;
            continue;
        }
        if let Some(torque) = &mut smoothing.base.torque
            && let Some(excess) = limits.torque.and_then(|torque| torque.excess(&pieces))
        {
            torque.share /= excess;
            continue;
        }
        let open = rounding.uncertified_pieces(&pieces);
        let mut slower: BTreeSet<usize> = open.iter().filter_map(|&i| smooth.corner(&pieces[i])).collect();
        let mut radii = Vec::new();
        if slower.is_empty() {
            let is_passed = |w: usize| smooth.passed.iter().any(|(passed, _)| *passed == w);
            radii = extents(curve.path(), &pieces, is_passed);
            slower.extend((0..radii.len()).filter(|&w| radii[w] > most));
        }
        if slower.is_empty() {
            let certified = rounding.certified(radii, &pieces);
            let timed = certified.map(|curve| TimedMotion { curve, trajectory: smooth.trajectory });
            if smoothing.retimes == retimes || timed.is_none() {
                return timed.or(plain);
            }
            (plain, smoothing.retimes) = (timed, true);
        }
        for waypoint in slower {
            shares[waypoint] *= SLOWDOWN_FACTOR;
            if shares[waypoint] < MIN_SPEED_SHARE {
                curve = curve.with(waypoint, 0.0);
            }
        }
    }
    plain
}

impl<'a> Smoothing<'a> {
    /// Chooses the accelerations with which motions along this curve are fastest, and, if it helps, a pause between accelerations
    /// of opposite signs. Without the pause, the jerk must reverse the acceleration at once.
    fn new(curve: &BlendedPath, limits: Limits<'a>, period: f64) -> Option<Self> {
        let with = |share: f64, coasts: bool| {
            let acceleration = limits.acceleration.map(|a| a * share);
            let coast = if coasts { Limits { acceleration, ..limits }.longest_growth() } else { 0.0 };
            let base = Limits { acceleration, ..limits.without_jerks() };
            Self { limits, base, coast, period, retimes: false }
        };
        let ones = vec![1.0; curve.radii().len()];
        let takes = |smoothing: &Self| smoothing.along(curve, &ones).map(|smooth| smooth.trajectory.duration());
        let mut best: Option<(f64, Self)> = None;
        for coasts in [false, true] {
            let mut share = 1.0;
            while share > MIN_ACCELERATION_SHARE {
                let next = with(share, coasts);
                let Some(duration) = takes(&next).filter(|time| best.as_ref().is_none_or(|best| *time < best.0)) else {
                    break;
                };
                (best, share) = (Some((duration, next)), ACCELERATION_FACTOR * share);
            }
        }
        best.map(|(_, smoothing)| smoothing)
    }

    /// Returns the motion along a curve from rest to rest, which passes each corner at the given share of the corner's speed.
    /// Does not check obstacles.
    fn along(&self, curve: &BlendedPath, shares: &[f64]) -> Option<SmoothMotion> {
        let (used, runs) = schedule(curve, &self.base, shares, self.coast);
        let mut smooth = SmoothMotion { trajectory: Trajectory::default(), passed: Vec::new() };
        let stops: Vec<usize> = (0..shares.len()).filter(|&w| used.radii()[w] == 0.0).collect();
        let mut begin = 0;
        for (ends, run) in stops.windows(2).zip(&runs) {
            // Torques vary along a straight leg, and a constant limit that is safe everywhere would be slow.
            begin = if ends[1] - ends[0] == 1 && self.limits.torque.is_none() {
                stopping_at(&used, ends[0], &self.limits, begin, self.period, &mut smooth.trajectory)
            } else {
                self.run(run, ends[0], begin, &mut smooth)
            };
        }
        smooth.trajectory.push_rest(begin, curve.path().goal());
        Some(smooth)
    }

    /// Appends a run that passes the blends after a waypoint. Returns the time of its end.
    fn run(&self, run: &[TimedTrack], after: usize, begin: u64, smooth: &mut SmoothMotion) -> u64 {
        let mut spline = Spline::smoothed(run, self.base.acceleration, &self.limits, self.period);
        let delay = spline.delay();
        let limits = Limits { tip: self.base.tip, torque: self.base.torque, ..self.limits };
        let retimed = self.retimes.then(|| spline.retimed(&limits, self.period)).flatten();
        let when = retimed.map(|(faster, when)| {
            spline = faster;
            move |time: f64| when(seconds(delay) + time)
        });
        spline.sample(begin, self.period, &mut smooth.trajectory);
        let (mut since, mut waypoint) = (0.0, after);
        for (track, phases) in run {
            let until = since + phases.iter().map(|phase| phase.duration).sum::<f64>();
            if track.is_blend() {
                waypoint += 1;
                let passed = |time: f64| when.as_ref().map_or_else(|| delay + nanoseconds(time), |when| when(time));
                smooth.passed.push((waypoint, [since, until].map(|time| begin + passed(time))));
            }
            since = until;
        }
        begin + spline.duration()
    }
}

impl SmoothMotion {
    /// Returns the corner that the motion passes on a piece, or the nearest one in time.
    fn corner(&self, piece: &Piece) -> Option<usize> {
        let middle = piece.time(0.5);
        let away = |(_, [from, to]): &&(usize, [u64; 2])| (seconds(*from) - middle).max(middle - seconds(*to)).max(0.0);
        self.passed.iter().min_by(|a, b| away(a).total_cmp(&away(b))).map(|(waypoint, _)| *waypoint)
    }
}
