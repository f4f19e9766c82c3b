//! Motions with limits on jerks along given smooth curves in joint space.
//!
//! In contrast to `smooth`, the curve is known before the motion, so its distance from obstacles can be checked first. `retime`
//! finds the fastest motion along it, which is sampled as a uniform cubic B-spline in time. With the step `h`, this spline
//! deviates inwards by `h^2 / 6` times the acceleration, so `h` is halved until the motion is near enough to the curve.

use super::clock::NANOSECONDS_PER_SECOND;
use super::extent::extents;
use super::limits::Limits;
use super::retime::Rate;
use super::sample::{TimedMotion, Trajectory};
use super::spline::Spline;
use super::{CurveDrive, Rounding, TorqueLimit};
use cplan_handling::Piece;
use cplan_interrupt::checkpoint;
use cplan_judge::CertifiedPath;
use cplan_model::Scene;
use cplan_model::space::Configuration;

/// Least number of intervals of the rate along a curve. If the curve has fewer pieces, each has several intervals.
const MIN_INTERVALS: usize = 192;

/// A motion that exceeds limits between the positions at which they are imposed is slowed down by up to this factor. If it needs
/// more, intervals are divided further.
const MAX_SLOWDOWN: f64 = 1.003;

/// Least average number of intervals in the time in which an acceleration grows to its limit. With fewer, intervals are divided
/// further.
const INTERVALS_PER_GROWTH: f64 = 12.0;

/// Greatest number of parts into which intervals are divided further.
const MAX_FINER: f64 = 4.0;

/// Number of divisions into intervals that are tried.
const MAX_DIVISIONS: usize = 2;

/// Greatest number of steps of a motion.
const MAX_STEPS: f64 = 1e6;

/// A smooth curve in joint space: a uniform cubic B-spline. Its second derivative is continuous.
#[derive(Debug, Clone, PartialEq)]
pub struct JointCurve {
    spline: Spline,
}

impl JointCurve {
    /// Creates the curve from the first to the last of at least two points. The other points are control points, so the curve
    /// stays in the hull of all points. At both ends, its first two derivatives are zero, so that motions can begin and end there
    /// at rest.
    ///
    /// # Panics
    /// If there are fewer than two points.
    pub fn new(points: &[Configuration]) -> Self {
        assert!(points.len() > 1, "a curve needs two points");
        Self { spline: Spline::of_curve(points) }
    }

    /// Returns the pieces of the curve, each of which is one unit of its parameter long. For `n` points, there are `n + 1`
    /// pieces. Piece `i` is near the points `i - 1` and `i`.
    pub fn pieces(&self) -> Vec<Piece> {
        self.spline.pieces()
    }
}

/// Returns the fastest motion found along a curve, from rest to rest, within the limits on jerks. `path` is a certified path near
/// the curve. Joint limits are not checked, because the motion stays in the hull of the curve's points. `too_far` returns the
/// indices of those pieces of a motion that are too far from the curve.
///
/// Returns `None` if no motion is certified and near enough. Linear in the numbers of the curve's points and of samples.
pub fn along_joint_curve(
    scene: &Scene,
    path: &CertifiedPath,
    curve: &JointCurve,
    drive: CurveDrive,
    too_far: &dyn Fn(&[Piece]) -> Vec<usize>,
) -> Option<TimedMotion> {
    let torque = TorqueLimit::along_path(scene, path.path()).ok()?;
    let own = Limits::from(scene.arm()).scaled(drive.share);
    let limits = Limits { tip: drive.tip, torque, ..own };
    let mut trajectory = limits.within_torque(|limits| {
        let spline = motion(&curve.spline, limits, drive.period, too_far)?;
        let mut trajectory = Trajectory::default();
        spline.sample(0, drive.period, &mut trajectory);
        trajectory.push_rest(spline.duration(), path.path().goal());
        Some(trajectory)
    })?;
    let pieces = trajectory.pieces();
    if !too_far(&pieces).is_empty() {
        return None;
    }
    let last = path.path().waypoints().len() - 1;
    let radii = extents(path.path(), &pieces, |w| 0 < w && w < last);
    let curve = Rounding::new(scene, path, scene.workspace().clearance).certified(radii, &pieces)?;
    if let Some(torque) = torque {
        trajectory.torque = torque.along_trajectory(&trajectory);
    }
    Some(TimedMotion { curve, trajectory })
}

/// Returns the fastest motion along a curve that is near enough to it, within all limits except those on torques. `None` if no
/// motion is near enough.
pub(super) fn motion(
    curve: &Spline,
    limits: &Limits,
    period: f64,
    too_far: &dyn Fn(&[Piece]) -> Vec<usize>,
) -> Option<Spline> {
    let pieces = curve.pieces().len();
    let mut parts = MIN_INTERVALS.div_ceil(pieces);
    let coarsest = limits.growths().fold(f64::INFINITY, f64::min) / INTERVALS_PER_GROWTH;
    let mut best: Option<Spline> = None;
    for _ in 0..MAX_DIVISIONS {
        let rate = Rate::fastest_of_all(&curve.conditions(limits, parts), 1.0 / parts as f64)?;
        let near = near_motion(curve, &rate, (rate.duration() / (parts * pieces) as f64).min(period), too_far)?;
        let excess = near.excess(limits);
        let (_, slower) = near.slowed(excess);
        let tip = limits.tip.and_then(|tip| tip.excess(&slower.pieces()));
        let (_, slower) = slower.slowed(tip.unwrap_or(1.0));
        if best.as_ref().is_none_or(|best| slower.duration() < best.duration()) {
            best = Some(slower);
        }
        let finer = rate.duration() / (coarsest * (parts * pieces) as f64);
        if excess <= MAX_SLOWDOWN && finer <= 1.0 {
            break;
        }
        parts *= finer.ceil().clamp(2.0, MAX_FINER) as usize;
    }
    best
}

/// Returns the motion along a curve at a rate. Its steps are the longest, up to `longest` seconds, for which all pieces are near
/// enough to the curve.
fn near_motion(curve: &Spline, rate: &Rate, longest: f64, too_far: &dyn Fn(&[Piece]) -> Vec<usize>) -> Option<Spline> {
    let mut count = (rate.duration() / longest).ceil();
    while count <= MAX_STEPS {
        checkpoint();
        let spline = curve.passed(rate, (rate.duration() / count * NANOSECONDS_PER_SECOND as f64).ceil() as u64);
        if too_far(&spline.pieces()).is_empty() {
            return Some(spline);
        }
        count *= 2.0;
    }
    None
}
