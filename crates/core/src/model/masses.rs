//! Masses and efforts of an arm: plain values, which the crate `dynamics` computes with.

use cplan_geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// A rigid body in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Kilograms.
    pub mass: f64,
    /// Centre of mass in the frame that the body belongs to.
    pub center: Point,
    /// Moment of inertia about the centre of mass and the plane's normal, kg m2.
    pub inertia: f64,
}

impl Body {
    /// A body without mass.
    pub const NONE: Self = Self { mass: 0.0, center: Point::new(0.0, 0.0), inertia: 0.0 };
}

/// Masses, gravity and the joints' efforts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dynamics {
    /// The bodies between a joint and the next, in the link's frame.
    pub bodies: [Body; 2],
    /// Acceleration of free fall in plane coordinates, m/s2.
    pub gravity: Vector,
    /// Greatest torque (N m) or force (N) of each joint.
    pub effort: [f64; 2],
    /// True for joints whose greatest acceleration is not given.
    pub assumed: [bool; 2],
    /// True if motions must keep within the efforts.
    pub limits: bool,
}
