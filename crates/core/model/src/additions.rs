//! The optional contents of a scene: loose obstacles, an attachment, and allowed contacts.

use super::{Attachment, Obstacle};
use serde::{Deserialize, Serialize};

/// The optional contents of a scene, in addition to an arm and a workspace.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Additions {
    /// Obstacles without a place. Only methods that have `loose` in their names use them.
    pub loose: Vec<LooseObstacle>,
    /// Shapes that link 2 carries along. It may touch its supports: no clearance is kept between the two. Therefore
    /// every distance to a support is computed as if the support were farther away by the clearance.
    pub attachment: Option<Attachment>,
    /// Numbers of the obstacles that link 2's own parts may touch. Loose obstacles are numbered after the static
    /// ones.
    pub allowed_contacts: Vec<usize>,
}

/// An obstacle whose place the scene does not know. Planners, configuration spaces, paths and proofs ignore it. The
/// scene only lists the pairs of shapes that can meet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LooseObstacle {
    /// The obstacle, with its shape in its own frame.
    pub obstacle: Obstacle,
    /// Angle of the object's frame in the plane, radians. `None` if the angle differs between places.
    pub angle: Option<f64>,
}
