//! Shapes that link 2 carries along beyond its own parts.

use super::pairing::{ObstacleKind, PairPolicy};
use super::{Arm, Carrier, Heights, LooseObstacle, Obstacle, Part};
use crate::space::Configuration;
use cplan_geometry::{Convex, Point, Pose};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Shapes that link 2 carries in addition to its own parts, such as an object in a gripper. They may touch the
/// obstacles listed as supports, and need no clearance from them. Their mass counts as link 2's own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Name for messages.
    pub name: String,
    /// Extent along the plane's normal, metres.
    pub heights: Heights,
    /// Connection with link 2.
    pub grip: Grip,
    /// The shapes, in the attachment's own frame.
    pub parts: Vec<AttachedPart>,
    /// The supports, by their indices among the static obstacles.
    pub supports: Vec<usize>,
}

/// The connection of an attachment with link 2.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Grip {
    /// Fixed to link 2 and turning with it, at this pose in link 2's frame.
    Rigid(Pose),
    /// Kept at the same orientation in the plane, whatever the joint values.
    Level {
        /// The orientation, radians.
        angle: f64,
        /// The point of the attachment, in its own frame, that stays at the tip.
        point: Point,
    },
}

/// A shape of an [`Attachment`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AttachedPart {
    /// The shape, in the attachment's frame.
    pub shape: Convex,
    /// Index of the attachment's piece that this shape comes from.
    pub number: usize,
    /// True for a copy of a piece that is shrunk, so that it may press slightly into the supports. It can meet only the
    /// supports, without clearance. All other parts can meet all obstacles except the supports.
    pub on_supports: bool,
    /// False if the shape may be empty in exact arithmetic, so that its contacts prove no collision.
    #[serde(rename = "proves_collisions")]
    pub is_never_empty: bool,
}

/// For each obstacle of a scene, the range of its pieces that a part can meet.
pub(super) type MeetablePieces = Vec<Range<usize>>;

impl Grip {
    /// Returns the rigid grip that puts an attachment at `pose` with the arm at `q`.
    pub fn rigid(arm: &Arm, q: Configuration, pose: &Pose) -> Self {
        Self::Rigid(arm.pose(1, q).inverse_pose(pose))
    }

    /// Returns the pose of the attachment's frame in the plane at `q`.
    pub fn pose(&self, arm: &Arm, q: Configuration) -> Pose {
        match *self {
            Self::Rigid(in_link) => arm.pose(1, q) * in_link,
            Self::Level { .. } => self.frame().shifted(arm.tip_at(q)),
        }
    }

    /// Returns true if the attachment keeps its orientation.
    pub fn is_level(&self) -> bool {
        matches!(self, Self::Level { .. })
    }

    /// Returns the pose of the attachment in the frame that carries it: link 2's frame if rigid; if level, the frame
    /// at the tip with the plane's axes.
    fn frame(&self) -> Pose {
        match *self {
            Self::Rigid(in_link) => in_link,
            Self::Level { angle, point } => Pose::rotation(angle).shifted_in_frame(-point),
        }
    }
}

impl Attachment {
    /// Returns the attachment's pieces at full size, without the shrunk copies ([`AttachedPart::on_supports`]).
    pub fn pieces(&self) -> impl Iterator<Item = &Convex> {
        self.parts.iter().filter(|part| !part.on_supports).map(|part| &part.shape)
    }

    /// Returns the distance by which `part` may come nearer to an obstacle than the clearance, metres: the whole
    /// clearance for supports, otherwise zero. Returns `None` if the two cannot meet.
    pub fn nearer(&self, part: &AttachedPart, obstacle: usize, clearance: f64) -> Option<f64> {
        let meets = part.on_supports == self.supports.contains(&obstacle);
        meets.then_some(if part.on_supports { clearance } else { 0.0 })
    }

    /// Returns the attachment's parts as parts of link 2, each with the pieces that it can meet. Where pairs need
    /// shapes derived from the obstacles' pieces, appends these to `differences`.
    pub(super) fn on_link(
        &self,
        tip: Point,
        obstacles: &[(ObstacleKind, &Obstacle)],
        clearance: f64,
        policy: &PairPolicy,
        differences: &mut [Vec<Convex>],
    ) -> Vec<(Part, MeetablePieces)> {
        let counts = |part: &&AttachedPart| part.is_never_empty || !policy.is_definite();
        let is_level = self.grip.is_level();
        let on_link = |part: &AttachedPart| {
            let shape = if is_level { Convex::point(tip) } else { part.shape.at(&self.grip.frame()) };
            let (heights, body) = (self.heights, self.name.clone());
            let on_link =
                Part { shape, inner: None, padding: 0.0, number: part.number, is_visual: false, heights, body };
            (on_link, self.meetable(part, obstacles, clearance, policy, differences))
        };
        self.parts.iter().filter(counts).map(on_link).collect()
    }

    /// Returns the pieces that `part` can meet, for each obstacle. Level parts, and supports with a clearance, use
    /// shapes derived from the obstacle's own pieces, numbered after these.
    fn meetable(
        &self,
        part: &AttachedPart,
        obstacles: &[(ObstacleKind, &Obstacle)],
        clearance: f64,
        policy: &PairPolicy,
        differences: &mut [Vec<Convex>],
    ) -> MeetablePieces {
        let level = self.grip.is_level().then(|| part.shape.at(&self.grip.frame()));
        let of = |(number, &(kind, obstacle)): (usize, &(ObstacleKind, &Obstacle))| {
            let own = obstacle.pieces.len();
            // Joint 1 turns an obstacle that it carries relative to a level part, by an angle that is unknown here.
            // So a disc covers the part, and contacts of the disc prove no collision.
            let is_folding = matches!(kind, ObstacleKind::Own(own) if own.carrier == Carrier::FirstJoint);
            let is_turned = level.is_some() && is_folding;
            // A support has no clearance of its own either.
            let own_clearance = (obstacle.growth.clearance - clearance).max(0.0);
            let nearer = self.nearer(part, number, clearance + own_clearance);
            let Some(nearer) = nearer.filter(|_| !(is_turned && policy.is_definite())) else { return 0..0 };
            if level.is_none() && nearer == 0.0 {
                return 0..own;
            }
            // The pieces of a loose obstacle are in its own frame. With a level attachment, that frame never turns.
            let seen = level.as_ref().map(|level| match kind {
                _ if is_turned => all_round(level),
                ObstacleKind::Loose(LooseObstacle { angle, .. }) => {
                    level.at(&Pose::rotation(-angle.unwrap_or_default()))
                }
                ObstacleKind::Static | ObstacleKind::Own(_) => level.clone(),
            });
            let made = &mut differences[number];
            let first = own + made.len();
            made.extend(obstacle.pieces.iter().map(|piece| match &seen {
                Some(level) => piece.with_distances_increased(nearer).minkowski_difference(level),
                None => piece.with_distances_increased(nearer),
            }));
            first..own + made.len()
        };
        obstacles.iter().enumerate().map(of).collect()
    }
}

/// Returns a disc about the tip that covers a level attachment's shape at every angle of the link.
fn all_round(level: &Convex) -> Convex {
    Convex::trusted(vec![Point::zeros()], level.reach_from(Point::zeros()))
}
