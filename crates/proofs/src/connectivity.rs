//! Is there a path at all? Proof that there is none, or a path, by subdivision.

use super::boxes::{State, Subdivision};
use super::chain::{Mosaic, all_of_fewest_mixed, ends, fewest_mixed, shortest};
use super::channel::Channel;
use super::separating::separating;
use cplan_core::check::Cell;
use cplan_core::check::Disconnection;
use cplan_core::model::Scene;
use cplan_core::space::{Configuration, GoalSet};
use std::borrow::Cow;

/// The answer of [`connectivity`].
#[derive(Debug, Clone, PartialEq)]
pub enum Connectivity {
    /// There is no path: proven.
    Disconnected(Disconnection),
    /// A chain of free boxes from the start to a goal.
    Connected(Channel),
    /// Neither, when this many boxes were reached or could not be told apart any more.
    Undecided {
        /// Number of boxes looked at.
        boxes: usize,
        /// Whether nothing that may be open connects them, but boxes do not bear that out, or too many would.
        closed: bool,
    },
}

/// What is known about a box of configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occupancy {
    /// Nothing comes too near anywhere in it.
    Free,
    /// One pair of shapes is too near everywhere in it.
    Stuck,
    /// Neither proven free nor proven stuck.
    Mixed,
}

/// An answer, and the subdivision that led to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Exploration {
    /// A path, a proof, or neither.
    pub answer: Connectivity,
    /// Boxes that cover the domain, side by side.
    pub boxes: Vec<(Cell, Occupancy)>,
    /// Number of pairs of boxes that share a side and are not both stuck.
    pub adjacencies: usize,
}

/// Decides whether a motion that keeps more than zero and at least `clearance` from every obstacle leads from `start`
/// to one of `goals`, with at most `max_boxes` boxes.
///
/// Soft subdivision search (Wang, Chiang, Yap 2015): boxes are free, stuck or mixed. While free and mixed boxes together
/// connect start and goal, the mixed ones on the connection with the fewest of them are halved. If they do not connect,
/// there is no path; if free ones alone do, there is one. Complete up to the resolution that `max_boxes` allows: a path
/// with room around it is found, and a way that is closed by overlaps of some depth is proven closed.
#[must_use]
pub fn connectivity(
    scene: &Scene,
    start: Configuration,
    goals: &GoalSet,
    clearance: f64,
    max_boxes: usize,
) -> Connectivity {
    proven(scene, |scene| decide(&mut Subdivision::new(scene, clearance), start, goals, max_boxes))
}

/// The answer among shapes that cover what they stand for, which is as good as a path among these; that there is none is asked
/// again of the shapes within, where they differ.
pub(super) fn proven(scene: &Scene, decide: impl Fn(&Scene) -> Connectivity) -> Connectivity {
    match (decide(scene), scene.inner()) {
        (Connectivity::Disconnected(proof), Cow::Owned(inner)) => match decide(&inner) {
            Connectivity::Connected(_) => Connectivity::Undecided { boxes: proof.stuck().len(), closed: false },
            answer => answer,
        },
        (answer, _) => answer,
    }
}

/// As [`connectivity`], with the boxes.
#[must_use]
pub fn explore(scene: &Scene, start: Configuration, goals: &GoalSet, clearance: f64, max_boxes: usize) -> Exploration {
    let mut boxes = Subdivision::new(scene, clearance);
    let answer = decide(&mut boxes, start, goals, max_boxes);
    let known = |state: &State| match state {
        State::Free => Some(Occupancy::Free),
        State::Stuck(_) => Some(Occupancy::Stuck),
        State::Mixed(_) | State::Finest => Some(Occupancy::Mixed),
        State::Split(_) => None,
    };
    // Open boxes list each other, and stuck ones are listed once.
    let adjacencies = |node: &super::boxes::Node| -> usize {
        node.neighbors.iter().map(|&n| if boxes.nodes[n as usize].is_open() { 1 } else { 2 }).sum()
    };
    Exploration {
        answer,
        adjacencies: boxes.nodes.iter().map(adjacencies).sum::<usize>() / 2,
        boxes: boxes.nodes.iter().filter_map(|n| known(&n.state).map(|state| (n.cell, state))).collect(),
    }
}

/// While there are fewer boxes a search costs little beside what it spares: only the boxes of one chain are halved before
/// the next. With more, all chains with the fewest mixed boxes are refined at once, or else a way that is closed along a
/// curve which boxes cannot prove would take a search for every few boxes along it: quadratic time.
const ONE_BY_ONE: usize = 512;

fn decide(boxes: &mut Subdivision, start: Configuration, goals: &GoalSet, max_boxes: usize) -> Connectivity {
    loop {
        let ends = ends(boxes, goals);
        let Some(from) = boxes.locate(start) else { return disconnected(boxes, start, goals) };
        // Boxes at the finest size are hopeless: only where nothing else connects do they stand in the way of a proof.
        let chain = fewest_mixed(boxes, from, &ends, false).map(|chain| (chain, false));
        let Some((chain, finest)) = chain.or_else(|| fewest_mixed(boxes, from, &ends, true).map(|chain| (chain, true)))
        else {
            return disconnected(boxes, start, goals);
        };
        let state = |b: u32| &boxes.nodes[b as usize].state;
        if chain.iter().all(|&b| *state(b) == State::Free) {
            let chain = shortest(boxes, start, from, &ends);
            return Connectivity::Connected(Channel::new(boxes, &chain, start, &ends));
        }
        let chain =
            if boxes.nodes.len() < ONE_BY_ONE { chain } else { all_of_fewest_mixed(boxes, from, &ends, finest) };
        let mixed: Vec<u32> = chain.into_iter().filter(|&b| matches!(state(b), State::Mixed(_))).collect();
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
