//! Links of the robot that its other links can hit.

use super::Obstacle;
use serde::{Deserialize, Serialize};

/// The part of the robot that carries a link which other links can hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Carrier {
    /// The robot's base: the link is fixed.
    Base,
    /// Joint 1. Only link 2 and its attachment can hit such a link; whether they do depends on joint 2 alone.
    FirstJoint,
}

/// A shape of a link of the robot that links farther along the chain can hit. The shape may be cut into layers of
/// different heights; then each layer is a self obstacle.
///
/// A [`super::Scene`] numbers self obstacles after the static and the loose obstacles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SelfObstacle {
    /// The part of the robot that carries the shape.
    pub carrier: Carrier,
    /// The shape as an obstacle of one piece, in plane coordinates with both joints at zero. Its name is that of the
    /// URDF link.
    pub obstacle: Obstacle,
    /// Index of the shape among the shapes of the URDF link that have a size.
    pub number: usize,
    /// True if the shape is `<visual>` geometry.
    pub is_visual: bool,
    /// URDF links that are allowed to meet the shape: neighbours in the chain, and those that the world file allows.
    pub ignored: Vec<String>,
    /// Other URDF links that are allowed to meet the shape, because they meet it in every configuration.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub permanent: Vec<String>,
}

impl SelfObstacle {
    /// Returns true if a URDF link is allowed to meet the shape.
    #[must_use]
    pub fn ignores(&self, link: &str) -> bool {
        self.ignored.iter().chain(&self.permanent).any(|ignored| ignored == link)
    }
}
