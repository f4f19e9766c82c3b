//! The object that the arm carries.

use super::{Object, Stroke, Task, TimedWorkspace};
use cplan_core::model::{Additions, Arm, AttachedPart, Attachment, Body, Grip, Heights, Scene};
use cplan_dynamics::{joined, spread};
use cplan_geometry::{Convex, Pose, inset_union};

/// An object of a task while the arm carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct Payload {
    /// The index of the object in the task.
    pub object: usize,
    /// Connection with the arm.
    pub grip: Grip,
    /// Indices in [`Task::obstacles`] of the obstacles on which the object rests. The object may touch them, but must
    /// not press into them by more than [`Payload::penetration_allowance`].
    pub supports: Vec<usize>,
}

/// Depth to which a payload may press into its supports, as a share of the arm's reach. The depth is greater than the
/// rounding of coordinates in files, and less than the compliance of any gripper.
const PENETRATION_ALLOWANCE: f64 = 1e-4;

/// Fraction of the penetration allowance by which corners are moved inwards. It is a little less than 1, so that a
/// checker that moves corners by the whole allowance still accepts the motion.
const ALLOWANCE_SHARE: f64 = 1.0 - 1e-3;

impl Payload {
    /// Returns the greatest *penetration depth* of a payload in its supports, metres. Each corner of the payload is
    /// moved inwards by this distance, along the bisector of its sides, and the smaller shape must stay off the
    /// supports. So a side may press in by at most this distance times the sine of half the angle at its ends.
    #[must_use]
    pub fn penetration_allowance(arm: &Arm) -> f64 {
        PENETRATION_ALLOWANCE * arm.reach()
    }

    /// Returns the payload as an attachment of the arm, at these heights. The attachment has the object's pieces, and
    /// smaller pieces that must keep away from supports.
    #[must_use]
    pub fn attachment(&self, task: &Task, arm: &Arm, heights: Heights) -> Attachment {
        let Object { name, pieces, .. } = &task.objects[self.object];
        let part = |number: usize, shape: Convex, on_supports: bool| AttachedPart {
            shape,
            number,
            on_supports,
            is_never_empty: !pieces[number].is_sliver(),
        };
        let mut parts: Vec<AttachedPart> =
            pieces.iter().enumerate().map(|(number, piece)| part(number, piece.clone(), false)).collect();
        if !self.supports.is_empty() {
            let left = inset_union(pieces, ALLOWANCE_SHARE * Self::penetration_allowance(arm)).into_iter().enumerate();
            parts.extend(left.flat_map(|(number, left)| left.into_iter().map(move |shape| part(number, shape, true))));
        }
        Attachment { name: name.clone(), heights, grip: self.grip, parts, supports: self.supports.clone() }
    }

    /// Returns the body that the payload adds to link 2, in the link's frame. If a wrist keeps the payload level, the
    /// payload does not turn with the link, so its mass acts at the tip.
    fn body(&self, task: &Task, arm: &Arm) -> Body {
        let Object { mass, pieces, .. } = &task.objects[self.object];
        match self.grip {
            Grip::Rigid(in_link) => {
                let body = spread(*mass, pieces);
                Body { center: in_link.point(body.center), ..body }
            }
            Grip::Level { .. } => Body { mass: *mass, center: arm.tip, inertia: 0.0 },
        }
    }
}

impl Task {
    /// Returns the scene with the objects at their poses. The objects `moving` become loose obstacles, after those of
    /// the workspace, in the order of [`Task::trajectories`]. Link 2 may touch the objects `touched`.
    #[must_use]
    pub fn scene(
        &self,
        poses: &[Option<Pose>],
        moving: &[usize],
        payload: Option<&Payload>,
        touched: impl IntoIterator<Item = usize>,
    ) -> Scene {
        let allowed_contacts: Vec<usize> =
            touched.into_iter().map(|object| self.obstacle_number_among(moving, object)).collect();
        let payload = payload.map(|payload| (payload, self.objects[payload.object].carried_heights()));
        self.scene_of(self.arm.clone(), self.surroundings(poses, moving), payload, allowed_contacts)
    }

    /// Returns the scene while the tool is lowered to pick or place an object. Returns `None` if the tool is not
    /// lowered. Without a stroke, it is unknown how a placed object is lowered, so only its final pose is checked.
    #[must_use]
    pub fn lowered_scene(
        &self,
        object: usize,
        is_placed: bool,
        poses: &[Option<Pose>],
        payload: Option<&Payload>,
        touched: impl IntoIterator<Item = usize>,
    ) -> Option<Scene> {
        let lowered = &self.objects[object];
        let (arm, heights) = match &self.stroke {
            Some(stroke) => {
                let depth = Some(stroke.depth(lowered)).filter(|depth| *depth != 0.0)?;
                (stroke.swept(&self.arm, depth), lowered.handled_heights())
            }
            None if is_placed && lowered.lift != 0.0 => (self.arm.clone(), lowered.heights),
            None => return None,
        };
        let allowed_contacts: Vec<usize> = touched.into_iter().map(|object| self.obstacle_number(object)).collect();
        let payload = payload.map(|payload| (payload, heights));
        Some(self.scene_of(arm, self.obstacles(poses), payload, allowed_contacts))
    }

    /// Returns the scene for a stroke during a motion of the arm, with the tool raised. The second value is true if the
    /// payload follows the tool; otherwise it has all its heights from lying to carried. Link 2 may touch those of the
    /// objects `touched` that it meets with the raised tool, too: others must be free whenever the arm moves.
    #[must_use]
    pub fn arch_scene(
        &self,
        stroke: &Stroke,
        poses: &[Option<Pose>],
        payload: Option<&Payload>,
        touched: impl IntoIterator<Item = usize>,
    ) -> (Scene, bool) {
        let meets_raised = |object: &usize| {
            let heights = self.objects[*object].heights;
            self.arm.links[1].parts.iter().any(|part| part.heights.meet(heights))
        };
        let allowed_contacts = touched.into_iter().filter(meets_raised).map(|object| self.obstacle_number(object));
        let follows = |payload: &Payload| {
            let object = &self.objects[payload.object];
            stroke.depth(object) == object.lift
        };
        let follows = payload.is_none_or(follows);
        let payload = payload.map(|payload| {
            let object = &self.objects[payload.object];
            (payload, if follows { object.carried_heights() } else { object.handled_heights() })
        });
        let scene = self.scene_of(self.arm.clone(), self.obstacles(poses), payload, allowed_contacts.collect());
        (scene, follows)
    }

    /// Returns the scene of an arm with a payload at these heights.
    fn scene_of(
        &self,
        mut arm: Arm,
        workspace: TimedWorkspace,
        payload: Option<(&Payload, Heights)>,
        allowed_contacts: Vec<usize>,
    ) -> Scene {
        let attachment = payload.map(|(payload, heights)| payload.attachment(self, &arm, heights));
        if let (Some((payload, _)), Some(mut dynamics)) = (payload, arm.dynamics) {
            dynamics.bodies[1] = joined(&dynamics.bodies[1], &payload.body(self, &arm));
            arm.dynamics = Some(dynamics);
        }
        let (workspace, additions) = workspace.into_parts();
        Scene::with_trusted(arm, workspace, Additions { attachment, allowed_contacts, ..additions })
    }
}
