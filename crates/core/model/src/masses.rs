//! Masses and efforts of an arm: plain values, which the crate `dynamics` computes with.

use cplan_geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// A rigid body in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the frame that the body belongs to, metres.
    pub center: Point,
    /// Moment of inertia about the axis through the centre of mass along the plane's normal, kg m2.
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
    /// Mass and inertia of each link, in the link's frame.
    pub bodies: [Body; 2],
    /// Acceleration of free fall in plane coordinates, m/s2.
    pub gravity: Vector,
    /// Greatest torque (N m) or force (N) of each joint.
    pub effort: [f64; 2],
    /// True for each joint whose greatest acceleration is a default, because none is given.
    pub assumed: [bool; 2],
    /// True if motions must stay within `effort`.
    pub limits: bool,
}
