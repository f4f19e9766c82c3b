//! The outline of a link.

use super::Heights;
use crate::geometry::Convex;

/// Where a link's outline comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutlineSource {
    /// The URDF's `<collision>` geometry.
    Collision,
    /// The URDF's `<visual>` geometry, for want of collision geometry.
    Visual,
    /// A capsule between the joints, which the user asked for.
    Bar,
    /// Nothing: the link cannot collide.
    None,
}

/// One convex piece of a link's outline, in the link's frame: origin at the joint that carries the link, axes parallel
/// to the plane's at the zero configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Projection on the plane.
    pub shape: Convex,
    /// Extent along the plane's normal in the root frame.
    pub heights: Heights,
    /// The URDF link that the geometry belongs to.
    pub body: String,
}

/// Everything that one joint moves and the next does not, fixed children included.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// The URDF link that the joint carries.
    pub name: String,
    /// The outline: a union of convex parts.
    pub parts: Vec<Part>,
    /// Where the outline comes from.
    pub source: OutlineSource,
}
