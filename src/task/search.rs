//! The search for the fastest sequence of motions.

use super::Manner;
use super::answer::{Leg, TaskAnswer, TaskVerdict};
use super::impossible::{Impossible, Refused, Tried, reasons};
use super::least_time::least_time;
use super::legs::{Legs, Motion, Refusal};
use super::order;
use super::outlook::Outlook;
use super::state::{Candidate, State};
use super::stroke::least_rest;
use crate::geometry::Ordered;
use crate::interrupt::checkpoint;
use crate::model::Task;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Motions that are planned, and nodes that are expanded, while the search insists on the fastest choice: some seconds'
/// worth. Beyond, what is left counts more than what is done, so that it goes straight for the end.
const MOST_MOTIONS: usize = 2_000;
const MOST_EXPANDED: usize = 100_000;

/// States for each step of a task, beside these: long tasks have more of them.
const EXPANDED_PER_STEP: usize = 16;

/// By how much more what is left counts then.
const HASTE: f64 = 4.0;

/// Motions between two words on progress.
const NEWS: usize = 50;

/// The search ends without an answer after so many times the first two numbers.
const PATIENCE: usize = 10;

/// Plans a task: the fastest sequence of motions over all postures at the targets, turns of the wrist and orders that
/// are free, up to what [`TaskAnswer`] says of it. `progress` hears of long work.
#[must_use]
pub fn plan(task: &Task, manner: &Manner, progress: &mut dyn FnMut(&str)) -> TaskAnswer {
    let (settled, ordered) = order::settled(task);
    let outlook = Outlook::new(&settled);
    let start = State::at_start(&settled);
    // An order that was settled on bounds nothing but itself.
    let lower_bound = match ordered {
        true => Outlook::new(task).remaining(task.start, State::at_start(task).progress),
        false => outlook.remaining(start.q, start.progress),
    };
    let mut search = Search {
        task: &settled,
        outlook: &outlook,
        legs: Legs::new(&settled, *manner),
        nodes: Vec::new(),
        open: BinaryHeap::new(),
        closed: BTreeSet::new(),
        haste: 1.0,
        refused: Vec::new(),
        exact: !ordered,
        complete: !ordered,
        expanded: 0,
    };
    search.run(start, lower_bound, progress)
}

/// A way to a state.
struct Node<'a> {
    parent: Option<usize>,
    /// Steps done.
    depth: usize,
    /// Seconds to here; a lower bound while the motion is not planned.
    seconds: f64,
    stage: Stage<'a>,
}

/// How far a node is looked into.
enum Stage<'a> {
    /// The motion is not planned yet.
    Pending(Candidate<'a>),
    /// The motion is planned; none to the start.
    Reached(Box<State>, Option<(Candidate<'a>, Motion)>),
}

/// By least total time; of equals the one that is farther, then the earlier found.
type Entry = Reverse<(Ordered, Reverse<usize>, usize)>;

struct Search<'a> {
    task: &'a Task,
    outlook: &'a Outlook<'a>,
    legs: Legs<'a>,
    nodes: Vec<Node<'a>>,
    open: BinaryHeap<Entry>,
    closed: BTreeSet<Vec<i64>>,
    /// Weight of what is left.
    haste: f64,
    /// Steps that could not be done.
    refused: Vec<Refused<'a>>,
    /// Whether what is found is the fastest of all that is looked at.
    exact: bool,
    /// Whether all there is is looked at.
    complete: bool,
    expanded: usize,
}

impl<'a> Search<'a> {
    fn run(&mut self, start: State, lower_bound: f64, progress: &mut dyn FnMut(&str)) -> TaskAnswer {
        self.push(Node { parent: None, depth: 0, seconds: 0.0, stage: Stage::Reached(Box::new(start), None) });
        let mut told = 0;
        let budget = MOST_EXPANDED + EXPANDED_PER_STEP * self.task.steps().count();
        while let Some(Reverse((_, _, index))) = self.open.pop() {
            checkpoint();
            if self.legs.planned() >= told + NEWS {
                told = self.legs.planned();
                progress(&format!("{told} motions planned, {} states seen", self.expanded));
            }
            let patience = if self.haste > 1.0 { PATIENCE } else { 1 };
            if self.legs.planned() > patience * MOST_MOTIONS || self.expanded > patience * budget {
                (self.exact, self.complete) = (false, false);
                if self.haste > 1.0 {
                    self.give_up();
                    break;
                }
                self.hurry();
            }
            let Stage::Reached(state, _) = &self.nodes[index].stage else {
                self.settle(index);
                continue;
            };
            if !self.closed.insert(state.key(self.task)) {
                continue;
            }
            self.expanded += 1;
            if state.is_done(self.task) {
                return self.answer(TaskVerdict::Done, index, lower_bound);
            }
            self.expand(index);
        }
        self.failure(lower_bound)
    }

    fn push(&mut self, node: Node<'a>) {
        self.open.push(self.entry(&node, self.nodes.len()));
        self.nodes.push(node);
    }

    fn entry(&self, node: &Node, index: usize) -> Entry {
        let (q, progress) = match &node.stage {
            Stage::Pending(candidate) => (candidate.to, candidate.progress),
            Stage::Reached(state, _) => (state.q, state.progress),
        };
        let left = self.outlook.remaining(q, progress);
        Reverse((Ordered(node.seconds + self.haste * left), Reverse(node.depth), index))
    }

    /// Gives up on the fastest choice.
    fn hurry(&mut self) {
        self.haste = HASTE;
        let open = std::mem::take(&mut self.open);
        self.open = open.into_iter().map(|Reverse((_, _, index))| self.entry(&self.nodes[index], index)).collect();
    }

    /// Leaves off: what comes after the farthest state reached could not be done in time.
    fn give_up(&mut self) {
        let open = |&node: &usize| self.state(node).is_some_and(|state| !state.is_done(self.task));
        let farthest = (0..self.nodes.len()).filter(open).max_by_key(|&node| (self.nodes[node].depth, Reverse(node)));
        let next = farthest.zip(farthest.and_then(|node| self.state(node)?.candidates(self.task).into_iter().next()));
        if let Some((node, candidates)) = next {
            let (motions, states) = (self.legs.planned(), self.expanded);
            let reason = format!("given up after {motions} motions and {states} states of the world");
            let refusal = Refusal::new(reason, false);
            let depth = self.nodes[node].depth;
            self.refused.push(Refused { depth, node, step: candidates.step, posture: None, refusal });
        }
    }

    /// Plans the motion to a node.
    fn settle(&mut self, index: usize) {
        let (Some(parent), Stage::Pending(candidate)) = (self.nodes[index].parent, &self.nodes[index].stage) else {
            return;
        };
        let candidate = *candidate;
        let Stage::Reached(from, _) = &self.nodes[parent].stage else { return };
        match self.legs.motion(from, &candidate) {
            Ok(motion) => {
                let seconds = motion.seconds() + candidate.step.dwell;
                let state = from.after(self.task, &candidate, motion.timed.curve.curve().path().goal());
                let seconds = self.nodes[parent].seconds + seconds;
                let node = &mut self.nodes[index];
                (node.seconds, node.stage) = (seconds, Stage::Reached(Box::new(state), Some((candidate, motion))));
                let entry = self.entry(&self.nodes[index], index);
                self.open.push(entry);
            }
            Err(refusal) => self.refused.push(Refused {
                depth: self.nodes[parent].depth,
                node: parent,
                step: candidate.step,
                posture: Some(candidate.to),
                refusal,
            }),
        }
    }

    fn expand(&mut self, index: usize) {
        let Node { stage: Stage::Reached(state, _), depth, seconds, .. } = &self.nodes[index] else { return };
        let (depth, seconds, from) = (*depth, *seconds, state.q);
        for candidates in state.candidates(self.task) {
            self.complete &= candidates.all;
            if candidates.ways.is_empty() {
                let refusal = Refusal::new("no posture within the joint limits reaches its target", candidates.all);
                self.refused.push(Refused { depth, node: index, step: candidates.step, posture: None, refusal });
            }
            for way in candidates.ways {
                let turn = way.turn.map_or(0.0, |turn| self.legs.least_turn(turn));
                let least = least_time(&self.task.arm, from, way.to, way.step.speed) + turn;
                let least = least + least_rest(self.task, way.step, way.event.map(|event| event.object()));
                let stage = Stage::Pending(way);
                self.push(Node { parent: Some(index), depth: depth + 1, seconds: seconds + least, stage });
            }
        }
    }

    /// The steps up to a node.
    fn answer(&mut self, verdict: TaskVerdict, index: usize, lower_bound: f64) -> TaskAnswer {
        let mut legs = Vec::new();
        let mut at = Some(index);
        while let Some(node) = at.map(|index| &self.nodes[index]) {
            let before = node.parent.map(|parent| &self.nodes[parent]);
            if let (
                Some(Node { stage: Stage::Reached(from, _), seconds, .. }),
                Stage::Reached(_, Some((candidate, motion))),
            ) = (before, &node.stage)
            {
                legs.push(Leg {
                    step: candidate.step.clone(),
                    scene: self.legs.scene(from, candidate.step),
                    carried: from.held.as_ref().map(|held| held.object),
                    timed: motion.timed.clone(),
                    turn: motion.turn,
                    stroke: motion.stroke,
                    event: candidate.event,
                    begin: *seconds,
                });
            }
            at = node.parent;
        }
        legs.reverse();
        TaskAnswer {
            verdict,
            legs,
            lower_bound,
            exact: self.exact,
            motions: self.legs.planned(),
            expanded: self.expanded,
        }
    }

    /// What can be done, and why no more.
    fn failure(&mut self, lower_bound: f64) -> TaskAnswer {
        // Of the places where it ends, the farthest; of these the one reached first.
        let depth = self.refused.iter().map(|refused| refused.depth).max().unwrap_or(0);
        let farthest = || self.refused.iter().filter(|refused| refused.depth == depth);
        let Some((first, from)) = farthest().find_map(|refused| Some((refused, self.state(refused.node)?.clone())))
        else {
            unreachable!("a search ends at the goal or where steps are refused");
        };
        let (node, step) = (first.node, first.step);
        let same = || farthest().filter(|refused| refused.step.number == step.number);
        let mut tried = Vec::new();
        for refused in same() {
            let Some(State { q, .. }) = self.state(refused.node) else { continue };
            tried.push(Tried { from: *q, to: refused.posture, reason: &refused.refusal.reason });
        }
        let mut postures = Vec::new();
        for unreached in same().filter(|refused| refused.node == node).filter_map(Refused::unreached) {
            if !postures.contains(&unreached) {
                postures.push(unreached);
            }
        }
        let impossible = Impossible {
            step: step.clone(),
            reasons: reasons(&self.task.arm, &tried),
            scene: self.legs.scene(&from, step),
            from: from.q,
            postures,
        };
        let proven = self.complete && self.refused.iter().all(|refused| refused.refusal.proven);
        let verdict = if proven { TaskVerdict::Infeasible(impossible) } else { TaskVerdict::Unknown(impossible) };
        self.answer(verdict, node, lower_bound)
    }

    /// The state that a node has reached.
    fn state(&self, node: usize) -> Option<&State> {
        match &self.nodes[node].stage {
            Stage::Reached(state, _) => Some(state),
            Stage::Pending(_) => None,
        }
    }
}
