//! Tasks: objects, and the steps to execute with them.

use super::{
    FollowedLine, MovingObstacle, ObstacleTrajectory, Payload, Stroke, TimedWorkspace, ToolLimits, ToolValues,
    WristJoint,
};
use cplan_geometry::{Convex, Interval, Point, Pose};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Elbow, Goal, Growth, Heights, Obstacle, Shape};
use cplan_text::{length, short};
use serde::{Deserialize, Serialize};

/// The rule for an object's orientation while it is carried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Holding {
    /// The object turns with link 2.
    Rigid,
    /// A wrist joint keeps the object's orientation. If a step requires another orientation, the wrist turns the object after the
    /// pick or before the place.
    Level,
}

/// The part of a task during which an object is in the workspace, if it is not there all the time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// The object leaves the workspace once it is placed.
    UntilPlaced,
    /// The object arrives at its initial pose before it is picked.
    FromPick,
}

/// A movable object. It is an obstacle while it lies somewhere, and a payload while the arm carries it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Name in the world file, unique among objects and obstacles.
    pub name: String,
    /// Shape as given, in its own frame.
    pub shape: Shape,
    /// The same shape as a union of convex pieces.
    pub pieces: Vec<Convex>,
    /// Extent along the plane's normal while it lies somewhere.
    pub heights: Heights,
    /// Distance by which the object is raised while it is carried, metres.
    pub lift: f64,
    /// The rule for the object's orientation while it is carried.
    pub holding: Holding,
    /// Initial pose.
    pub at: Pose,
    /// Motion from the initial pose until the object is picked; `None` if it lies still.
    #[serde(rename = "course", default, skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<ObstacleTrajectory>,
    /// Mass in kilograms.
    #[serde(default)]
    pub mass: f64,
    /// The part of the task during which the object can be an obstacle; `None` if always, as in all world files.
    #[serde(skip)]
    pub presence: Option<Presence>,
}

impl Object {
    /// Returns true if the object may rest on supports: a part of it must remain after all corners are moved inwards by the
    /// allowed penetration.
    pub fn can_rest(&self, arm: &Arm) -> bool {
        let by = Payload::penetration_allowance(arm);
        self.pieces.iter().any(|piece| piece.eroded(by).is_some())
    }
}

/// The place where an object lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Its pose in the plane.
    pub pose: Pose,
    /// Height by which the object is raised there above its own heights ([`Object::heights`]), metres.
    pub elevation: f64,
}

impl From<Pose> for Placement {
    /// Returns the placement at the object's own heights.
    fn from(pose: Pose) -> Self {
        Self { pose, elevation: 0.0 }
    }
}

/// The action of a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// The tip moves to an object and grasps it.
    Pick {
        /// The index of the object in the task.
        object: usize,
        /// The point of the object, in its own frame, to which the tip moves.
        grasp: Point,
        /// Indices in [`Task::obstacles`] of the obstacles on which the object rests. The object may touch them.
        supports: Vec<usize>,
        /// For a moving object: the times at which it may be picked, seconds, in order. Empty if any time is allowed.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        when: Vec<Interval>,
    },
    /// The origin of the carried object moves to a point, where the object is released.
    Place {
        /// Target of the object's origin.
        at: Point,
        /// The required orientation there, radians; `None` if any orientation is allowed.
        angle: Option<f64>,
        /// Indices in [`Task::obstacles`] of the obstacles on which the object comes to rest. The object may touch
        /// them.
        supports: Vec<usize>,
    },
    /// The arm moves to a goal, with or without an object.
    Move(Goal),
    /// The tip follows a line, with or without an object. The previous step ends where the line begins.
    Follow(FollowedLine),
}

/// A step: an action, and its speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// The action.
    pub action: Action,
    /// Number of the step in the world file, from 1. It is the same in each repetition.
    pub number: usize,
    /// Number of the step's repetition, from 1.
    pub cycle: usize,
    /// Position in the world file, for messages: `cell.toml:12:1`.
    pub place: String,
    /// Fraction of the joints' top speeds to use, greater than 0 and at most 1.
    pub speed: f64,
    /// Time that the arm rests at the end, seconds.
    pub dwell: f64,
    /// Values of the tool's joints at the end of a move. The tool stays lowered until the next motion.
    #[serde(default, skip_serializing_if = "ToolValues::is_default")]
    pub tool: ToolValues,
    /// Height by which the object is raised above its own heights where it is picked or placed, metres.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub elevation: f64,
    /// Side of the elbow at a pick or a place; `None` for either side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elbow: Option<Elbow>,
}

impl Step {
    /// Returns the side of the elbow that the step requires at its end; `None` for either side.
    pub fn required_elbow(&self) -> Option<Elbow> {
        match &self.action {
            Action::Pick { .. } | Action::Place { .. } => self.elbow,
            Action::Move(goal) => goal.elbow(),
            Action::Follow(line) => line.elbow,
        }
    }
}

/// Returns true for zero, which is omitted in files.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(elevation: &f64) -> bool {
    *elevation == 0.0
}

/// A part of a task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Item {
    /// A single step, which is executed at this point.
    Step(Step),
    /// Pairs of a pick and its place. The pairs may be executed in any order.
    AnyOrder(Vec<[Step; 2]>),
    /// New objects replace those with these indices, at their initial poses.
    Renew(Vec<usize>),
}

/// Limits of a wrist. All are positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wrist {
    /// Top speed, radians per second.
    pub velocity: f64,
    /// Greatest acceleration, radians per second squared.
    pub acceleration: f64,
    /// Greatest jerk of its turns, radians per second cubed. `None` if it is not limited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jerk: Option<f64>,
    /// True if the wrist may turn objects while the arm moves. If false, the arm is at rest during turns.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub turns_on_the_way: bool,
    /// The joint of the wrist. Lines that state an angle of the tool need it. `None` if the world does not name it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint: Option<WristJoint>,
}

impl Wrist {
    /// Returns the limits of its turns.
    pub fn limits(&self) -> ToolLimits {
        ToolLimits { velocity: self.velocity, acceleration: self.acceleration, jerk: self.jerk }
    }
}

/// A task of an arm. In a valid task, an object that is picked lies somewhere, each place follows a pick, and all indices of
/// objects and obstacles exist.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// The arm without a load.
    pub arm: Arm,
    /// The static obstacles and the moving obstacles of the world.
    pub workspace: TimedWorkspace,
    /// The objects that the arm can carry.
    pub objects: Vec<Object>,
    /// Start configuration, within the joint limits and free.
    pub start: Configuration,
    /// Values of the tool's joints at the start. A lowered tool is raised first.
    #[serde(default, skip_serializing_if = "ToolValues::is_default")]
    pub start_tool: ToolValues,
    /// The steps, with repetitions written out.
    pub items: Vec<Item>,
    /// The wrist, if it must turn objects.
    pub wrist: Option<Wrist>,
    /// The stroke that lowers the tool at picks and places, if there is one.
    pub stroke: Option<Stroke>,
}

impl Task {
    /// Returns true if a line of the task states an angle of the tool.
    pub fn turns_tool_along_lines(&self) -> bool {
        let asks = |step: &Step| matches!(&step.action, Action::Follow(line) if line.wrist.is_some());
        self.items.iter().any(|item| matches!(item, Item::Step(step) if asks(step)))
    }

    /// Returns the index of an object as an obstacle: objects follow the obstacles of the workspace.
    pub fn obstacle_number(&self, object: usize) -> usize {
        self.workspace.fixed.obstacles.len() + object
    }

    /// Returns the workspace with the objects at their poses as static obstacles. A carried object, which has no pose, becomes an
    /// obstacle without pieces, so that indices stay the same.
    pub fn obstacles(&self, poses: &[Option<Placement>]) -> TimedWorkspace {
        let mut workspace = self.workspace.clone();
        workspace
            .fixed
            .obstacles
            .extend(self.objects.iter().zip(poses).map(|(object, pose)| object.obstacle_at(pose.as_ref())));
        workspace
    }

    /// Does the same as [`Task::obstacles`], except that the objects `moving` are moving obstacles, after those of the world.
    pub fn surroundings(&self, poses: &[Option<Placement>], moving: &[usize]) -> TimedWorkspace {
        let mut workspace = self.obstacles(poses);
        workspace.movers.extend(moving.iter().filter_map(|&object| self.objects[object].moving()));
        workspace
    }

    /// Returns the trajectories of the moving obstacles of [`Task::surroundings`], on the clock of the task.
    pub fn trajectories(&self, moving: &[usize]) -> Vec<ObstacleTrajectory> {
        let objects = moving.iter().filter_map(|&object| self.objects[object].trajectory.clone());
        self.workspace.trajectories().into_iter().chain(objects).collect()
    }

    /// Returns the same trajectories on a clock that begins at the time `begin` of the task, seconds.
    pub fn trajectories_since(&self, moving: &[usize], begin: f64) -> Vec<ObstacleTrajectory> {
        self.trajectories(moving).iter().map(|trajectory| trajectory.since(begin)).collect()
    }

    /// Returns the trajectories of all moving obstacles and of the objects that move initially.
    pub fn initial_trajectories(&self) -> Vec<ObstacleTrajectory> {
        self.trajectories(&self.initially_moving().collect::<Vec<_>>())
    }

    /// Returns the index of an object as an obstacle while the objects `moving` move.
    pub fn obstacle_number_among(&self, moving: &[usize], object: usize) -> usize {
        let standing = self.obstacle_number(self.objects.len()) + self.workspace.movers.len();
        let place = moving.iter().position(|&other| other == object);
        place.map_or_else(|| self.obstacle_number(object), |place| standing + place)
    }

    /// Iterates over the objects that move initially, in order.
    pub fn initially_moving(&self) -> impl Iterator<Item = usize> {
        self.objects.iter().enumerate().filter(|(_, object)| object.trajectory.is_some()).map(|(number, _)| number)
    }

    /// Returns true if there are moving obstacles or moving objects.
    pub fn has_moving_obstacles(&self) -> bool {
        !self.workspace.movers.is_empty() || self.initially_moving().next().is_some()
    }

    /// Replaces the displayed shapes of obstacles and objects by the convex pieces that collision checks use. For deserialised
    /// tasks, in which the two may differ.
    pub fn restrict_shapes(&mut self) {
        self.workspace.restrict_shapes();
        self.objects.iter_mut().for_each(|object| object.shape.restrict_to(&object.pieces));
    }

    /// Returns the first step whose elevation would take the tool beyond the range of its joint, and the joint's value there.
    pub fn step_beyond_stroke(&self) -> Option<(&Step, f64)> {
        let stroke = self.stroke.as_ref()?;
        let mut held = None;
        self.steps().find_map(|step| {
            held = step.action.picked().or(held);
            let value = stroke.lowered(stroke.depth(&self.objects[held?]) - step.elevation);
            (step.elevation != 0.0 && !stroke.joint.range.contains(value)).then_some((step, value))
        })
    }

    /// Returns the angle by which the wrist's joint turns from the start to the end of a move, radians. `None` unless the
    /// move states a value.
    pub fn wrist_turn(&self, step: &Step) -> Option<f64> {
        step.tool.wrist_turn(&self.start_tool)
    }

    /// Iterates over all steps. Steps of a group in any order have the order of the file.
    pub fn steps(&self) -> impl Iterator<Item = &Step> {
        self.items.iter().flat_map(|item| match item {
            Item::Step(step) => vec![step],
            Item::AnyOrder(pairs) => pairs.iter().flatten().collect(),
            Item::Renew(_) => Vec::new(),
        })
    }
}

impl Object {
    /// Returns the object as an obstacle where it lies, or as an obstacle without pieces if it lies nowhere.
    pub fn obstacle_at(&self, placement: Option<&Placement>) -> Obstacle {
        let (shape, pieces) = match placement {
            Some(Placement { pose, .. }) => {
                (self.shape.at(pose), self.pieces.iter().map(|piece| piece.at(pose)).collect())
            }
            None => (Shape::Pieces, Vec::new()),
        };
        let heights = placement.map_or(self.heights, |placement| self.heights_at(placement.elevation));
        Obstacle { name: self.name.clone(), shape, pieces, heights, growth: Growth::default() }
    }

    /// Returns the initial placement of the object. `None` if the object moves initially, or arrives later.
    pub fn initial_static_pose(&self) -> Option<Placement> {
        let is_there = self.trajectory.is_none() && self.presence != Some(Presence::FromPick);
        is_there.then_some(self.at.into())
    }

    /// Returns the placement at which the object arrives before the pick. `None` if it does not arrive later.
    pub fn arrival(&self) -> Option<Placement> {
        (self.presence == Some(Presence::FromPick)).then_some(self.at.into())
    }

    /// Returns the placement of the object after a step has released it. Returns `None` if the object leaves the workspace.
    pub fn left_at(&self, placement: Placement) -> Option<Placement> {
        (self.presence != Some(Presence::UntilPlaced)).then_some(placement)
    }

    /// Returns the object's heights where it lies at an elevation, in metres.
    pub fn heights_at(&self, elevation: f64) -> Heights {
        self.heights.lifted([elevation; 2])
    }

    /// Returns the object as a moving obstacle. `None` if it does not move initially.
    pub fn moving(&self) -> Option<MovingObstacle> {
        let obstacle = || {
            let (shape, pieces) = (self.shape.clone(), self.pieces.clone());
            Obstacle { name: self.name.clone(), shape, pieces, heights: self.heights, growth: Growth::default() }
        };
        self.trajectory.clone().map(|trajectory| MovingObstacle { obstacle: obstacle(), trajectory })
    }

    /// Returns the range of all heights that the object takes while it is raised or lowered at these elevations, in metres.
    pub fn handled_heights(&self, elevations: impl IntoIterator<Item = f64>) -> Heights {
        let lying = elevations.into_iter().map(|elevation| self.heights_at(elevation));
        lying.fold(self.carried_heights(), Heights::and)
    }

    /// Returns the object's heights while it is carried.
    pub fn carried_heights(&self) -> Heights {
        Heights { lower: self.heights.lower + self.lift, upper: self.heights.upper + self.lift }
    }
}

impl Action {
    /// Returns the index of the object that is picked. `None` for other actions.
    pub fn picked(&self) -> Option<usize> {
        match self {
            Action::Pick { object, .. } => Some(*object),
            Action::Place { .. } | Action::Move(_) | Action::Follow(_) => None,
        }
    }

    /// Describes the action in a few words, such as `pick "part"`. Numbers have six digits.
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
            Action::Move(Goal::TipAndElbow(tip, elbow)) => {
                format!("move the tip to {} m with the elbow on the {}", point(tip.x, tip.y), elbow.name())
            }
            Action::Follow(line) => format!("follow a line of {}", length(line.path.length())),
            Action::Move(Goal::Area([low, high])) => {
                format!("move the tip into {} to {} m", point(low.x, low.y), point(high.x, high.y))
            }
        }
    }
}
