//! Something that the arm carries.

use super::{Arm, Heights};
use crate::space::Configuration;
use cplan_geometry::{Convex, Point, Pose};
use nalgebra::{Isometry2, Translation2};
use serde::{Deserialize, Serialize};

/// How an object hangs on the arm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Grip {
    /// It turns with link 2: its pose in link 2's frame.
    Rigid(Pose),
    /// A wrist keeps its orientation in the plane, whatever the joints do.
    Level {
        /// The orientation, radians.
        angle: f64,
        /// The point of the object, in its own frame, that stays at the tip.
        point: Point,
    },
}

impl Grip {
    /// Where what hangs so is at `q`: the pose of its frame in the plane.
    #[must_use]
    pub fn pose(&self, arm: &Arm, q: Configuration) -> Pose {
        match *self {
            Grip::Rigid(in_link) => arm.pose(1, q) * in_link,
            Grip::Level { angle, point } => {
                Translation2::from(arm.tip_at(q).coords)
                    * Isometry2::rotation(angle)
                    * Translation2::from(-point.coords)
            }
        }
    }
}

/// An object while the arm carries it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// The object's name.
    pub object: String,
    /// Its outline as a union of convex pieces, in its own frame.
    pub pieces: Vec<Convex>,
    /// Its extent along the plane's normal while it is carried.
    pub heights: Heights,
    /// How it is held.
    pub grip: Grip,
    /// Kilograms, spread evenly over the pieces.
    #[serde(default)]
    pub mass: f64,
    /// What it may touch, though not press into by more than [`Payload::penetration_allowance`]: what it rests on. Obstacles by their
    /// number in the workspace.
    pub supports: Vec<usize>,
}

/// Depth to which a payload may press into what supports it, as a share of the arm's reach: above the rounding of
/// coordinates that people write down, below what any gripper yields.
const PENETRATION_ALLOWANCE: f64 = 1e-4;

impl Payload {
    /// Greatest *penetration depth* of a payload in its supports, metres: by so much each corner of it is moved inwards, halfway between the
    /// sides there, and what is left stays off them. So sides press in by that times the sine of half the angle at their ends.
    #[must_use]
    pub fn penetration_allowance(arm: &Arm) -> f64 {
        PENETRATION_ALLOWANCE * arm.reach()
    }

    /// Where the object is at `q`: the pose of its frame in the plane.
    #[must_use]
    pub fn pose(&self, arm: &Arm, q: Configuration) -> Pose {
        self.grip.pose(arm, q)
    }

    /// The grip that holds an object lying at `pose` with the arm at `q`, so that link 2 turns it.
    #[must_use]
    pub fn rigid_grip(arm: &Arm, q: Configuration, pose: &Pose) -> Grip {
        Grip::Rigid(arm.pose(1, q).inv_mul(pose))
    }
}
