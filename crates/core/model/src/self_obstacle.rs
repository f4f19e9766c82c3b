//! Links of the robot that its other links can hit.

use super::Obstacle;
use serde::{Deserialize, Serialize};

/// The part of the robot that carries a link which other links can hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Carrier {
    /// The robot's base: the link is fixed.
    Base,
    /// Joint 1. Only link 2 and its attachment can hit such a link. Joint 2 alone determines if they do.
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
    /// URDF links that may meet the shape, because the world file allows it.
    pub ignored: Vec<String>,
    /// For each link of the arm, the numbers of the parts that are proven to meet the shape in every configuration.
    /// Their contact is ignored. The judge proves it.
    #[serde(default, skip_serializing_if = "is_nowhere")]
    pub permanent: [Vec<usize>; 2],
}

fn is_nowhere(parts: &[Vec<usize>; 2]) -> bool {
    parts.iter().all(Vec::is_empty)
}

impl SelfObstacle {
    /// Returns true if the contact with a part of the arm is ignored. `link` is the part's link, `part` its number among
    /// the link's own parts, and `body` its URDF link.
    pub fn ignores(&self, link: usize, part: usize, body: &str) -> bool {
        self.permanent[link].contains(&part) || self.ignored.iter().any(|ignored| ignored == body)
    }
}
