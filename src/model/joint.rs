//! One joint of the planar arm.

use crate::geometry::Vector;
use crate::space::Axis;

/// How a joint moves its link in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// Turns. `sign` is +1 when positive joint values turn counter-clockwise in plane coordinates, else -1.
    Revolute {
        /// +1 or -1.
        sign: f64,
    },
    /// Slides along this unit direction, given in plane coordinates at the zero configuration.
    Prismatic {
        /// Of unit length.
        direction: Vector,
    },
}

impl Motion {
    /// Whether the joint turns.
    #[must_use]
    pub fn is_revolute(self) -> bool {
        matches!(self, Motion::Revolute { .. })
    }
}

/// One joint: its motion, range and limits. Radians or metres, and seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Name in the URDF.
    pub name: String,
    /// How it moves.
    pub motion: Motion,
    /// The values it can take.
    pub axis: Axis,
    /// Top speed, per second; positive.
    pub velocity: f64,
    /// Greatest acceleration, per second squared; positive.
    pub acceleration: f64,
    /// Greatest jerk, per second cubed; positive. None: the acceleration may jump.
    pub jerk: Option<f64>,
}

impl Joint {
    /// Unit of the joint's value: `rad` or `m`.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        if self.motion.is_revolute() { "rad" } else { "m" }
    }
}
