//! A tool that is lowered at picks and places, and a wrist that turns it.

use super::Object;
use cplan_core::model::{Arm, Heights, OutlineSource, check_range};
use cplan_core::space::JointRange;
use serde::{Deserialize, Serialize};

/// A joint of the tool: it moves along the plane's normal, or about it, and so changes nothing in the plane but what it carries.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToolJoint {
    /// Name in the URDF.
    pub name: String,
    /// Its value while nothing asks for another one, radians or metres.
    pub rest: f64,
    /// 1 if greater values are along the plane's normal (or counter-clockwise in the plane), else -1.
    pub sign: f64,
    /// The values that it can take.
    pub range: JointRange,
}

impl ToolJoint {
    /// Whether its numbers make sense: a sign, a range, and a rest within that.
    pub fn is_sound(&self) -> bool {
        self.sign.abs() == 1.0
            && self.rest.is_finite()
            && check_range(&self.name, self.range).is_ok()
            && self.range.contains(self.rest)
    }
}

/// How a tool is lowered and raised at picks and places, while the arm stands still.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stroke {
    /// The joint that does it; raised at rest.
    pub joint: ToolJoint,
    /// How far it is lowered against the plane's normal, metres; none: as far as the object is lifted.
    pub travel: Option<f64>,
    /// Top speed, m/s, positive.
    pub velocity: f64,
    /// Greatest acceleration, m/s2, positive.
    pub acceleration: f64,
    /// The URDF links that it moves.
    pub bodies: Vec<String>,
}

impl Stroke {
    /// How far the tool is lowered for an object, metres.
    #[must_use]
    pub fn depth(&self, object: &Object) -> f64 {
        self.travel.unwrap_or(object.lift)
    }

    /// Whether the joint can go as far down as an object asks for.
    #[must_use]
    pub fn reaches(&self, object: &Object) -> bool {
        self.joint.range.contains(self.lowered(self.depth(object)))
    }

    /// The joint's value with the tool lowered by so much.
    #[must_use]
    pub fn lowered(&self, depth: f64) -> f64 {
        self.joint.rest - self.joint.sign * depth
    }

    /// The arm with all that the stroke moves at all the heights that it takes there. A bar ends at the tip, and so is moved.
    #[must_use]
    pub fn swept(&self, arm: &Arm, depth: f64) -> Arm {
        let mut arm = arm.clone();
        let link = &mut arm.links[1];
        let bar = if link.source == OutlineSource::Bar { link.parts.len() - 1 } else { usize::MAX };
        let parts = link.parts.iter_mut().enumerate();
        for (_, part) in parts.filter(|(k, part)| *k == bar || self.bodies.contains(&part.body)) {
            let Heights { lower, upper } = part.heights;
            part.heights = Heights { lower: lower.min(lower - depth), upper: upper.max(upper - depth) };
        }
        arm
    }
}
