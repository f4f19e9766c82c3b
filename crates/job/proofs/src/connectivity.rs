//! Decides whether a path exists, by subdivision: finds a path, or proves that no path exists.

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
    /// Boxes did not decide: the budget was spent, or halving did not help.
    Undecided {
        /// Number of boxes examined.
        boxes: usize,
        /// True if the search found that no path exists, but has no proof by boxes. Either the proof needs too many
        /// boxes, or rounding prevents it.
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

/// Decides whether a motion exists from `start` to one of `goals` that keeps more than zero and at least `clearance`
/// from every obstacle. Examines at most `max_boxes` boxes.
///
/// Soft subdivision search (Wang, Chiang, Yap 2015): boxes are free, in collision, or undecided. If free boxes alone
/// connect start and goal, there is a path. If free and undecided boxes together do not connect them, there is no path.
/// Otherwise the search takes a connection with the fewest undecided boxes, and halves these.
///
/// The search is complete up to the resolution that `max_boxes` allows. It finds a path if there is free space around
/// it. It proves that a passage is closed if shapes overlap there by some depth.
pub fn connectivity(
    scene: &Scene,
    start: Configuration,
    goals: &GoalSet,
    clearance: f64,
    max_boxes: usize,
) -> Connectivity {
    proven(scene, |scene| decide(&mut Subdivision::new(scene, clearance), start, goals, max_boxes))
}

/// Decides first with the outer shapes, which contain the exact ones. A path among them is valid. If there is none,
/// decides again with the inner shapes, unless these are the same. A proof with them is valid.
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
    // Undecided and free boxes list each other as neighbours. Collision boxes are listed on one side only.
    let adjacencies = |node: &super::boxes::Node| -> usize {
        node.neighbors.iter().map(|&n| if boxes.nodes[n as usize].is_open() { 1 } else { 2 }).sum()
    };
    Exploration {
        answer,
        adjacencies: boxes.nodes.iter().map(adjacencies).sum::<usize>() / 2,
        boxes: boxes.nodes.iter().filter_map(|n| known(&n.state).map(|state| (n.cell, state))).collect(),
    }
}

/// Number of boxes from which all chains with the fewest undecided boxes are refined at once. With fewer boxes, one
/// chain is refined at a time, because a search is then cheap compared with the boxes that it saves. With more boxes, a
/// passage that is closed along a curve would take quadratic time, with a search for every few boxes along the curve.
const MIN_BATCH_BOXES: usize = 512;

fn decide(boxes: &mut Subdivision, start: Configuration, goals: &GoalSet, max_boxes: usize) -> Connectivity {
    loop {
        let ends = ends(boxes, goals);
        let Some(from) = boxes.locate(start) else { return disconnected(boxes, start, goals) };
        // Boxes of the finest size cannot be decided. They prevent a proof only if nothing else connects.
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
