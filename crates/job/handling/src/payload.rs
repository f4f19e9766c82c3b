//! The object that the arm carries.

use super::{Object, Placement, Stroke, Task, TimedWorkspace};
use cplan_dynamics::{joined, spread};
use cplan_geometry::{Convex, inset_union};
use cplan_model::{Additions, Arm, AttachedPart, Attachment, Body, Grip, Heights, Pair, Scene};
use std::collections::BTreeSet;

/// An object of a task while the arm carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct Payload {
    /// The index of the object in the task.
    pub object: usize,
    /// Connection with the arm.
    pub grip: Grip,
    /// Indices in [`Task::obstacles`] of the obstacles on which the object rests. The object may touch them, and press into them
    /// by at most [`Payload::penetration_allowance`].
    pub supports: Vec<usize>,
}

/// Depth to which a payload may press into its supports, as a share of the arm's reach. It exceeds the rounding of coordinates in
/// files, and is less than the compliance of any gripper.
const PENETRATION_ALLOWANCE: f64 = 1e-4;

/// Corners are moved inwards by this fraction of the penetration allowance. It is slightly less than 1, so that a checker that
/// moves corners by the whole allowance still accepts the motion.
const ALLOWANCE_SHARE: f64 = 1.0 - 1e-3;

impl Payload {
    /// Returns the greatest *penetration depth* of a payload in its supports, metres. Each corner of the payload is moved inwards
    /// by this distance, along the bisector of its sides, and the resulting smaller shape must not touch the supports. So a side
    /// may press in by at most this distance times the sine of half the angle at its ends.
    pub fn penetration_allowance(arm: &Arm) -> f64 {
        PENETRATION_ALLOWANCE * arm.reach()
    }

    /// Returns the payload as an attachment of the arm at these heights, with the object's pieces, and with smaller pieces that
    /// must not touch supports.
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

    /// Returns the body that the payload adds to link 2, in the link's frame. A wrist that keeps the payload level prevents it
    /// from turning with the link, so its mass then acts at the tip.
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

/// The scenes of an arm whose tool moves up or down while the arm moves.
#[derive(Debug, Clone)]
pub struct ArchScene {
    /// The scene with the tool raised.
    pub raised: Scene,
    /// The scene with all heights of the stroke. Parts and obstacles have the same numbers in both.
    pub swept: Scene,
    /// The pairs that can meet only if the tool is not raised. The distances of all other pairs do not depend on its height.
    pub lowered_pairs: Vec<Pair>,
    /// True if the payload moves up and down with the tool. If false, it has all heights from lying to carried in both scenes.
    pub lifts_payload: bool,
}

impl Task {
    /// Returns the scene with the objects at their poses. The objects `moving` become loose obstacles after those of the
    /// workspace, in the order of [`Task::trajectories`]. Link 2 may touch the objects `touched`.
    pub fn scene(
        &self,
        poses: &[Option<Placement>],
        moving: &[usize],
        payload: Option<&Payload>,
        touched: impl IntoIterator<Item = usize>,
    ) -> Scene {
        let allowed_contacts: Vec<usize> =
            touched.into_iter().map(|object| self.obstacle_number_among(moving, object)).collect();
        let payload = payload.map(|payload| (payload, self.objects[payload.object].carried_heights()));
        self.scene_of(self.arm.clone(), self.surroundings(poses, moving), payload, allowed_contacts)
    }

    /// Returns the scene while the tool is lowered to pick or place an object at an elevation, in metres. `None` if the tool is
    /// not lowered. Without a stroke, only the final pose of a placed object is checked.
    pub fn lowered_scene(
        &self,
        (object, elevation): (usize, f64),
        is_placed: bool,
        poses: &[Option<Placement>],
        payload: Option<&Payload>,
        touched: impl IntoIterator<Item = usize>,
    ) -> Option<Scene> {
        let lowered = &self.objects[object];
        let (arm, heights) = match &self.stroke {
            Some(stroke) => {
                let depth = Some(stroke.depth(lowered) - elevation).filter(|depth| *depth != 0.0)?;
                (stroke.swept(&self.arm, &[depth]), lowered.handled_heights([elevation]))
            }
            None if is_placed && lowered.lift != elevation => (self.arm.clone(), lowered.heights_at(elevation)),
            None => return None,
        };
        let allowed_contacts: Vec<usize> = touched.into_iter().map(|object| self.obstacle_number(object)).collect();
        let payload = payload.map(|payload| (payload, heights));
        Some(self.scene_of(arm, self.obstacles(poses), payload, allowed_contacts))
    }

    /// Returns the scene while the empty tool is between its raised position and a depth, in metres. `None` without a stroke.
    pub fn empty_lowered_scene(
        &self,
        depth: f64,
        poses: &[Option<Placement>],
        touched: impl IntoIterator<Item = usize>,
    ) -> Option<Scene> {
        let arm = self.stroke.as_ref()?.swept(&self.arm, &[depth]);
        let allowed_contacts: Vec<usize> = touched.into_iter().map(|object| self.obstacle_number(object)).collect();
        Some(self.scene_of(arm, self.obstacles(poses), None, allowed_contacts))
    }

    /// Returns the scenes for strokes to these depths, in metres, during a motion of the arm. Link 2 may touch those objects of
    /// `touched` that it also meets with the raised tool. It must not touch the others while the arm moves.
    pub fn arch_scene(
        &self,
        (stroke, depths): (&Stroke, &[f64]),
        poses: &[Option<Placement>],
        payload: Option<&Payload>,
        touched: impl IntoIterator<Item = usize>,
    ) -> ArchScene {
        let meets_raised = |object: &usize| {
            let heights = self.objects[*object].heights;
            self.arm.links[1].parts.iter().any(|part| part.heights.meet(heights))
        };
        let allowed: Vec<usize> =
            touched.into_iter().filter(meets_raised).map(|object| self.obstacle_number(object)).collect();
        let lifts_payload = payload.is_none_or(|payload| {
            let object = &self.objects[payload.object];
            stroke.depth(object) == object.lift
        });
        let obstacles = self.obstacles(poses);
        let scene = |arm: Arm, heights: &dyn Fn(&Object) -> Heights| {
            let payload = payload.map(|payload| (payload, heights(&self.objects[payload.object])));
            self.scene_of(arm, obstacles.clone(), payload, allowed.clone())
        };
        let handled = |object: &Object| {
            let own = stroke.depth(object);
            object.handled_heights(depths.iter().map(|depth| own - depth).chain([0.0]))
        };
        let swept = scene(stroke.swept(&self.arm, depths), &handled);
        let raised = scene(self.arm.clone(), &Object::carried_heights);
        let known: BTreeSet<Pair> = raised.pairs().iter().copied().collect();
        let lowered_pairs = swept.pairs().iter().copied().filter(|pair| !known.contains(pair)).collect();
        let raised = if lifts_payload { raised } else { scene(self.arm.clone(), &handled) };
        ArchScene { raised, swept, lowered_pairs, lifts_payload }
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
