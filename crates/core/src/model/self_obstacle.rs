//! Links of the robot that its other links can hit.

use super::Obstacle;
use serde::{Deserialize, Serialize};

/// Carrier of a link that other links can hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Carrier {
    /// The robot's base: the link is fixed.
    Base,
    /// Joint 1. Only link 2 and its attachment can hit such a link, and that depends on joint 2 alone.
    FirstJoint,
}

/// A shape of a link of the robot, or one layer of it, that links further along the chain can hit.
///
/// A [`super::Scene`] numbers it after the static and the loose obstacles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SelfObstacle {
    /// The joint that carries it.
    pub carrier: Carrier,
    /// One piece in plane coordinates, with both joints at zero; it has the name of the URDF link.
    pub obstacle: Obstacle,
    /// Number of its shape among those of the URDF link that have a size.
    pub number: usize,
    /// True if the outline is `<visual>` geometry.
    pub is_visual: bool,
    /// URDF links that are free to meet it: its neighbours in the chain, and those that the world allows to meet it.
    pub ignored: Vec<String>,
    /// URDF links that it meets in every configuration, which are free to meet it, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub permanent: Vec<String>,
}

impl SelfObstacle {
    /// Returns true if a URDF link is free to meet it.
    #[must_use]
    pub fn ignores(&self, link: &str) -> bool {
        self.ignored.iter().chain(&self.permanent).any(|ignored| ignored == link)
    }
}
