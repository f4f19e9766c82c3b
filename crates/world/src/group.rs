//! Steps as a world file has them: in groups within groups, with objects and supports found.

use super::object::Supports;
use cplan_core::model::Goal;
use cplan_geometry::{Interval, Point};
use std::collections::BTreeSet;
use std::ops::Range;

/// Steps that belong together.
pub(super) struct Group {
    pub body: Body,
    /// How often they are done.
    pub repeat: usize,
    /// Where the number of repetitions, or else the group, stands.
    pub at: Range<usize>,
    /// The objects that its steps pick and that are renewed.
    pub renewed: BTreeSet<usize>,
    /// The number of its steps, repetitions written out.
    pub length: usize,
}

/// What a group does.
pub(super) enum Body {
    /// One after the other.
    InOrder(Vec<Node>),
    /// Pairs of a pick and a place, in any order.
    AnyOrder(Vec<[Leaf; 2]>),
}

/// A step or a group.
pub(super) enum Node {
    Step(Leaf),
    Group(Group),
}

/// A step as it is written.
pub(super) struct Leaf {
    /// From 1, in the order of the file.
    pub number: usize,
    /// File, line and column.
    pub place: String,
    /// Where its target stands: the object's name, the point or the joint values.
    pub at: Range<usize>,
    pub action: LeafAction,
    pub speed: f64,
    pub dwell: f64,
}

/// What a step does, as it is written.
pub(super) enum LeafAction {
    Pick { object: usize, grasp: Point, supports: Supports, when: Option<When> },
    Place { at: Point, angle: Option<(f64, Range<usize>)>, supports: Option<Supports> },
    Move(Goal),
}

/// When what moves may be picked.
pub(super) struct When {
    /// Times, in order; at least one.
    pub times: Vec<Interval>,
    /// Where that is said.
    pub at: Range<usize>,
}

impl Node {
    /// The number of its steps, repetitions written out.
    pub fn length(&self) -> usize {
        match self {
            Node::Step(_) => 1,
            Node::Group(group) => group.length,
        }
    }

    /// Where it stands.
    pub fn at(&self) -> Range<usize> {
        match self {
            Node::Step(leaf) => leaf.at.clone(),
            Node::Group(group) => group.at.clone(),
        }
    }
}
