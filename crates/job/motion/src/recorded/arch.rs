//! Strokes of the tool during motions of the arm.

use super::CollisionCheck;
use super::collision::{check_stroke, keeps_during_stroke};
use crate::{phase_at, single};
use cplan_handling::{ArchScene, HeldEffect, HeldJoint, HeldMotion, Recording, Stroke};
use cplan_model::space::Configuration;

/// Least time between samples at which a motion and a stroke are joined, seconds. A stroke changes its acceleration at most this
/// long after a sample, so it deviates from its profile by less than rounding errors.
pub(super) const MIN_GAP: f64 = 1e-7;

/// Number of halvings in the search for the time of a height. Only rounding errors remain.
const RISE_HALVINGS: u32 = 60;

/// A stroke that begins or ends during a motion of the arm.
#[derive(Debug, Clone)]
pub struct StrokeDuringMotion<'a> {
    /// The scenes during the motion.
    pub scene: &'a ArchScene,
    /// The stroke's joint, and its limits.
    pub stroke: &'a Stroke,
    /// Values of the joint at both ends, metres.
    pub ends: [f64; 2],
    /// Time at which the stroke begins, on the clock of the motion, seconds.
    pub begin: f64,
}

impl StrokeDuringMotion<'_> {
    /// Returns the whole stroke as a recording of its joint's value, on the clock of the arm's motion.
    fn profile(&self) -> Option<Recording> {
        let [from, to] = self.ends;
        let sign = (to - from).signum();
        let samples = single((to - from).abs(), &self.stroke.limits());
        let value = |x: f64| Configuration::new(x, 0.0);
        Recording::new(
            samples.iter().map(|[_, distance, _]| value(from + sign * distance)).collect(),
            Some(samples.iter().map(|[time, ..]| self.begin + time).collect()),
            Some(samples.iter().map(|[_, _, speed]| value(sign * speed)).collect()),
        )
        .ok()
    }

    /// Returns the part of a motion during the stroke, and the stroke's joint at the same samples. `None` if stroke and motion do
    /// not overlap.
    fn overlap(&self, motion: &Recording) -> Option<(Recording, HeldMotion)> {
        let profile = self.profile()?;
        let (of_arm, of_tool) = (motion.times()?, profile.times()?);
        let from = of_arm[0].max(of_tool[0]);
        let to = of_arm[of_arm.len() - 1].min(of_tool[of_tool.len() - 1]);
        if to - from < MIN_GAP {
            return None;
        }
        let times = times_between(of_arm.iter().chain(of_tool), [from, to]);
        let joint = &self.stroke.joint;
        let joint = HeldJoint {
            name: joint.name.clone(),
            value: joint.rest,
            effect: HeldEffect::Lifts { sign: joint.sign },
            bodies: self.stroke.bodies.clone(),
        };
        let values = profile.resampled(&times);
        Some((motion.resampled(&times), HeldMotion { joint, values, lifts_payload: self.scene.lifts_payload }))
    }

    /// Returns true if a quick search proves that the lowered parts keep at least `clearance` metres during the stroke, at their
    /// height of each moment, or if stroke and motion do not overlap. Does not check pairs of shapes that can also meet while the
    /// tool is raised, because their distances do not depend on the stroke.
    pub fn keeps(&self, motion: &Recording, clearance: f64) -> bool {
        self.overlap(motion).is_none_or(|(motion, held)| keeps_during_stroke(self.scene, &motion, &held, clearance))
    }

    /// Checks the same pairs of shapes as [`StrokeDuringMotion::keeps`]. `None` if stroke and motion do not overlap.
    pub fn check(&self, motion: &Recording) -> Option<CollisionCheck> {
        let (motion, held) = self.overlap(motion)?;
        Some(check_stroke(self.scene, &motion, &held, self.scene.raised.workspace().clearance))
    }
}

/// Returns both ends of a span and the times within it, ascending. Times that almost coincide count once.
pub(super) fn times_between<'a>(times: impl Iterator<Item = &'a f64>, [from, to]: [f64; 2]) -> Vec<f64> {
    let mut times: Vec<f64> = times.copied().filter(|time| from < *time && *time < to).collect();
    times.push(from);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|next, kept| *next - *kept < MIN_GAP);
    if times.len() > 1 && to - times[times.len() - 1] < MIN_GAP {
        times.pop();
    }
    times.push(to);
    times
}

/// Returns the time, in seconds, in which a stroke of length `depth` rises by `height` from its lowest position, both in metres.
/// Its last descent by `height` takes equally long. Returns the duration of the whole stroke if it is no longer than `height`.
pub fn seconds_to_rise(stroke: &Stroke, depth: f64, height: f64) -> f64 {
    let samples = single(depth.abs(), &stroke.limits());
    let end = samples.last().map_or(0.0, |[seconds, ..]| *seconds);
    let reached = samples.windows(2).find(|phase| phase[1][1] >= height);
    let Some(&[first @ [begin, distance, _], last @ [until, ..]]) = reached else { return end };
    if height <= distance {
        return begin;
    }
    // The distance grows all the time.
    let (mut low, mut high) = (begin, until);
    for _ in 0..RISE_HALVINGS {
        let middle = (low + high) / 2.0;
        if phase_at([first, last], middle)[0] < height { low = middle } else { high = middle }
    }
    high
}
