//! What a scene has beyond an arm and static obstacles.

use super::{Attachment, Obstacle};
use serde::{Deserialize, Serialize};

/// What a scene can have beyond an arm and a workspace.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Additions {
    /// Loose obstacles. Everything but the methods that name them ignores them.
    pub loose: Vec<LooseObstacle>,
    /// Shapes that link 2 carries along. No clearance is kept between them and their supports: in every distance, a
    /// support counts as farther away by the clearance.
    pub attachment: Option<Attachment>,
    /// Obstacles that link 2 itself is free to meet, by their number; loose obstacles are numbered after the static ones.
    pub allowed_contacts: Vec<usize>,
}

/// An obstacle without a place: only others know where it is. Planners, configuration spaces, paths and proofs ignore it;
/// a scene lists the pairs that can meet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LooseObstacle {
    /// Name, heights and shape, in its own frame.
    pub obstacle: Obstacle,
    /// Angle of that frame in the plane, radians, if it is the same at all its places.
    pub angle: Option<f64>,
}
