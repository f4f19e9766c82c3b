//! The object that the arm carries.

use super::{Arm, Heights};
use crate::space::Configuration;
use cplan_geometry::{Convex, Point, Pose};
use serde::{Deserialize, Serialize};

/// The connection of an object with the arm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Grip {
    /// The object turns with link 2; its pose in link 2's frame.
    Rigid(Pose),
    /// A wrist keeps the object's orientation in the plane, at all joint values.
    Level {
        /// The orientation, radians.
        angle: f64,
        /// The point of the object, in its own frame, that stays at the tip.
        point: Point,
    },
}

impl Grip {
    /// Returns the pose of the object's frame in the plane at `q`.
    #[must_use]
    pub fn pose(&self, arm: &Arm, q: Configuration) -> Pose {
        match *self {
            Grip::Rigid(in_link) => arm.pose(1, q) * in_link,
            Grip::Level { angle, point } => Pose::rotation(angle).shifted(arm.tip_at(q)).shifted_in_frame(-point),
        }
    }
}

/// An object while the arm carries it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// The object's name.
    pub object: String,
    /// Outline as a union of convex pieces, in its own frame.
    pub pieces: Vec<Convex>,
    /// Extent along the plane's normal while it is carried.
    pub heights: Heights,
    /// Connection with the arm.
    pub grip: Grip,
    /// Mass in kilograms, spread evenly over the pieces.
    #[serde(default)]
    pub mass: f64,
    /// Obstacles on which it rests, by their number in the workspace. It may touch them, but must not press into them
    /// by more than [`Payload::penetration_allowance`].
    pub supports: Vec<usize>,
}

/// Depth to which a payload may press into its supports, as a share of the arm's reach. It is above the rounding of
/// coordinates that people write down, and below the compliance of any gripper.
const PENETRATION_ALLOWANCE: f64 = 1e-4;

impl Payload {
    /// Returns the greatest *penetration depth* of a payload in its supports, metres. Each corner of the payload is
    /// moved inwards by this distance, along the bisector of its sides, and the smaller shape must stay off the
    /// supports. So sides press in by at most this times the sine of half the angle at their ends.
    #[must_use]
    pub fn penetration_allowance(arm: &Arm) -> f64 {
        PENETRATION_ALLOWANCE * arm.reach()
    }

    /// Returns the pose of the object's frame in the plane at `q`.
    #[must_use]
    pub fn pose(&self, arm: &Arm, q: Configuration) -> Pose {
        self.grip.pose(arm, q)
    }

    /// Returns the grip of an object at `pose` with the arm at `q`, so that link 2 turns it.
    #[must_use]
    pub fn rigid_grip(arm: &Arm, q: Configuration, pose: &Pose) -> Grip {
        Grip::Rigid(arm.pose(1, q).inverse_pose(pose))
    }
}
