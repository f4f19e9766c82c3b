//! What is to be done: objects, pallets and steps.

use cplan_check::decimal::Decimal;
use cplan_check::domain::Range;
use cplan_check::interval::{Interval, Point};
use cplan_check::polygon::Corner;
use cplan_check::world::Goal;

/// An object rests on what its lower end reaches into by no more than this, metres: `10^-6`.
pub const RESTING: u32 = 6;

/// What the steps of a world ask for.
pub struct Task {
    /// The first object's number among the world's obstacles; the others follow.
    pub first: usize,
    pub objects: Vec<Object>,
    pub steps: Group,
    pub wrist: Option<Wrist>,
    pub stroke: Option<Stroke>,
}

/// What holds for an object besides where it lies at first.
pub struct Object {
    /// Its name, without row and column on a pallet.
    pub(super) family: String,
    /// How much higher it is while it is carried.
    pub lift: Decimal,
    /// Whether a wrist keeps it level, or else it turns with the second link.
    pub is_level: bool,
    /// The point of it that the tip goes to.
    pub(super) grasp: Corner,
    /// What it may touch where it is picked and placed: obstacles by their numbers.
    pub supports: Vec<usize>,
    pub(super) renews: bool,
}

/// What keeps and turns level objects: which joint it is, if the world says it.
pub struct Wrist {
    pub joint: Option<String>,
}

/// A joint that lowers the tool, and how far; as far as objects are lifted if it does not say.
pub struct Stroke {
    pub joint: String,
    pub travel: Option<Decimal>,
}

/// Steps that belong together.
pub struct Group {
    pub nodes: Vec<Node>,
    pub repeat: usize,
    /// Whether its pairs of a pick and a place are done in any order.
    pub is_free: bool,
    /// Objects that lie where they lay at first again when it is repeated.
    pub renewed: Vec<usize>,
}

/// A step or a group.
pub enum Node {
    Step(Step),
    Group(Group),
}

/// A step of the file.
pub struct Step {
    /// From 1 in the order of the file.
    pub number: usize,
    pub action: Action,
    /// How long the arm stands still afterwards.
    pub dwell: Decimal,
}

/// When and where an object is to be picked that moves, as far as the step says.
#[derive(Default)]
pub struct Passing {
    /// Seconds after the task began.
    pub window: Option<Range>,
    /// Where its origin is then.
    pub at: Option<Point>,
}

/// What a step does.
pub enum Action {
    /// The tip goes to a point of an object, which hangs on it from then on.
    Pick {
        object: usize,
        grasp: Corner,
        supports: Vec<usize>,
        passing: Box<Passing>,
    },
    /// What is carried goes to a place with its origin, where it is let go of.
    Place {
        at: Point,
        angle: Option<Interval>,
        supports: Option<Vec<usize>>,
    },
    Move(Goal),
}

/// What holds from a pick to the place that follows.
pub struct Carrying {
    /// What the object may touch.
    pub supports: Vec<usize>,
    /// Whether the wrist may turn it: to the angle of the place.
    pub may_turn: bool,
}

impl Task {
    /// Of an object that is picked from supports, and placed by a step if that follows.
    pub fn carrying(&self, object: usize, supports: &[usize], placing: Option<&Step>) -> Carrying {
        let mut carrying = Carrying { supports: supports.to_vec(), may_turn: false };
        if let Some(Action::Place { angle, supports, .. }) = placing.map(|step| &step.action) {
            carrying.supports.extend(supports.as_ref().unwrap_or(&self.objects[object].supports));
            carrying.may_turn = self.wrist.is_some() && angle.is_some();
        }
        carrying
    }
}
