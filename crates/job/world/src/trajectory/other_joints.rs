//! Recorded joints other than the arm's two.

use super::samples::{Names, Samples, Series, misplaced};
use cplan_handling::{HeldEffect, HeldJoint, HeldMotion, Interpolation, Recording, RecordingError};
use cplan_model::space::Configuration;
use cplan_model::{OutlineSource, Scene};
use cplan_robot::{Diagnostic, Source};

/// A joint that the world keeps fixed counts as still within this distance of its value, in radians or metres. It exceeds a
/// controller's jitter and the rounding to six digits, and is too small to cause a collision.
const HELD_TOLERANCE: f64 = 1e-4;

/// Returns the reason why motions of fixed joints cannot be checked in a scene. `None` if they can.
pub(super) fn rigid(scene: &Scene) -> Option<&'static str> {
    if scene.attachment().is_some() {
        return Some("would move the object that the tool carries");
    }
    let has_bar = scene.arm().links.iter().any(|link| link.source == OutlineSource::Bar);
    has_bar.then_some("a bar replaces a link")
}

impl Names<'_> {
    /// Returns the motions of held joints that move, and adds notes about other joints. If the motion of a joint cannot be judged
    /// during the steps of a task, adds the reason to `unjudged`.
    ///
    /// # Errors
    /// Joints whose motion cannot be checked.
    pub(super) fn moved(
        &self,
        source: &Source,
        samples: &Samples,
        recording: &Recording,
        notes: &mut Vec<String>,
        unjudged: &mut Vec<String>,
    ) -> Result<Vec<HeldMotion>, Diagnostic> {
        let mut moved: Vec<HeldMotion> = Vec::new();
        let given = samples.joints.iter().map(|series| (series, true));
        for (series, at_samples) in given.chain(samples.other_series.iter().map(|series| (series, false))) {
            let name = &series.name;
            let Some(joint) = self.held.iter().find(|joint| joint.name == *name) else {
                notes.push(format!("joint \"{name}\" is ignored: the arm does not depend on it"));
                continue;
            };
            let moves = |value: &f64| value.is_nan() || (value - joint.value).abs() > HELD_TOLERANCE;
            let Some(sample) = series.position.iter().position(moves) else {
                notes.push(format!("joint \"{name}\" stays at {}, as in the world, and is ignored", joint.value));
                continue;
            };
            if let Some(why) = self.unjudgeable_reason(joint, at_samples, &moved) {
                if self.has_steps {
                    notes.push(format!("the arm is judged with joint \"{name}\" at {}", joint.value));
                    unjudged.push(format!("joint \"{name}\" moves during the steps, but it {why}"));
                    continue;
                }
                let value = series.position[sample];
                let message =
                    format!("joint \"{name}\" is at {value}, but at {} in the world, and it {why}", joint.value);
                let help = format!(
                    "if the joint does not move from this value, write [robot] fixed = {{ {name} = {value} }} in the world file; a motion of this joint cannot be judged"
                );
                return Err(samples.diagnostic(source, sample, &message).help(help));
            }
            notes.push(describe_motion(joint, series));
            let values = values(series, recording, samples).map_err(|error| misplaced(source, samples, &error))?;
            moved.push(HeldMotion { joint: joint.clone(), values, lifts_payload: false });
        }
        Ok(moved)
    }

    /// Returns the reason, as a clause, why the motion of a joint cannot be checked. `None` if it can.
    fn unjudgeable_reason(&self, joint: &HeldJoint, at_samples: bool, moved: &[HeldMotion]) -> Option<String> {
        let turns = |joint: &HeldJoint| matches!(joint.effect, HeldEffect::Turns { .. });
        let also_turns = |other: &&HeldMotion| {
            turns(&other.joint) && other.joint.bodies.iter().any(|body| joint.bodies.contains(body))
        };
        match &joint.effect {
            HeldEffect::Unjudged { why } => Some(why.clone()),
            _ if !at_samples => Some("has samples at other times than the arm's joints".into()),
            HeldEffect::Turns { .. } => {
                moved.iter().find(also_turns).map(|other| format!("turns together with joint \"{}\"", other.joint.name))
            }
            HeldEffect::Lifts { .. } => None,
        }
        .or_else(|| self.rigid.map(|why| format!("cannot move where {why}")))
    }
}

/// Describes how a joint moves.
fn describe_motion(joint: &HeldJoint, series: &Series) -> String {
    let least = series.position.iter().copied().fold(f64::INFINITY, f64::min);
    let most = series.position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let name = &joint.name;
    match joint.effect {
        HeldEffect::Turns { .. } => format!(
            "joint \"{name}\" turns between {least} and {most} rad: the parts that it turns are judged at their angle at each moment; limits of the joint are not judged"
        ),
        _ => format!(
            "joint \"{name}\" slides between {least} and {most} m: the parts that it carries are judged at their height at each moment; limits of the joint are not judged"
        ),
    }
}

/// Returns the motion of a single joint: its values at the samples, interpolated like the recording.
pub(super) fn values(series: &Series, recording: &Recording, samples: &Samples) -> Result<Recording, RecordingError> {
    let single = |values: &Vec<f64>| values.iter().map(|value| Configuration::new(*value, 0.0)).collect::<Vec<_>>();
    let velocity = series.velocity.as_ref().filter(|_| recording.velocities().is_some());
    let rule = recording.interpolation();
    let joins = matches!(rule, Interpolation::Quartic | Interpolation::Quintic);
    let acceleration = series.acceleration.as_ref().filter(|_| joins && velocity.is_some());
    let values =
        Recording::new(single(&series.position), recording.times().map(<[f64]>::to_vec), velocity.map(single))?;
    let values = match acceleration {
        Some(acceleration) => values.accelerated(single(acceleration), rule)?,
        None => values,
    };
    Ok(values.resting_after(&samples.rests))
}
