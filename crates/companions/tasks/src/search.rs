//! The search for the fastest sequence of motions.
//!
//! The A* of petgraph does not fit: it needs the cost of an arc before the arc is on the open list. Here, the cost is
//! known only after a motion has been planned, and most motions need not be planned.

use super::failed_step::{RefusedStep, farthest};
use super::heuristic::Heuristic;
use super::ik_solutions::unreachable;
use super::least_time::{least_line_time, least_time};
use super::motion_cache::{Motion, MotionCache};
use super::refusal::Refusal;
use super::state::{Candidate, State, turns_on_the_way};
use super::stroke::{least_rest, least_stroke, least_without_strokes, most_overlap};
use super::tool_turn::wrist_after;
use cplan_geometry::OpenList;
use cplan_handling::{Step, Task};
use cplan_interrupt::checkpoint;
use cplan_legs::{FailedStep, Leg};
use std::cmp::Reverse;
use std::collections::BTreeSet;

/// Weight of the heuristic in weighted A*. With a large weight, the search soon reaches the end of the task.
const HEURISTIC_WEIGHT: f64 = 4.0;

/// Number of motions between two progress messages.
const PROGRESS_INTERVAL: usize = 50;

/// Limits at which a search stops.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Largest number of planned motions.
    pub motions: usize,
    /// Largest number of expanded nodes.
    pub expanded: usize,
    /// Only solutions that take less than this many seconds are sought.
    pub below: f64,
}

/// The reason why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ending {
    /// All steps are done in the node with this index.
    Done(usize),
    /// The search has examined all nodes.
    Exhausted,
    /// A limit was reached.
    OutOfBudget,
}

/// A node of the search: a sequence of steps that leads to a state.
struct Node<'a> {
    parent: Option<usize>,
    /// Number of steps done.
    depth: usize,
    /// Time from the start to this node, in seconds. While the motion to it is not planned, this is a lower bound.
    seconds: f64,
    stage: Stage<'a>,
}

impl Node<'_> {
    /// Returns the state, unless the motion to it is not planned.
    fn state(&self) -> Option<&State> {
        match &self.stage {
            Stage::Reached(state, _) => Some(state),
            Stage::Pending(_) => None,
        }
    }
}

/// The stages of a node: whether the motion to it is already planned.
enum Stage<'a> {
    /// The motion is not planned yet.
    Pending(Candidate<'a>),
    /// The motion is planned. The start node has no motion.
    Reached(Box<State>, Option<Box<(Candidate<'a>, Motion)>>),
}

/// A search over all IK solutions at the targets, turns of the wrist and orders that a task leaves free.
pub(super) struct Search<'a, 'l> {
    task: &'a Task,
    heuristic: &'a Heuristic<'a>,
    legs: &'l mut MotionCache,
    /// Number of motions that were planned before this search.
    planned: usize,
    nodes: Vec<Node<'a>>,
    /// Nodes, ordered by their least total time. If several have the same time, the node with more steps comes first,
    /// then the node that was found earlier.
    open: OpenList<(Reverse<usize>, usize)>,
    closed: BTreeSet<Vec<i64>>,
    /// Weight of the heuristic. Above 1, the search is weighted A*.
    weight: f64,
    /// Steps that could not be done.
    refused: Vec<RefusedStep<'a>>,
    /// True if the search has left out no choice so far.
    complete: bool,
    expanded: usize,
}

impl<'a, 'l> Search<'a, 'l> {
    pub fn new(task: &'a Task, heuristic: &'a Heuristic<'a>, legs: &'l mut MotionCache) -> Self {
        let mut search = Self {
            task,
            heuristic,
            planned: legs.planned(),
            legs,
            nodes: Vec::new(),
            open: OpenList::default(),
            closed: BTreeSet::new(),
            weight: 1.0,
            refused: Vec::new(),
            complete: true,
            expanded: 0,
        };
        let stage = Stage::Reached(Box::new(State::at_start(task)), None);
        search.push(Node { parent: None, depth: 0, seconds: 0.0, stage });
        search
    }

    /// Continues the search up to the limits. The solution is the fastest one, unless [`Search::use_weighted_astar`]
    /// was called.
    pub fn run(&mut self, limits: Limits, progress: &mut dyn FnMut(&str)) -> Ending {
        let mut reported = 0;
        while let Some((least, (_, index))) = self.open.pop() {
            checkpoint();
            let planned = self.legs.planned() - self.planned;
            if planned >= reported + PROGRESS_INTERVAL {
                reported = planned;
                progress(&format!("{} motions planned, {} states seen", self.legs.planned(), self.expanded));
            }
            if planned > limits.motions
                || self.expanded > limits.expanded
                || (least >= limits.below && limits.below.is_finite())
            {
                // The node stays open, because the search may be continued with other limits.
                self.open(index);
                return Ending::OutOfBudget;
            }
            let Stage::Reached(state, _) = &self.nodes[index].stage else {
                self.evaluate(index);
                continue;
            };
            if !self.closed.insert(state.key(self.task)) {
                continue;
            }
            self.expanded += 1;
            if state.is_done(self.task) {
                return Ending::Done(index);
            }
            self.expand(index);
        }
        Ending::Exhausted
    }

    /// Returns the number of nodes that have been expanded.
    pub fn expanded(&self) -> usize {
        self.expanded
    }

    /// Returns the time from the start to a node, in seconds.
    pub fn seconds(&self, index: usize) -> f64 {
        self.nodes[index].seconds
    }

    /// Records that a step is refused after a node.
    fn refuse(&mut self, node: usize, step: &'a Step, candidate: Option<Candidate<'a>>, refusal: Refusal) {
        let (depth, ik_solution) = (self.nodes[node].depth, candidate.map(|candidate| candidate.to));
        self.refused.push(RefusedStep { depth, node, step, ik_solution, candidate, refusal });
    }

    fn push(&mut self, node: Node<'a>) {
        self.nodes.push(node);
        self.open(self.nodes.len() - 1);
    }

    /// Puts a node on the open list.
    fn open(&mut self, index: usize) {
        let node = &self.nodes[index];
        let (q, progress) = match &node.stage {
            Stage::Pending(candidate) => (candidate.to, candidate.progress),
            Stage::Reached(state, _) => (state.q, state.progress),
        };
        let left = self.heuristic.remaining(q, progress);
        self.open.push(node.seconds + self.weight * left, (Reverse(node.depth), index));
    }

    /// Stops looking for the fastest choice: from now on, the remaining time counts more than the time so far.
    pub fn use_weighted_astar(&mut self) {
        self.weight = HEURISTIC_WEIGHT;
        self.open.drain().into_iter().for_each(|(_, index)| self.open(index));
    }

    /// Records that the search stopped at a limit. The steps after the farthest state could not be done within it.
    pub fn give_up(&mut self) {
        let open = |&node: &usize| self.nodes[node].state().is_some_and(|state| !state.is_done(self.task));
        let farthest = (0..self.nodes.len()).filter(open).max_by_key(|&node| (self.nodes[node].depth, Reverse(node)));
        let next =
            farthest.zip(farthest.and_then(|node| self.nodes[node].state()?.candidates(self.task).into_iter().next()));
        if let Some((node, candidates)) = next {
            let (motions, states) = (self.legs.planned(), self.expanded);
            let reason =
                format!("the search ended at its limit, after {motions} motions and {states} states of the world");
            let refusal = Refusal::new(reason, false);
            self.refuse(node, candidates.step, None, refusal);
        }
    }

    /// Plans the motion to a node. The node is then put on the open list again, or refused.
    fn evaluate(&mut self, index: usize) {
        let (Some(parent), Stage::Pending(candidate)) = (self.nodes[index].parent, &self.nodes[index].stage) else {
            return;
        };
        let candidate = *candidate;
        let Stage::Reached(from, _) = &self.nodes[parent].stage else { return };
        match self.legs.motion(self.task, from, &candidate) {
            Ok(motion) => {
                let seconds = motion.seconds() + candidate.step.dwell;
                let mut state = from.after(self.task, &candidate, motion.timed.curve.curve().path().goal());
                let may_depart = candidate.turns_after_stroke() && turns_on_the_way(self.task);
                state.turning = motion.turn.filter(|_| may_depart);
                state.wrist = wrist_after(self.task, from, &motion.timed.trajectory, motion.turn.map(|(turn, _)| turn));
                let seconds = self.nodes[parent].seconds + seconds;
                let node = &mut self.nodes[index];
                (node.seconds, node.stage) =
                    (seconds, Stage::Reached(Box::new(state), Some(Box::new((candidate, motion)))));
                self.open(index);
            }
            Err(refusal) => self.refuse(parent, candidate.step, Some(candidate), refusal),
        }
    }

    fn expand(&mut self, index: usize) {
        let Node { stage: Stage::Reached(state, _), depth, seconds, .. } = &self.nodes[index] else { return };
        let (depth, seconds, from) = (*depth, *seconds, state.q);
        let on_the_way = turns_on_the_way(self.task);
        let turning = state.turning.map_or(0.0, |(_, seconds)| seconds);
        let rising = most_overlap(self.task, state.rising) + turning;
        let raising = state.rising.filter(|_| state.is_lowered).map_or(0.0, |depth| least_stroke(self.task, depth));
        for candidates in state.candidates(self.task) {
            self.complete &= candidates.all;
            if candidates.ways.is_empty() {
                self.refuse(index, candidates.step, None, Refusal::new(unreachable(candidates.step), candidates.all));
            }
            for candidate in candidates.ways {
                // A turn after a pick counts for the next motion, in which it may be hidden.
                let own_turn = candidate.turn.filter(|_| !on_the_way || candidate.turns_before_stroke());
                let turn = own_turn.map_or(0.0, |turn| MotionCache::min_turn_seconds(self.task, turn));
                let object = candidate.event.map(|event| event.object());
                let sinking = match candidate.turns_before_stroke() {
                    true if !on_the_way => 0.0,
                    is_turned_first => {
                        let turn = if is_turned_first { turn } else { 0.0 };
                        most_overlap(self.task, candidate.depth(self.task)) + turn
                    }
                };
                let travel = least_time(&self.task.arm, from, candidate.to, candidate.step.speed);
                let travel = travel.max(least_line_time(candidate.step));
                let travel = least_without_strokes(travel, [rising, sinking]);
                let least = raising + travel + turning + turn + least_rest(self.task, candidate.step, object);
                let stage = Stage::Pending(candidate);
                self.push(Node { parent: Some(index), depth: depth + 1, seconds: seconds + least, stage });
            }
        }
    }

    /// Returns the legs up to a node.
    pub fn legs(&mut self, index: usize) -> Vec<Leg> {
        let mut legs = Vec::new();
        // The duration of a leg's turn after its pick, which the next leg determines.
        let mut turned_before = None;
        let mut at = Some(index);
        while let Some(node) = at.map(|index| &self.nodes[index]) {
            let before = node.parent.map(|parent| &self.nodes[parent]);
            if let (Some(Node { stage: Stage::Reached(from, _), seconds, .. }), Stage::Reached(_, Some(done))) =
                (before, &node.stage)
            {
                let (candidate, motion) = &**done;
                let mut turn = motion.turn;
                if let (Some((_, seconds)), Some(turning)) = (&mut turn, turned_before.take()) {
                    *seconds = turning;
                }
                legs.push(Leg {
                    step: candidate.step.clone(),
                    scene: self.legs.scene(self.task, from, candidate.step),
                    moving: from.moving.clone(),
                    carried: from.held.as_ref().map(|held| held.object),
                    timed: motion.timed.clone(),
                    turn,
                    raising: motion.raising,
                    stroke: motion.stroke,
                    wrist: motion.wrist,
                    overlap: motion.overlap,
                    deviation: motion.deviation,
                    tool_deviation: motion.tool_deviation,
                    event: candidate.event,
                    begin: *seconds + motion.before_departure() - motion.overlap.departure(),
                });
                turned_before = from.turning.map(|_| motion.turning_before);
            }
            at = node.parent;
        }
        legs.reverse();
        legs
    }

    /// Explains why the search got no farther. Also returns the node that it reached. The last value is true if the
    /// failure is proven for all choices, provided that the search is exhausted.
    pub fn failure(&mut self) -> (FailedStep, usize, bool) {
        let (task, legs) = (self.task, &mut *self.legs);
        let (failed, node) =
            farthest(task, &self.refused, |node| self.nodes[node].state(), |from, step| legs.scene(task, from, step));
        let proven = self.complete && self.refused.iter().all(|refused| refused.refusal.proven);
        (failed, node, proven)
    }
}
