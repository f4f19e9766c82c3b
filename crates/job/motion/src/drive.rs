//! Creates a motion in time along a certified path, with rounded corners.

use super::limits::MAX_TORQUE_ROUNDS;
use super::rounded::rounded;
use super::schedule::duration_bound;
use super::shape::ShapeSearch;
use super::smooth::smoothed;
use super::{Limits, TimedMotion, TimingError, TipSpeed, TorqueLimit, WristLimit, time};
use crate::{CertifiedCurve, blend};
use cplan_judge::CertifiedPath;
use cplan_model::Scene;
use serde::{Deserialize, Serialize};
use std::cell::Cell;

/// The quantity to minimise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// The length of the path. The motion is the fastest one along the shortest path.
    #[default]
    Length,
    /// The duration of the motion. It decides between candidate paths, and corners of the path are moved if this makes the motion
    /// faster.
    Time,
}

/// Options for the motion along a path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// The quantity to minimise.
    #[serde(default)]
    pub optimize: Objective,
    /// Time between two samples, seconds.
    pub period: f64,
    /// Greatest distance from the nearest corner, in joint space, at which the motion is off the path. With 0, the motion stops
    /// at every corner. With infinity, only the clearance and the path limit it.
    #[serde(with = "cplan_text::number")]
    pub blend: f64,
    /// Greatest speed of the tip, metres per second; `None` to limit only the joints.
    pub tip_speed: Option<f64>,
    /// True if the torques must be within the joints' efforts, even if the world does not require it.
    #[serde(default)]
    pub torque: bool,
}

impl Default for Drive {
    /// Returns the default options: a sample every hundredth of a second, corners blended as far as the clearance
    /// allows, and no limit on the tip's speed.
    fn default() -> Self {
        Self { optimize: Objective::Length, period: 0.01, blend: f64::INFINITY, tip_speed: None, torque: false }
    }
}

impl Drive {
    /// Returns these options with a stop at every corner. Such motions are much faster to compute.
    #[must_use]
    pub fn stopping_at_corners(self) -> Self {
        Self { blend: 0.0, ..self }
    }

    /// Returns the fastest motion along a path, by [`time`]. `speed` is the share of the joints' top speeds to use, greater than
    /// 0 and at most 1. The motion keeps the scene's clearance.
    ///
    /// With limits on jerks, corners are moved away from obstacles, because a smooth motion needs room there; of several
    /// distances, the one with the fastest motion is used. To minimise the duration ([`Drive::optimize`]), the shape of the whole
    /// path is changed.
    ///
    /// # Errors
    /// A motion that would last too long or have too many samples, and a place on the path where the joints' efforts cannot hold
    /// the arm.
    pub fn along(&self, scene: &Scene, path: &CertifiedPath, speed: f64) -> Result<TimedMotion, TimingError> {
        let tip = self.tip_speed.map(|speed| TipSpeed::new(scene.arm(), speed));
        let torque = TorqueLimit::along_path(scene, path.path())?;
        let limits = Limits { tip, torque, ..Limits::from(scene.arm()) }.scaled(speed);
        let (is_smooth, has_corners) = (limits.stops_at_corners(), path.path().waypoints().len() > 2);
        let blended = |path: &CertifiedPath| {
            if self.blend > 0.0 && !is_smooth {
                blend(scene, path, self.blend, scene.workspace().clearance)
            } else {
                CertifiedCurve::from(path.clone())
            }
        };
        let mut best = time(blended(path), &limits, self.period)?;
        let is_shaped = has_corners || (is_smooth && torque.is_some());
        if is_shaped && self.blend > 0.0 && (is_smooth || self.optimize == Objective::Time) {
            let least = Cell::new(duration_bound(best.curve.curve(), &limits));
            let drive = |path: &CertifiedPath, below: f64| {
                if is_smooth {
                    return self.smooth(scene, path, limits, below);
                }
                let curve = blended(path);
                let rough = duration_bound(curve.curve(), &limits);
                let timed = (rough < least.get()).then(|| time(curve, &limits, self.period).ok()).flatten();
                let faster = timed.filter(|timed| timed.trajectory.duration() < below);
                faster.inspect(|_| least.set(rough))
            };
            let shaping = ShapeSearch::new(scene, drive);
            let mut found = Vec::new();
            if is_smooth {
                let mut lifted = best.clone();
                shaping.lifted(path, limits.reversal().min(self.blend), &mut lifted);
                found.push(lifted);
            }
            if self.optimize == Objective::Time {
                let (mut refined, most) = (best.clone(), limits.ramp().min(self.blend));
                shaping.lifted(path, most, &mut refined);
                shaping.refined(most, &mut refined);
                found.push(refined);
            }
            if is_smooth {
                // When it is driven along its own curve in the least time, a slower motion may become the faster one.
                let retimed = |timed: &TimedMotion| {
                    let path = timed.curve.straight();
                    smoothed(scene, path, self.blend, limits, self.period, f64::INFINITY, true)
                };
                let retimed: Vec<TimedMotion> = found.iter().filter_map(retimed).collect();
                found.extend(retimed);
            }
            let faster = |best: TimedMotion, other: TimedMotion| {
                if other.trajectory.duration() < best.trajectory.duration() { other } else { best }
            };
            best = found.into_iter().fold(best, faster);
        }
        with_torques(best, torque)
    }
}

impl Drive {
    /// Returns the fastest motion with limited jerks along a path, if it is shorter than `below` seconds.
    fn smooth(&self, scene: &Scene, path: &CertifiedPath, limits: Limits, below: f64) -> Option<TimedMotion> {
        let smooth = |below: f64| smoothed(scene, path, self.blend, limits, self.period, below, false);
        if self.blend.is_infinite() {
            return smooth(below);
        }
        let near = rounded(scene, path, self.blend, limits, self.period, below);
        smooth(near.as_ref().map_or(below, |near| near.trajectory.duration())).or(near)
    }
}

/// Options for the motion along a given curve.
#[derive(Clone, Copy)]
pub struct CurveDrive<'a> {
    /// Limit on the speed of the tip.
    pub tip: Option<TipSpeed<'a>>,
    /// Share of the joints' top speeds to use, above 0 and at most 1.
    pub share: f64,
    /// Time between two samples, seconds.
    pub period: f64,
    /// A wrist that turns along the curve, with its full limits, of which the motion uses the same share. `None` without a wrist.
    /// A motion with limited jerks ignores it.
    pub wrist: Option<WristLimit<'a>>,
}

/// Returns the fastest motion along a given curve, whose corners and blends do not change. With limits on jerks, the motion stops
/// at every corner; see [`super::along_joint_curve`].
///
/// # Errors
/// Same as for [`Drive::along`].
pub fn along_curve(
    scene: &Scene,
    curve: CertifiedCurve,
    CurveDrive { tip, share, period, wrist }: CurveDrive,
) -> Result<TimedMotion, TimingError> {
    let torque = TorqueLimit::along_path(scene, curve.straight().path())?;
    let limits = Limits { wrist, ..Limits::from(scene.arm()) }.scaled(share);
    let wrist = limits.wrist.filter(|_| !limits.stops_at_corners());
    let mut limits = Limits { tip, torque, wrist, ..limits };
    // On curved legs, torques are bounded only at the ends of spans.
    for _ in 0..MAX_TORQUE_ROUNDS {
        let timed = time(curve.clone(), &limits, period)?;
        let limit = limits.torque.as_mut().filter(|_| curve.curve().has_curved_leg());
        let excess = limit.as_ref().and_then(|limit| limit.excess(&timed.trajectory.pieces()));
        match limit.zip(excess) {
            Some((limit, excess)) => limit.share /= excess,
            None => return with_torques(timed, torque),
        }
    }
    with_torques(time(curve.without_curves(), &limits, period)?, torque)
}

/// Checks the torques of a motion, and adds them at its samples.
fn with_torques(mut timed: TimedMotion, limit: Option<TorqueLimit>) -> Result<TimedMotion, TimingError> {
    if let Some(limit) = limit {
        limit.check(&timed.trajectory.pieces())?;
        timed.trajectory.torque = limit.along_trajectory(&timed.trajectory);
    }
    Ok(timed)
}
