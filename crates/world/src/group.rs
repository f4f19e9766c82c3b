//! Steps as a world file has them: in groups within groups, with objects and supports found.

use super::object::Supports;
use cplan_core::model::Goal;
use cplan_geometry::{Interval, Point};
use std::collections::BTreeSet;
use std::ops::Range;

/// Steps that belong together.
pub(super) struct Group {
    pub body: Body,
    /// Number of repetitions.
    pub repeat: usize,
    /// Position in the file of the number of repetitions, or else of the group.
    pub at: Range<usize>,
    /// The objects that its steps pick and that are renewed.
    pub renewed: BTreeSet<usize>,
    /// The number of its steps, repetitions written out.
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

/// A step as written.
pub(super) struct Leaf {
    /// Number of the step in the file, from 1.
    pub number: usize,
    /// File, line and column.
    pub place: String,
    /// Position in the file of its target: the object's name, the point or the joint values.
    pub at: Range<usize>,
    pub action: LeafAction,
    pub speed: f64,
    pub dwell: f64,
}

/// The action of a step, as written.
pub(super) enum LeafAction {
    Pick { object: usize, grasp: Point, supports: Supports, when: Option<When> },
    Place { at: Point, angle: Option<(f64, Range<usize>)>, supports: Option<Supports> },
    Move(Goal),
}

/// Times at which a moving object may be picked.
pub(super) struct When {
    /// Times, in order; at least one.
    pub times: Vec<Interval>,
    /// Position in the file.
    pub at: Range<usize>,
}

impl Node {
    /// Returns the number of its steps, with repetitions written out.
    pub fn length(&self) -> usize {
        match self {
            Node::Step(_) => 1,
            Node::Group(group) => group.length,
        }
    }

    /// Returns its position in the file.
    pub fn at(&self) -> Range<usize> {
        match self {
            Node::Step(leaf) => leaf.at.clone(),
            Node::Group(group) => group.at.clone(),
        }
    }
}
