//! Links of the robot that its other links can hit.

use super::Obstacle;
use serde::{Deserialize, Serialize};

/// Carrier of a link that other links can hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Carrier {
    /// The robot's base: the link stands still.
    Base,
    /// Joint 1. Only link 2 and its payload can hit such a link, and that depends on joint 2 alone.
    FirstJoint,
}

/// A shape of a link of the robot, or one layer of it, that links further along the chain can hit.
///
/// A [`super::Scene`] numbers it after the obstacles of the workspace and those that move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SelfObstacle {
    /// What carries it.
    pub carrier: Carrier,
    /// One piece in plane coordinates, with both joints at zero; its name is that of the URDF link.
    pub obstacle: Obstacle,
    /// The number of its shape among those of the URDF link that have a size.
    pub number: usize,
    /// Whether that is `<visual>` geometry.
    pub is_visual: bool,
    /// URDF links that are free to meet it: its neighbours in the chain, and those that the world lets meet it.
    pub ignored: Vec<String>,
    /// URDF links that it meets in every configuration, which are free to meet it, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub permanent: Vec<String>,
}

impl SelfObstacle {
    /// Returns whether a URDF link is free to meet it.
    #[must_use]
    pub fn ignores(&self, link: &str) -> bool {
        self.ignored.iter().chain(&self.permanent).any(|ignored| ignored == link)
    }
}
