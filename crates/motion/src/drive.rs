//! From a certified path to a motion: corners and time.

use super::schedule::duration_bound;
use super::shape::ShapeSearch;
use super::smooth::smoothed;
use super::{Limits, TimedMotion, TimingError, TipSpeed, TorqueLimit, time};
use crate::{CertifiedCurve, blend};
use cplan_core::check::CertifiedPath;
use cplan_core::model::Scene;
use serde::{Deserialize, Serialize};
use std::cell::Cell;

/// The quantity to minimise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// The length of the path; the motion is the fastest along it.
    #[default]
    Length,
    /// The duration: candidate paths are compared by it, and the path gets the shape that makes the motion fast.
    Time,
}

/// Options for driving along a path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// The quantity to minimise.
    #[serde(default)]
    pub optimize: Objective,
    /// Time between two samples, seconds.
    pub period: f64,
    /// Greatest distance from a corner at which the motion may leave the path to round it, in joint space; 0 to stop at
    /// every corner, infinite to let the clearance and the path decide.
    #[serde(with = "cplan_text::number")]
    pub blend: f64,
    /// Greatest speed of the tip, metres per second; `None` to limit only the joints.
    pub tip_speed: Option<f64>,
    /// True to keep the joints within their efforts, even if the world does not ask for it.
    #[serde(default)]
    pub torque: bool,
}

impl Default for Drive {
    /// Returns options with a sample every hundredth of a second, corners blended as the clearance allows, and no limit
    /// of the tip.
    fn default() -> Self {
        Self { optimize: Objective::Length, period: 0.01, blend: f64::INFINITY, tip_speed: None, torque: false }
    }
}

impl Drive {
    /// Returns options with a stop at every corner, which are computed in a fraction of the time.
    #[must_use]
    pub fn stopping_at_corners(self) -> Self {
        Self { blend: 0.0, ..self }
    }

    /// Returns a motion along a path at this share of the joints' top speeds (more than 0, at most 1), within the
    /// scene's clearance: the fastest one by [`time`].
    ///
    /// With limits on jerks, corners are moved off obstacles by the distance that makes the motion fastest, because a
    /// smooth motion needs room there. If the duration is to be minimal ([`Drive::optimize`]), the whole path gets the
    /// fastest shape.
    ///
    /// # Errors
    /// A motion that is too long or has too many samples; joints whose efforts cannot hold the arm somewhere on the
    /// path.
    pub fn along(&self, scene: &Scene, path: &CertifiedPath, speed: f64) -> Result<TimedMotion, TimingError> {
        let tip = self.tip_speed.map(|speed| TipSpeed { arm: scene.arm(), speed });
        let torque = TorqueLimit::of(scene);
        if let Some(torque) = &torque {
            torque.check_holding_along(path.path())?;
        }
        let limits = Limits { tip, torque, ..Limits::from(&scene.arm().joints) }.scaled(speed);
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
                    return smoothed(scene, path, self.blend, limits, self.period, below, false);
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
                // An initially slower path may become faster once it is driven along its own curve in the least time.
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
        if let Some(torque) = torque {
            torque.check(&best.trajectory.pieces())?;
            best.trajectory.torque = torque.along(&best.trajectory);
        }
        Ok(best)
    }
}
