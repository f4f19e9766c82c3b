//! A stroke that lowers the tool at picks and places, and a wrist that turns it.

use super::Object;
use cplan_model::space::JointRange;
use cplan_model::{Arm, Heights, OutlineSource, check_range};
use serde::{Deserialize, Serialize};

/// A smaller displacement of a tool's joint, radians or metres, is due to rounding, and the joint does not move.
const ROUNDING: f64 = 1e-12;

/// A joint of the tool. It moves the tool along the plane's normal, or turns it about the normal, so within the plane it affects
/// only the load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToolJoint {
    /// Name in the URDF.
    pub name: String,
    /// Default value, radians or metres.
    pub rest: f64,
    /// 1 if greater values move along the plane's normal (or turn counter-clockwise in the plane); otherwise -1.
    pub sign: f64,
    /// Range of the joint's values, radians or metres.
    pub range: JointRange,
    /// Direction of the tip frame's x axis in the plane, radians, with the planned joints at zero and this joint at its default
    /// value. If that axis is parallel to the normal, the direction of the y axis. Only a wrist has one.
    #[serde(default)]
    pub direction: f64,
}

impl ToolJoint {
    /// Returns true if the sign is 1 or -1, the range is valid, and the default value is within the range.
    pub fn is_sound(&self) -> bool {
        self.sign.abs() == 1.0
            && self.rest.is_finite()
            && check_range(&self.name, self.range).is_ok()
            && self.range.contains(self.rest)
    }
}

/// Limits of a joint of the tool. All are positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolLimits {
    /// Top speed, rad/s or m/s.
    pub velocity: f64,
    /// Greatest acceleration, rad/s2 or m/s2.
    pub acceleration: f64,
    /// Greatest jerk, rad/s3 or m/s3. `None` if it is not limited.
    pub jerk: Option<f64>,
}

impl ToolLimits {
    /// Returns the least duration of a motion over a distance, from rest to rest, in seconds.
    pub fn least_seconds(&self, distance: f64) -> f64 {
        let Self { velocity, acceleration, jerk } = *self;
        let Some(jerk) = jerk else { return rest_to_rest(distance, velocity, acceleration) };
        // In each half, the acceleration grows for a time and shrinks for as long; it is constant in between. The speed is
        // constant between both halves. As the distance grows, the limits are reached one after the other.
        let grow = (velocity / jerk).sqrt().min(acceleration / jerk);
        let hold = (velocity / (jerk * grow) - grow).max(0.0);
        let speeding = 2.0 * grow + hold;
        if distance >= velocity * speeding {
            distance / velocity + speeding
        } else if distance <= 2.0 * jerk * grow.powi(3) {
            4.0 * (distance / (2.0 * jerk)).cbrt()
        } else {
            // With `h` between growing and shrinking, the distance is `j g (g + h) (2 g + h)`.
            let held = (grow * grow / 4.0 + distance / (jerk * grow)).sqrt() - 1.5 * grow;
            2.0 * (2.0 * grow + held)
        }
    }
}

/// Returns the duration of a motion over a distance, from rest to rest, in seconds. The joint accelerates constantly until it
/// reaches its top speed.
pub fn rest_to_rest(distance: f64, velocity: f64, acceleration: f64) -> f64 {
    if distance * acceleration <= velocity * velocity {
        2.0 * (distance / acceleration).sqrt()
    } else {
        distance / velocity + velocity / acceleration
    }
}

/// Values of the tool's joints at the beginning of a task or at the end of a move.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToolValues {
    /// Distance by which the tool is lowered against the plane's normal, metres. 0 if it is raised.
    #[serde(default)]
    pub depth: f64,
    /// Value of the wrist's joint, radians. `None` if it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wrist: Option<f64>,
}

impl ToolValues {
    /// Returns true if the tool is raised and the wrist's value is not given.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the distance by which the tool is lowered, metres. `None` if it is raised, up to rounding.
    pub fn lowered_by(&self) -> Option<f64> {
        Some(self.depth).filter(|depth| depth.abs() > ROUNDING)
    }

    /// Returns the signed angle from the wrist's value at the start to this one, radians; 0 if they differ only by rounding.
    /// `None` unless both are given.
    pub fn wrist_turn(&self, start: &Self) -> Option<f64> {
        let angle = self.wrist? - start.wrist?;
        Some(if angle.abs() > ROUNDING { angle } else { 0.0 })
    }
}

/// Heights of the tool, metres, from which its strokes may overlap with motions of the arm.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arch {
    /// Height above the lowest position to which the tool rises before the arm moves.
    pub rise: f64,
    /// Height above the lowest position. Below it, the tool goes down only while the arm is at rest.
    pub fall: f64,
}

impl Arch {
    /// Returns true if both heights are finite and not negative.
    pub fn is_valid(&self) -> bool {
        [self.rise, self.fall].into_iter().all(|height| height.is_finite() && height >= 0.0)
    }
}

/// The motion that lowers and raises a tool at picks and places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stroke {
    /// The joint that lowers the tool. It is raised at rest.
    pub joint: ToolJoint,
    /// Distance by which the tool is lowered against the plane's normal, metres. `None` if it is lowered by the lift of each
    /// object.
    pub travel: Option<f64>,
    /// Top speed, m/s, positive.
    pub velocity: f64,
    /// Greatest acceleration, m/s2, positive.
    pub acceleration: f64,
    /// Greatest jerk, m/s3, positive. `None` if it is not limited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jerk: Option<f64>,
    /// Names of the URDF links that the joint moves.
    pub bodies: Vec<String>,
    /// Heights from which strokes may overlap with motions of the arm. `None` if the arm is at rest during strokes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arch: Option<Arch>,
}

impl Stroke {
    /// Returns the limits of the stroke's joint.
    pub fn limits(&self) -> ToolLimits {
        ToolLimits { velocity: self.velocity, acceleration: self.acceleration, jerk: self.jerk }
    }

    /// Returns the distance by which the tool is lowered for an object, metres.
    pub fn depth(&self, object: &Object) -> f64 {
        self.travel.unwrap_or(object.lift)
    }

    /// Returns true if the joint can be lowered as far as an object requires.
    pub fn reaches(&self, object: &Object) -> bool {
        self.joint.range.contains(self.lowered(self.depth(object)))
    }

    /// Returns the joint's value with the tool lowered by a depth.
    pub fn lowered(&self, depth: f64) -> f64 {
        self.joint.rest - self.joint.sign * depth
    }

    /// Returns the distance by which the tool is lowered at a value of the joint, metres.
    pub fn depth_at(&self, value: f64) -> f64 {
        (self.joint.rest - value) * self.joint.sign
    }

    /// Returns the arm with taller shapes: each shape that the stroke moves has all heights that it takes during strokes to these
    /// depths, in metres. This includes a bar on link 2, because the bar ends at the tip.
    pub fn swept(&self, arm: &Arm, depths: &[f64]) -> Arm {
        let lowest = depths.iter().copied().fold(0.0, f64::max);
        let highest = depths.iter().copied().fold(0.0, f64::min);
        let mut arm = arm.clone();
        let link = &mut arm.links[1];
        let bar = if link.source == OutlineSource::Bar { link.parts.len() - 1 } else { usize::MAX };
        let parts = link.parts.iter_mut().enumerate();
        for (_, part) in parts.filter(|(k, part)| *k == bar || self.bodies.contains(&part.body)) {
            let Heights { lower, upper } = part.heights;
            part.heights = Heights { lower: lower - lowest, upper: upper - highest };
        }
        arm
    }
}
