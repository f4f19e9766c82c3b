//! A world file's steps as nested groups. Objects and supports are given by their numbers.

use super::object::Supports;
use cplan_geometry::{Interval, Point};
use cplan_handling::{FollowedLine, ToolValues};
use cplan_model::{Elbow, Goal};
use std::collections::BTreeSet;
use std::ops::Range;

/// Steps that are repeated together.
pub(super) struct Group {
    pub body: Body,
    pub repeat: usize,
    /// Position in the file of the key `repeat`; the group's position if the key is missing.
    pub at: Range<usize>,
    /// The objects that steps of the group pick and that are new in each repetition.
    pub renewed: BTreeSet<usize>,
    /// Number of steps, with repetitions counted.
    pub length: usize,
}

/// Contents of a group.
pub(super) enum Body {
    /// Steps in the given order.
    InOrder(Vec<Node>),
    /// Pairs of a pick and a place, in any order.
    AnyOrder(Vec<[Leaf; 2]>),
}

/// A step or a group.
pub(super) enum Node {
    Step(Leaf),
    Group(Group),
}

/// A single step, as the file states it.
pub(super) struct Leaf {
    pub number: usize,
    /// File, line and column of the step, for messages.
    pub place: String,
    /// Position in the file of the step's target: an object's name, a point or joint values.
    pub at: Range<usize>,
    pub action: LeafAction,
    pub speed: f64,
    pub dwell: f64,
    pub tool: ToolValues,
    /// Side of the elbow at this pick or place.
    pub elbow: Option<Elbow>,
}

pub(super) enum LeafAction {
    Pick { object: usize, grasp: Point, supports: Supports, when: Option<When> },
    Place { at: Point, angle: Option<(f64, Range<usize>)>, supports: Option<Supports>, height: Option<f64> },
    Move(Goal),
    Follow(FollowedLine),
}

/// Times at which a moving object may be picked.
pub(super) struct When {
    /// Intervals of time in ascending order, in seconds; at least one.
    pub times: Vec<Interval>,
    /// Position of the key `when` in the file.
    pub at: Range<usize>,
}

impl Node {
    /// Returns the number of steps, with repetitions counted.
    pub fn length(&self) -> usize {
        match self {
            Node::Step(_) => 1,
            Node::Group(group) => group.length,
        }
    }

    /// Returns the position in the file.
    pub fn at(&self) -> Range<usize> {
        match self {
            Node::Step(leaf) => leaf.at.clone(),
            Node::Group(group) => group.at.clone(),
        }
    }
}
