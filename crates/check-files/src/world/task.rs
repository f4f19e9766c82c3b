//! The content of a task: objects and steps.

use super::lines::WorldLine;
use cplan_check::decimal::Decimal;
use cplan_check::domain::Range;
use cplan_check::elbow::Elbow;
use cplan_check::interval::{Interval, Point};
use cplan_check::polygon::Corner;
use cplan_check::world::Goal;

/// Number of decimals of the tolerance of resting heights: `10^-6` m. An object rests on a support if it reaches into
/// the support by at most this.
pub const RESTING_DECIMALS: u32 = 6;

/// The task that the steps of a world describe.
pub struct Task {
    /// Index of the first object among the world's obstacles. The other objects follow it.
    pub first: usize,
    pub objects: Vec<Object>,
    pub steps: Group,
    pub wrist: Option<Wrist>,
    pub stroke: Option<Stroke>,
    /// True if the world has no steps. Then the only step is the move to the goal.
    pub is_move: bool,
    /// Values of the stroke's joint at the start and the goal, metres. `None` if the tool is raised there.
    pub lowered: [Option<Decimal>; 2],
}

/// Properties of an object beyond its initial pose.
pub struct Object {
    /// Name of the object, without its row and column on a pallet.
    pub(super) family: String,
    /// Distance by which the object is raised while it is carried, metres.
    pub lift: Decimal,
    /// True if a wrist keeps the object's orientation. If false, the object turns with the second link.
    pub is_level: bool,
    /// The point of the object to which the tip moves.
    pub(super) grasp: Corner,
    /// Numbers of the obstacles that the object may touch where it is picked and placed.
    pub supports: Vec<usize>,
    pub(super) renews: bool,
}

/// The wrist that keeps the orientation of level objects and turns them, with its joint if the world names one.
pub struct Wrist {
    pub joint: Option<String>,
    /// True if the wrist may turn objects while the arm moves.
    pub turns_on_the_way: bool,
}

/// The joint that lowers the tool, and the distance. If the distance is `None`, the tool is lowered by the distance by
/// which objects are lifted.
pub struct Stroke {
    pub joint: String,
    pub travel: Option<Decimal>,
    /// `None` if the arm must rest during strokes.
    pub arch: Option<Arch>,
}

/// Least heights of the tool above its lowest position while the arm moves, metres.
pub struct Arch {
    /// Least height at which the arm departs.
    pub rise: Decimal,
    /// Least height at which the arm arrives.
    pub fall: Decimal,
}

/// Steps that belong together.
pub struct Group {
    pub nodes: Vec<Node>,
    pub repeat: usize,
    /// True if its pairs of a pick and a place may be executed in any order.
    pub is_free: bool,
    /// Objects that return to their initial poses when the group is repeated.
    pub renewed: Vec<usize>,
}

impl Group {
    /// Makes a group of a single move, to a goal of the world or of the certificate.
    pub(super) fn single(goal: Option<Goal>) -> Self {
        let step =
            goal.map(|goal| Step { number: 1, action: Action::Move(goal), dwell: Decimal::whole(0), elbow: None });
        Self {
            nodes: step.map(|step| Node::Step(Box::new(step))).into_iter().collect(),
            repeat: 1,
            is_free: false,
            renewed: Vec::new(),
        }
    }
}

/// A step or a group.
pub enum Node {
    Step(Box<Step>),
    Group(Group),
}

/// A step of the file.
pub struct Step {
    /// Number of the step, from 1, in the order of the file.
    pub number: usize,
    pub action: Action,
    /// Time that the arm rests after the step, seconds.
    pub dwell: Decimal,
    /// Side of the elbow at a pick or a place. `None` if either side will do.
    pub elbow: Option<Elbow>,
}

/// Required time and place for the pick of a moving object. `None` for those that the step does not state.
#[derive(Default)]
pub struct MovingPick {
    /// Range of allowed times, seconds after the task began.
    pub window: Option<Range>,
    /// Required position of the object's origin at the time of the pick.
    pub at: Option<Point>,
}

/// The action of a step.
pub enum Action {
    /// The tip moves to a point of an object, to which it is then attached.
    Pick {
        object: usize,
        grasp: Corner,
        supports: Vec<usize>,
        passing: Box<MovingPick>,
    },
    /// The origin of the carried object moves to a position, where the object is released.
    Place {
        at: Point,
        angle: Option<Interval>,
        supports: Option<Vec<usize>>,
        /// Height of the object's bottom there, metres. `None` for the height at which the object was picked.
        height: Option<Decimal>,
    },
    Move(Goal),
    /// The tip moves to the beginning of the line of the next step.
    MoveToLine,
    /// The tip follows a line.
    Follow(WorldLine),
}

/// Rules that apply from a pick to the next place step.
#[derive(Clone)]
pub struct CarryRules {
    /// Obstacles that the object may touch.
    pub supports: Vec<usize>,
    /// True if the wrist may turn the object to the angle that the place step requires.
    pub may_turn: bool,
}

impl Task {
    /// Returns the distance by which the tool is lowered for an object. `None` if the robot has no stroke.
    pub fn depth(&self, object: usize) -> Option<&Decimal> {
        let stroke = self.stroke.as_ref()?;
        Some(stroke.travel.as_ref().unwrap_or(&self.objects[object].lift))
    }

    /// Returns the rules for an object that is picked from `supports`. `placing` is the step that places it, if there is one.
    pub fn carrying(&self, object: usize, supports: &[usize], placing: Option<&Step>) -> CarryRules {
        let mut carrying = CarryRules { supports: supports.to_vec(), may_turn: false };
        if let Some(Action::Place { angle, supports, .. }) = placing.map(|step| &step.action) {
            carrying.supports.extend(supports.as_ref().unwrap_or(&self.objects[object].supports));
            carrying.may_turn = self.wrist.is_some() && angle.is_some();
        }
        carrying
    }
}
