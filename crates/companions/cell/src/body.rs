//! The bodies of an arm that can meet those of the other arm: links, a carried object, and objects at rest.

use cplan_geometry::{Convex, Point, Pose, Vector};
use cplan_judge::{Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Heights, Part, Scene};

/// The frame with which a body moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Frame {
    /// The frame of link 1 or 2, whose index is 0 or 1.
    Link(usize),
    /// The frame at the tip that never turns. A level payload moves with it.
    Tip,
    /// The frame of the cell. An object at rest does not move.
    Cell,
}

impl Frame {
    /// Returns the index of the frame in [`poses`].
    pub fn index(self) -> usize {
        match self {
            Self::Link(link) => link,
            Self::Tip => 2,
            Self::Cell => 3,
        }
    }
}

/// Returns the poses of all frames of an arm, by [`Frame::index`].
pub(crate) fn poses(arm: &Arm, at: Configuration) -> [Pose; 4] {
    let [one, two] = arm.poses(at);
    [one, two, Pose::translation(arm.tip_at(at)), Pose::identity()]
}

/// A convex body of an arm.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    /// The frame with which it moves.
    pub frame: Frame,
    /// Its shape in this frame, its heights and its name.
    pub part: Part,
    /// Greatest distance of a point of the body from the origin of its frame, metres.
    pub reach: f64,
    /// A disc around the shape, in its frame.
    pub disc: (Point, f64),
    /// True if the body belongs to an object. Otherwise it belongs to a link.
    pub is_object: bool,
    /// For an object that is being handed over: true if link 2 of the other arm may touch it.
    pub handover: Option<bool>,
    /// False if its shape or its heights are larger than the real ones, so that contacts prove no collision.
    pub is_exact: bool,
}

impl Body {
    /// Creates a part of a link, which is 0 or 1.
    pub fn of_link(link: usize, part: &Part, is_exact: bool) -> Self {
        Self { is_exact, ..Self::new(Frame::Link(link), part.clone()) }
    }

    /// Creates a piece of an object, with its shape in the frame.
    pub fn of_object(frame: Frame, name: &str, shape: Convex, heights: Heights, is_exact: bool) -> Self {
        let (body, number) = (name.to_owned(), 0);
        let part = Part { shape, inner: None, padding: 0.0, number, is_visual: false, heights, body };
        Self { is_object: true, is_exact, ..Self::new(frame, part) }
    }

    fn new(frame: Frame, part: Part) -> Self {
        let own = part.shape.reach_from(Point::zeros());
        let reach = part.inner.as_ref().map_or(own, |inner| inner.reach_from(Point::zeros()).max(own));
        Self { frame, reach, disc: disc_around(&part.shape), part, is_object: false, handover: None, is_exact: true }
    }

    /// Returns an upper bound on the motion of all points of the body for deviations from a posture, metres.
    pub fn farthest_motion(&self, scene: &Scene, posture: &Posture, deviation: Deviation) -> f64 {
        match self.frame {
            Frame::Link(link) => posture.farthest_motion_within(link, self.reach, deviation),
            Frame::Tip => posture.farthest_motion_within(1, scene.arm().tip.norm(), deviation),
            Frame::Cell => 0.0,
        }
    }

    /// Returns true if two bodies of different arms can meet because of their heights. An object may rest on another one,
    /// and grippers may touch the objects that they hand over.
    pub fn may_meet(&self, other: &Self, is_one_robot: bool) -> bool {
        let is_gripper = |body: &Self| !body.is_object && body.frame == Frame::Link(1);
        match (self.handover, other.handover) {
            (Some(_), Some(_)) => return false,
            (Some(true), None) if is_gripper(other) => return false,
            (None, Some(true)) if is_gripper(self) => return false,
            _ => {}
        }
        let (own, others) = (self.part.heights, other.part.heights);
        match (self.is_object, other.is_object) {
            (false, false) if is_one_robot => own.overlap(others),
            (true, true) => own.object_may_meet(others) && others.object_may_meet(own),
            _ => own.meet(others),
        }
    }

    /// Returns true if the heights of two bodies certainly overlap.
    pub fn surely_meets(&self, other: &Self) -> bool {
        let (own, others) = (self.part.heights, other.part.heights);
        let rests = |a: Heights, b: Heights| !a.object_definitely_meets(b);
        let is_rest = self.is_object && other.is_object && (rests(own, others) || rests(others, own));
        self.is_exact && other.is_exact && own.overlap(others) && !is_rest
    }
}

/// Returns a disc that contains a shape.
pub(crate) fn disc_around(shape: &Convex) -> (Point, f64) {
    let core = shape.core();
    let center = core.iter().sum::<Vector>() / core.len() as f64;
    (center, shape.reach_from(center))
}
