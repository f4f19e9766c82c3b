//! Serialized forms of scenes and problems. Reading goes through the constructors, which check the data.

use super::{
    Additions, Arm, Attachment, LooseObstacle, MotionProblem, MotionProblemError, Scene, SceneError, Workspace,
};
use crate::space::{Configuration, GoalSet};
use serde::{Deserialize, Serialize};

/// The serialized form of a [`Scene`].
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneRecord {
    /// The arm, without its attachment.
    arm: Arm,
    workspace: Workspace,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    loose: Vec<LooseObstacle>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    attachment: Option<Attachment>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    allowed_contacts: Vec<usize>,
}

impl From<Scene> for SceneRecord {
    fn from(scene: Scene) -> Self {
        let Additions { loose, attachment, allowed_contacts } = scene.additions().clone();
        let (arm, workspace) = scene.into_parts();
        Self { arm, workspace, loose, attachment, allowed_contacts }
    }
}

impl TryFrom<SceneRecord> for Scene {
    type Error = SceneError;

    fn try_from(record: SceneRecord) -> Result<Self, SceneError> {
        let SceneRecord { arm, mut workspace, mut loose, attachment, allowed_contacts } = record;
        workspace.restrict_shapes();
        loose.iter_mut().for_each(|loose| loose.obstacle.derive_shape_from_pieces());
        Self::with(arm, workspace, Additions { loose, attachment, allowed_contacts })
    }
}

/// The serialized form of a [`MotionProblem`].
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotionRecord {
    scene: Scene,
    start: Configuration,
    goals: GoalSet,
}

impl TryFrom<MotionRecord> for MotionProblem {
    type Error = MotionProblemError;

    fn try_from(MotionRecord { scene, start, goals }: MotionRecord) -> Result<Self, MotionProblemError> {
        Self::new(scene, start, goals)
    }
}
