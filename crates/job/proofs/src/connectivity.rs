//! Decides by subdivision whether a path exists: finds one, or proves that there is none.

use super::boxes::{State, Subdivision};
use super::chain::{Mosaic, all_of_fewest_undecided, ends, fewest_undecided, shortest};
use super::channel::Channel;
use super::separating::separating;
use cplan_judge::{Cell, Disconnection};
use cplan_model::Scene;
use cplan_model::space::{Configuration, GoalSet};
use std::borrow::Cow;

/// The answer of [`connectivity`].
#[derive(Debug, Clone, PartialEq)]
pub enum Connectivity {
    /// There is no path: proven.
    Disconnected(Disconnection),
    /// A chain of free boxes from the start to a goal.
    Connected(Channel),
    /// Neither: the budget is spent, or halving does not help.
    Undecided {
        /// Number of boxes examined.
        boxes: usize,
        /// True if the search found that no path exists, but has no proof by boxes, because it would need too many boxes or
        /// because rounding prevents it.
        closed: bool,
    },
}

/// State of a box of configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occupancy {
    /// No pair comes too near anywhere in the box.
    Free,
    /// One pair of shapes is too near everywhere in the box.
    Colliding,
    /// Neither proven free nor proven in collision.
    Undecided,
}

/// An answer, and the boxes that led to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Exploration {
    /// The answer: a channel, a proof, or neither.
    pub answer: Connectivity,
    /// Boxes that cover the domain, side by side.
    pub boxes: Vec<(Cell, Occupancy)>,
    /// Number of pairs of boxes that share a side and are not both collision boxes.
    pub adjacencies: usize,
}

/// Decides whether there is a motion from `start` to one of `goals` whose distance from every obstacle is positive and at least
/// `clearance`. Examines at most `max_boxes` boxes.
///
/// Soft subdivision search (Wang, Chiang, Yap 2015): boxes are free, in collision, or undecided. If free boxes connect start and
/// goal, there is a path. If free and undecided boxes together do not connect them, there is none. Otherwise the search halves
/// the undecided boxes on a connection with the fewest of them.
///
/// The search is complete up to the resolution that `max_boxes` allows. It finds a path if there is enough free space around the
/// path. It proves that a passage is closed if shapes overlap deeply enough there.
pub fn connectivity(
    scene: &Scene,
    start: Configuration,
    goals: &GoalSet,
    clearance: f64,
    max_boxes: usize,
) -> Connectivity {
    proven(scene, |scene| decide(&mut Subdivision::new(scene, clearance), start, goals, max_boxes))
}

/// Decides among the outer shapes, which contain the exact ones: a path among them is valid. If there is none, decides among the
/// inner shapes, unless they are the same: a proof with them is valid.
pub(super) fn proven(scene: &Scene, decide: impl Fn(&Scene) -> Connectivity) -> Connectivity {
    match (decide(scene), scene.inner()) {
        (Connectivity::Disconnected(proof), Cow::Owned(inner)) => match decide(&inner) {
            Connectivity::Connected(_) => {
                Connectivity::Undecided { boxes: proof.collision_boxes().len(), closed: false }
            }
            answer => answer,
        },
        (answer, _) => answer,
    }
}

/// Answers the same question as [`connectivity`], and also returns the boxes.
pub fn explore(scene: &Scene, start: Configuration, goals: &GoalSet, clearance: f64, max_boxes: usize) -> Exploration {
    let mut boxes = Subdivision::new(scene, clearance);
    let answer = decide(&mut boxes, start, goals, max_boxes);
    let known = |state: &State| match state {
        State::Free => Some(Occupancy::Free),
        State::Colliding(_) | State::Beyond => Some(Occupancy::Colliding),
        State::Undecided(_) | State::Finest => Some(Occupancy::Undecided),
        State::Split(_) => None,
    };
    // Free and undecided boxes list each other as neighbours. An adjacency with a collision box is listed on one side only.
    let adjacencies = |node: &super::boxes::Node| -> usize {
        node.neighbors.iter().map(|&n| if boxes.nodes[n as usize].is_open() { 1 } else { 2 }).sum()
    };
    Exploration {
        answer,
        adjacencies: boxes.nodes.iter().map(adjacencies).sum::<usize>() / 2,
        boxes: boxes.nodes.iter().filter_map(|n| known(&n.state).map(|state| (n.cell, state))).collect(),
    }
}

/// From this number of boxes on, all chains with the fewest undecided boxes are refined at once. With fewer boxes, one chain is
/// refined at a time, because a search then costs less than the boxes that it saves. With more, a passage that is closed along a
/// curve would take quadratic time: a search for every few boxes.
const MIN_BATCH_BOXES: usize = 512;

fn decide(boxes: &mut Subdivision, start: Configuration, goals: &GoalSet, max_boxes: usize) -> Connectivity {
    loop {
        let ends = ends(boxes, goals);
        let Some(from) = boxes.locate(start) else { return disconnected(boxes, start, goals) };
        // Boxes of the finest size stay undecided. They prevent a proof only if there is no other connection.
        let chain = fewest_undecided(boxes, from, &ends, false).map(|chain| (chain, false));
        let Some((chain, finest)) =
            chain.or_else(|| fewest_undecided(boxes, from, &ends, true).map(|chain| (chain, true)))
        else {
            return disconnected(boxes, start, goals);
        };
        let state = |b: u32| &boxes.nodes[b as usize].state;
        if chain.iter().all(|&b| *state(b) == State::Free) {
            let chain = shortest(boxes, start, from, &ends);
            return Connectivity::Connected(Channel::new(boxes, &chain, start, &ends));
        }
        let chain = if boxes.nodes.len() < MIN_BATCH_BOXES {
            chain
        } else {
            all_of_fewest_undecided(boxes, from, &ends, finest)
        };
        let mixed: Vec<u32> = chain.into_iter().filter(|&b| matches!(state(b), State::Undecided(_))).collect();
        if mixed.is_empty() || boxes.nodes.len() > max_boxes {
            return Connectivity::Undecided { boxes: boxes.nodes.len(), closed: false };
        }
        for index in mixed {
            boxes.split(index);
        }
    }
}

fn disconnected(boxes: &Subdivision, start: Configuration, goals: &GoalSet) -> Connectivity {
    Connectivity::Disconnected(separating(boxes, start, goals))
}
