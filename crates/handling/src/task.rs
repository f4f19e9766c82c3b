//! A sequence of things to do.

use super::Stroke;
use cplan_core::model::{Arm, Course, Goal, Grip, Heights, Mover, Obstacle, Payload, Shape, Workspace};
use cplan_core::space::Configuration;
use cplan_geometry::{Convex, Interval, Point, Pose};
use cplan_text::short;
use serde::{Deserialize, Serialize};

/// What becomes of an object's orientation while the arm carries it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Holding {
    /// It turns with link 2.
    Rigid,
    /// A wrist joint keeps it; where a step asks for another orientation, the wrist turns it while the arm stands still.
    Level,
}

/// Something that can be moved: an obstacle while it lies somewhere, a payload while it is carried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// The user's name for it; no other object or obstacle has it.
    pub name: String,
    /// As given, in its own frame.
    pub shape: Shape,
    /// The same as a union of convex pieces.
    pub pieces: Vec<Convex>,
    /// Its extent along the plane's normal while it lies somewhere.
    pub heights: Heights,
    /// By how much it is raised while it is carried, metres.
    pub lift: f64,
    /// How it is held.
    pub holding: Holding,
    /// Where it lies at first.
    pub at: Pose,
    /// How it moves from there until it is picked, if it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub course: Option<Course>,
    /// Kilograms.
    #[serde(default)]
    pub mass: f64,
}

impl Object {
    /// Whether it may rest on supports: something of it lies deeper than what it may press into them.
    #[must_use]
    pub fn can_rest(&self, arm: &Arm) -> bool {
        let by = Payload::penetration_allowance(arm);
        self.pieces.iter().any(|piece| piece.eroded(by).is_some())
    }
}

/// What a step does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// The tip goes to an object and takes it.
    Pick {
        /// The number of the object in the task.
        object: usize,
        /// The point of the object, in its own frame, that the tip goes to.
        grasp: Point,
        /// What the object rests on, so that it may touch it: obstacles by their number in [`Task::obstacles`].
        supports: Vec<usize>,
        /// Of what moves, the times at which it may be picked, seconds: in order; none if any will do.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        when: Vec<Interval>,
    },
    /// The carried object's origin goes to a point, where the object is let go.
    Place {
        /// Where its origin goes.
        at: Point,
        /// The orientation that it must have there, radians; none if any will do.
        angle: Option<f64>,
        /// What it comes to rest on, so that it may touch it.
        supports: Vec<usize>,
    },
    /// The arm goes somewhere, with what it carries.
    Move(Goal),
}

/// A step: what to do, and how fast.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// What it does.
    pub action: Action,
    /// Its number in the world file, from 1; the same in each repetition.
    pub number: usize,
    /// Which repetition of it this is, from 1.
    pub cycle: usize,
    /// Where it stands in the world file, for messages: `cell.toml:12:1`.
    pub place: String,
    /// Share of the joints' top speeds to take on the way, more than 0 and at most 1.
    pub speed: f64,
    /// Seconds that the arm stands still at the end.
    pub dwell: f64,
}

/// Part of a task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Item {
    /// A step in its place in the order.
    Step(Step),
    /// Pairs of a pick and the place that follows it, in whichever order is fastest.
    AnyOrder(Vec<[Step; 2]>),
    /// These objects lie where they lay at first again: new ones have been supplied.
    Renew(Vec<usize>),
}

/// A wrist's limits; positive, radians and seconds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wrist {
    /// The top speed, radians a second.
    pub velocity: f64,
    /// The greatest acceleration, radians a second squared.
    pub acceleration: f64,
}

/// What a user asks of an arm over time. Objects that are picked lie somewhere, places follow picks, and numbers of
/// objects and obstacles are valid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// The arm, empty-handed.
    pub arm: Arm,
    /// What stays where it is.
    pub workspace: Workspace,
    /// What can be moved.
    pub objects: Vec<Object>,
    /// Where the arm is: within the joint limits and free.
    pub start: Configuration,
    /// What to do, repetitions written out.
    pub items: Vec<Item>,
    /// The wrist, if it has to turn objects.
    pub wrist: Option<Wrist>,
    /// How the tool is lowered at picks and places, if it is.
    pub stroke: Option<Stroke>,
}

impl Task {
    /// The arm, and the extent of an object in its hand, while the tool is lowered where that is picked or placed; none if it is not. Without
    /// a stroke what is placed is looked at where it is going to lie: how it gets there from where it is carried nobody says.
    pub fn lowered(&self, object: usize, is_placed: bool) -> Option<(Arm, Heights)> {
        let object = &self.objects[object];
        match &self.stroke {
            Some(stroke) => {
                let depth = Some(stroke.depth(object)).filter(|depth| *depth != 0.0)?;
                Some((stroke.swept(&self.arm, depth), object.handled_heights()))
            }
            None => (is_placed && object.lift != 0.0).then(|| (self.arm.clone(), object.heights)),
        }
    }

    /// The number under which object `object` counts as an obstacle: objects follow the workspace's own obstacles.
    #[must_use]
    pub fn obstacle_number(&self, object: usize) -> usize {
        self.workspace.obstacles.len() + object
    }

    /// The workspace with objects where they lie. One that lies nowhere, because it is carried, is an obstacle without
    /// pieces, so that numbers stay.
    #[must_use]
    pub fn obstacles(&self, poses: &[Option<Pose>]) -> Workspace {
        let mut workspace = self.workspace.clone();
        workspace.obstacles.extend(self.objects.iter().zip(poses).map(|(object, pose)| object.lying(pose.as_ref())));
        workspace
    }

    /// The same with what moves: these objects, on their courses, follow the workspace's own movers.
    #[must_use]
    pub fn surroundings(&self, poses: &[Option<Pose>], moving: &[usize]) -> Workspace {
        let mut workspace = self.obstacles(poses);
        workspace.movers.extend(moving.iter().filter_map(|&object| self.objects[object].moving()));
        workspace
    }

    /// The number under which object `object` counts as an obstacle while these objects move.
    #[must_use]
    pub fn number_among(&self, moving: &[usize], object: usize) -> usize {
        let standing = self.obstacle_number(self.objects.len()) + self.workspace.movers.len();
        let place = moving.iter().position(|&other| other == object);
        place.map_or_else(|| self.obstacle_number(object), |place| standing + place)
    }

    /// The objects that move at first, in order.
    pub fn moving_at_first(&self) -> impl Iterator<Item = usize> {
        self.objects.iter().enumerate().filter(|(_, object)| object.course.is_some()).map(|(number, _)| number)
    }

    /// Whether anything moves but the arm and what it carries.
    #[must_use]
    pub fn has_movers(&self) -> bool {
        !self.workspace.movers.is_empty() || self.moving_at_first().next().is_some()
    }

    /// Holds the shapes of obstacles and objects to what is judged: for what is read as data.
    pub fn hold_shapes(&mut self) {
        self.workspace.hold_shapes();
        self.objects.iter_mut().for_each(|object| object.shape.hold_to(&object.pieces));
    }

    /// All steps, those of a group in any order in the order of the file.
    pub fn steps(&self) -> impl Iterator<Item = &Step> {
        self.items.iter().flat_map(|item| match item {
            Item::Step(step) => vec![step],
            Item::AnyOrder(pairs) => pairs.iter().flatten().collect(),
            Item::Renew(_) => Vec::new(),
        })
    }
}

impl Object {
    /// The object as an obstacle that lies at `pose`; without one, an obstacle without pieces.
    #[must_use]
    pub fn lying(&self, pose: Option<&Pose>) -> Obstacle {
        let (shape, pieces) = match pose {
            Some(pose) => (self.shape.at(pose), self.pieces.iter().map(|piece| piece.at(pose)).collect()),
            None => (Shape::Pieces, Vec::new()),
        };
        Obstacle { name: self.name.clone(), shape, pieces, heights: self.heights }
    }

    /// Where it lies at first; none if it moves.
    #[must_use]
    pub fn standing_at_first(&self) -> Option<Pose> {
        self.course.is_none().then_some(self.at)
    }

    /// The object on its course, if it has one.
    #[must_use]
    pub fn moving(&self) -> Option<Mover> {
        let obstacle = || {
            let (shape, pieces) = (self.shape.clone(), self.pieces.clone());
            Obstacle { name: self.name.clone(), shape, pieces, heights: self.heights }
        };
        self.course.clone().map(|course| Mover { obstacle: obstacle(), course })
    }

    /// The object as a payload that may touch `supports`.
    #[must_use]
    pub fn carried(&self, grip: Grip, supports: Vec<usize>) -> Payload {
        let (object, pieces) = (self.name.clone(), self.pieces.clone());
        Payload { object, pieces, heights: self.carried_heights(), grip, mass: self.mass, supports }
    }

    /// Its extent along the plane's normal from where it lies to where it is carried.
    #[must_use]
    pub fn handled_heights(&self) -> Heights {
        let carried = self.carried_heights();
        Heights { lower: self.heights.lower.min(carried.lower), upper: self.heights.upper.max(carried.upper) }
    }

    /// Its extent along the plane's normal while it is carried.
    #[must_use]
    pub fn carried_heights(&self) -> Heights {
        Heights { lower: self.heights.lower + self.lift, upper: self.heights.upper + self.lift }
    }
}

impl Action {
    /// The object that is taken, if one is.
    #[must_use]
    pub fn picked(&self) -> Option<usize> {
        match self {
            Action::Pick { object, .. } => Some(*object),
            Action::Place { .. } | Action::Move(_) => None,
        }
    }

    /// In a few words: `pick "part"`. Numbers to six digits.
    #[must_use]
    pub fn describe(&self, objects: &[Object]) -> String {
        let point = |x: f64, y: f64| format!("({}, {})", short(x), short(y));
        match self {
            Action::Pick { object, .. } => format!("pick \"{}\"", objects[*object].name),
            Action::Place { at, angle: None, .. } => format!("place at {} m", point(at.x, at.y)),
            Action::Place { at, angle: Some(angle), .. } => {
                format!("place at {} m, turned to {} rad", point(at.x, at.y), short(*angle))
            }
            Action::Move(Goal::Joints(q)) => format!("move to joints {}", point(q[0], q[1])),
            Action::Move(Goal::Tip(tip)) => format!("move the tip to {} m", point(tip.x, tip.y)),
            Action::Move(Goal::Area([low, high])) => {
                format!("move the tip into {} to {} m", point(low.x, low.y), point(high.x, high.y))
            }
        }
    }
}
