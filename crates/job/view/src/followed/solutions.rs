//! The IK solutions along a line.

use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Arm, Scene, inverse};
use cplan_toolpath::Toolpath;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Number of places along the line at which the IK solutions are computed.
const PLACES: f64 = 400.0;

/// Joint values closer than this belong to the same IK solution, radians or metres.
const SAME_SOLUTION: f64 = 1e-3;

/// A value that exceeds a limit by at most this, radians or metres, is within it: such an excess is rounding.
const LIMIT_ROUNDING: f64 = 1e-9;

/// A part of the image of a line under one IK solution.
#[derive(Debug, Clone, PartialEq)]
pub struct SolutionPart {
    /// Number of the IK solution, 0 or 1.
    pub solution: usize,
    /// True if the arm cannot be there, because it is outside a joint's limits, in collision, or nearer than the clearance.
    pub is_excluded: bool,
    /// The configurations.
    pub points: Vec<Configuration>,
}

/// Returns the image of a line under each IK solution. It is divided where a solution becomes free or excluded, and where the
/// line is out of reach. The places are samples and prove nothing.
pub fn solutions(scene: &Scene, line: &Toolpath) -> Vec<SolutionPart> {
    let (places, arm) = (places(line), scene.arm());
    let mut parts: Vec<SolutionPart> = Vec::new();
    for solution in 0..2 {
        let mut last: Option<Configuration> = None;
        for &place in &places {
            let branches = inverse(arm, place.into(), last.unwrap_or_default()).branches;
            let Some(&q) = branches.get(solution) else {
                last = None;
                continue;
            };
            let q = near(arm, q, last);
            let is_excluded = !is_free(scene, q);
            let joins = last.is_some_and(|last| (0..2).all(|k| (q[k] - last[k]).abs() < FRAC_PI_2));
            match parts.last_mut() {
                Some(part) if joins && part.solution == solution => {
                    part.points.push(q);
                    if part.is_excluded != is_excluded {
                        parts.push(SolutionPart { solution, is_excluded, points: vec![q] });
                    }
                }
                _ => parts.push(SolutionPart { solution, is_excluded, points: vec![q] }),
            }
            last = Some(q);
        }
    }
    parts.retain(|part| part.points.len() > 1);
    parts
}

/// Returns the other IK solution for the tip's position in `q`, and true if it is excluded. `None` if there is no other.
pub fn other_solution(scene: &Scene, q: Configuration) -> Option<(Configuration, bool)> {
    let arm = scene.arm();
    let apart = |other: &Configuration| {
        let turned = |k: usize| 2.0 * ((other[k] - q[k]) / 2.0).sin();
        let joint = |k: usize| if arm.joints[k].joint_type.is_revolute() { turned(k) } else { other[k] - q[k] };
        joint(0).hypot(joint(1))
    };
    let branches = inverse(arm, arm.tip_at(q), q).branches;
    let other = branches.into_iter().max_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    let placed = near(arm, other, None);
    (apart(&other) > SAME_SOLUTION).then(|| (placed, !is_free(scene, placed)))
}

/// Returns points on the line, evenly spaced on each piece, with the ends of all pieces.
fn places(line: &Toolpath) -> Vec<[f64; 2]> {
    let step = line.length() / PLACES;
    let mut places = vec![line.start()];
    for piece in line.pieces() {
        let count = (piece.curve.length() / step).ceil().max(1.0) as u32;
        places.extend((1..=count).map(|k| piece.curve.at(f64::from(k) / f64::from(count))));
    }
    places
}

/// Adds whole turns to a configuration, so that it is near the configuration `last`, or without one near the middle of the
/// limits.
fn near(arm: &Arm, q: Configuration, last: Option<Configuration>) -> Configuration {
    Configuration::from_fn(|k, _| {
        let joint = &arm.joints[k];
        if !joint.joint_type.is_revolute() {
            return q[k];
        }
        let middle = match joint.range {
            JointRange::Circle => 0.0,
            JointRange::Interval { lower, upper } => (lower + upper) / 2.0,
        };
        let aim = last.map_or(middle, |last| last[k]);
        q[k] + ((aim - q[k]) / TAU).round() * TAU
    })
}

/// Returns true if the joints are within their limits, and the arm keeps the clearance.
fn is_free(scene: &Scene, q: Configuration) -> bool {
    let is_within = |k: usize| match scene.arm().joints[k].range {
        JointRange::Circle => true,
        JointRange::Interval { lower, upper } => (lower - LIMIT_ROUNDING..=upper + LIMIT_ROUNDING).contains(&q[k]),
    };
    let separation = scene.clearance(q);
    (0..2).all(is_within) && separation > 0.0 && separation >= scene.workspace().clearance
}
