//! Tasks among moving obstacles, and picks of moving objects. The search chooses what to do next, with which IK
//! solution, and when.
//!
//! Each state has a time, from which the next motion is planned ([`time_among_moving_obstacles`]). The motion must arrive when the arm can
//! stand at its target long enough for the step. To pick a passing object, the arm must be there when the object
//! passes. Several moments of the passage are tried, the earliest first. When one is possible, an earlier one is sought
//! between it and the moment tried before.
//!
//! The search always continues from the state with the most steps, and of these from the earliest one, so that it soon
//! reaches an end of the task. With the remaining budget of motions, it then looks for an earlier end. It does not look
//! ahead: if an object has passed while the arm did another step, an earlier choice is changed. So a search without a
//! result proves nothing about other choices. Two reasons of failure are proven: a moving object is never within reach,
//! or a step cannot be done even without moving obstacles.

mod passing;
mod proven;
mod timed_candidates;

use super::failed_step::{RefusedStep, farthest};
use super::heuristic::Heuristic;
use super::motion_cache::MotionCache;
use super::motion_path::of_legs;
use super::refusal::{Refusal, require_unobstructed};
use super::state::State;
use cplan_geometry::OrderedF64;
use cplan_handling::{Step, Task, TimedScene};
use cplan_interrupt::checkpoint;
use cplan_judge::Posture;
use cplan_legs::{Event, FailedStep, Leg, Overlap, Sequence, TaskAnswer, TaskMotion};
use cplan_model::space::Configuration;
use cplan_model::{MotionProblem, Outcome};
use cplan_motion::{Limits, TimedMotion, Timing, Wait, after_pause, nanoseconds, round_up, seconds};
use cplan_movers::{MovingObstacles, TimingRequirements, clearance_at_rest, time_among_moving_obstacles};
use cplan_solver::Options;
use proven::{failed_pick_out_of_reach, last_passage, static_failure};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;
use timed_candidates::{Choices, Moment, TimedCandidate, TimedState};

/// Largest number of motions that the search plans in time before all steps are done: a fixed number, and a number per
/// step.
const MOTION_BUDGET: [usize; 2] = [150, 40];

/// Largest number of further motions that the search plans in time to find an earlier end of the task: a fixed number,
/// and a number per step.
const IMPROVEMENT_BUDGET: [usize; 2] = [10, 8];

/// Largest number of motions that are planned with rounded corners if jerks are limited: a fixed number, and a number
/// per step. Each takes tenths of a second. Later motions stop at their corners.
const ROUNDED_MOTION_BUDGET: [usize; 2] = [12, 4];

/// Number of parts into which a time span is cut in the search for an earlier moment to pick a moving object. The span
/// lies between a moment that is possible and the one tried before it. The ends of the parts are tried. Then the search
/// continues with the part that remains.
const PARTS_PER_SPAN: usize = 4;

/// Least distance of two moments, in seconds. The search for an earlier moment ends when the possible moment is this
/// close to the one tried before it.
const MIN_MOMENT_DISTANCE: f64 = 5e-3;

/// Number of motions between two progress messages.
const PROGRESS_INTERVAL: usize = 50;

/// Plans a task among moving obstacles.
pub(super) fn plan(task: &Task, options: &Options, progress: &mut dyn FnMut(&str)) -> TaskAnswer {
    let heuristic = Heuristic::new(task);
    let start = State::at_start(task);
    let lower_bound = heuristic.remaining(start.q, start.progress).max(last_passage(task));
    let refuted = |failed| TaskAnswer {
        outcome: Outcome::Infeasible(failed),
        legs: Vec::new(),
        lower_bound,
        motions: 0,
        expanded: 0,
    };
    if let Some(failed) = failed_pick_out_of_reach(task, &start) {
        return refuted(failed);
    }
    let mut search = Search {
        task,
        options: of_legs(options),
        stopping: Options { drive: options.drive.stopping_at_corners(), ..of_legs(options) },
        heuristic: &heuristic,
        legs: MotionCache::new(options),
        stopping_legs: MotionCache::new(&Options { drive: options.drive.stopping_at_corners(), ..*options }),
        nodes: Vec::new(),
        open: BinaryHeap::new(),
        is_done: false,
        refused: Vec::new(),
        motions: 0,
    };
    search.push(Node { parent: None, depth: 0, seconds: 0.0, stage: Stage::Reached(Box::new(start), None) });
    let (outcome, legs) = match search.run(progress) {
        Some(last) => {
            let legs = search.legs(last);
            let motion = TaskMotion { sequence: Sequence::of(&legs), exact: false, timing: search.timing(last) };
            (Outcome::Found(motion), legs)
        }
        None => {
            if let Some(failed) = static_failure(task, options, progress) {
                return refuted(failed);
            }
            let (failed, last) = search.failure();
            (Outcome::Unknown(failed), search.legs(last))
        }
    };
    TaskAnswer { outcome, legs, lower_bound, motions: search.motions, expanded: search.nodes.len() }
}

/// A node of the search: a sequence of steps that leads to a state.
struct Node<'a> {
    parent: Option<usize>,
    /// Number of steps done.
    depth: usize,
    /// End of the last step, in seconds. While its motion is not planned, this is a lower bound.
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
    Pending(Box<TimedCandidate<'a>>),
    /// The motion is planned. The start node has no motion.
    Reached(Box<State>, Option<Box<ExecutedStep>>),
}

/// A step with its motion.
struct ExecutedStep {
    leg: Leg,
    /// How the motion passes moving obstacles. Times count from the beginning of the motion.
    timing: Timing,
}

/// Rank of a node in the search. Until a solution is known, nodes with more steps come first. If several have as many,
/// the node with the earliest end of the task comes first, then the node with the lowest index.
type Rank = (Reverse<usize>, OrderedF64, usize);

struct Search<'a> {
    task: &'a Task,
    options: Options,
    heuristic: &'a Heuristic<'a>,
    /// Cache of motions that are planned without moving obstacles.
    legs: MotionCache,
    /// The options, with a stop at every corner.
    stopping: Options,
    stopping_legs: MotionCache,
    nodes: Vec<Node<'a>>,
    open: BinaryHeap<Reverse<Rank>>,
    /// True if a sequence for the whole task is known.
    is_done: bool,
    refused: Vec<RefusedStep<'a>>,
    /// Number of motions that were planned in time.
    motions: usize,
}

impl<'a> Search<'a> {
    /// Runs the search. Returns the node in which all steps are done, with the earliest end that was found. `None` if
    /// there is none.
    fn run(&mut self, progress: &mut dyn FnMut(&str)) -> Option<usize> {
        let steps = self.task.steps().count();
        let budget = |[some, each]: [usize; 2]| some + each * steps;
        let (mut best, mut most, mut reported) = (None::<usize>, budget(MOTION_BUDGET), 0);
        while let Some(Reverse((_, OrderedF64(least), index))) = self.open.pop() {
            checkpoint();
            if self.motions >= reported + PROGRESS_INTERVAL {
                reported = self.motions;
                progress(&format!("{} motions timed, {} states examined", self.motions, self.nodes.len()));
            }
            if self.motions > most {
                self.give_up(index, best.is_some());
                break;
            }
            if best.is_some_and(|best| self.nodes[best].seconds <= least) {
                continue;
            }
            // The lower bound may have risen since the node was opened.
            if self.end_bound(index) > least {
                self.open(index);
                continue;
            }
            match &self.nodes[index].stage {
                Stage::Pending(_) => self.evaluate(index),
                Stage::Reached(state, _) if !state.is_done(self.task) => self.expand(index),
                Stage::Reached(..) => {
                    if best.is_none() {
                        self.is_done = true;
                        most = self.motions + budget(IMPROVEMENT_BUDGET);
                        let open: Vec<usize> = self.open.drain().map(|Reverse((_, _, index))| index).collect();
                        open.into_iter().for_each(|index| self.open(index));
                    }
                    best = Some(index);
                }
            }
        }
        best
    }

    /// Records that a step is refused after a node.
    fn refuse(&mut self, node: usize, step: &'a Step, ik_solution: Option<Configuration>, refusal: Refusal) {
        let depth = self.nodes[node].depth;
        self.refused.push(RefusedStep { depth, node, step, ik_solution, candidate: None, refusal });
    }

    fn push(&mut self, node: Node<'a>) {
        self.nodes.push(node);
        self.open(self.nodes.len() - 1);
    }

    fn open(&mut self, index: usize) {
        let depth = if self.is_done { 0 } else { self.nodes[index].depth };
        self.open.push(Reverse((Reverse(depth), OrderedF64(self.end_bound(index)), index)));
    }

    /// Returns a lower bound on the end of the task through a node, in seconds.
    fn end_bound(&self, index: usize) -> f64 {
        let node = &self.nodes[index];
        let left = match &node.stage {
            Stage::Pending(choice) => self.heuristic.remaining(choice.candidate.to, choice.candidate.progress),
            Stage::Reached(state, _) => self.heuristic.remaining(state.q, state.progress),
        };
        node.seconds + left
    }

    /// Records the node at which the search stopped. Does nothing if a solution is known.
    fn give_up(&mut self, index: usize, is_known: bool) {
        let node = &self.nodes[index];
        let next = match (&node.stage, node.parent) {
            (Stage::Pending(choice), Some(parent)) => Some((parent, choice.candidate.step)),
            (Stage::Pending(_), None) => None,
            (Stage::Reached(state, _), _) => state.candidates(self.task).first().map(|next| (index, next.step)),
        };
        if let Some((node, step)) = next.filter(|_| !is_known) {
            let refusal =
                Refusal::new(format!("the search ended at its limit of {} timed motions", self.motions), false);
            self.refuse(node, step, None, refusal);
        }
    }

    fn expand(&mut self, index: usize) {
        let Node { stage: Stage::Reached(state, _), depth, seconds, .. } = &self.nodes[index] else { return };
        let depth = *depth;
        let Choices { ways, refused } = TimedState { task: self.task, state, time: *seconds }.choices();
        for reason in refused {
            self.refuse(index, reason.step, reason.to, reason.refusal);
        }
        for choice in ways {
            self.push(Node {
                parent: Some(index),
                depth: depth + 1,
                seconds: choice.ends,
                stage: Stage::Pending(Box::new(choice)),
            });
        }
    }

    /// Plans the motion to a node. For the pick of a moving object, also tries earlier moments.
    fn evaluate(&mut self, index: usize) {
        let (Some(parent), Stage::Pending(choice)) = (self.nodes[index].parent, &self.nodes[index].stage) else {
            return;
        };
        let choice = choice.clone();
        let Node { stage: Stage::Reached(state, _), seconds, .. } = &self.nodes[parent] else { return };
        let (state, time) = (state.clone(), *seconds);
        let here = TimedState { task: self.task, state: &state, time };
        match self.done(here, &choice) {
            Ok(done) => {
                self.leave_later_moments(parent, &choice);
                let (done, after, ends) = self.earlier_pick(here, &choice).unwrap_or(done);
                let node = &mut self.nodes[index];
                (node.seconds, node.stage) = (ends, Stage::Reached(Box::new(after), Some(Box::new(done))));
                self.open(index);
            }
            Err(refusal) => {
                // A passing object is picked at many places, so that no single IK solution is reported.
                let ik_solution = choice.moment.is_none().then_some(choice.candidate.to);
                self.refuse(parent, choice.candidate.step, ik_solution, refusal);
            }
        }
    }

    /// Raises the lower limit of the next moment that is tried for a pick, because an earlier moment is now known to be
    /// possible.
    fn leave_later_moments(&mut self, parent: usize, done: &TimedCandidate) {
        let Some(done_at) = done.moment else { return };
        for node in self.nodes.iter_mut().filter(|node| node.parent == Some(parent)) {
            if let Stage::Pending(choice) = &mut node.stage
                && let TimedCandidate { moment: Some(moment), branch, candidate, .. } = &mut **choice
                && moment.since == done_at.time
                && *branch == done.branch
            {
                moment.since = moment.time;
                node.seconds = moment.time + candidate.step.dwell;
            }
        }
    }

    /// Returns the same pick at an earlier moment. `None` if no earlier one is possible.
    fn earlier_pick(
        &mut self,
        here: TimedState<'a, '_>,
        choice: &TimedCandidate<'a>,
    ) -> Option<(ExecutedStep, State, f64)> {
        let moment = choice.moment?;
        let (mut since, mut until, mut best) = (moment.since, moment.time, None);
        while until - since > MIN_MOMENT_DISTANCE {
            let step = (until - since) / PARTS_PER_SPAN as f64;
            let parts = (1..PARTS_PER_SPAN).map(|k| round_up(since + step * k as f64));
            let sooner =
                parts.scan(since, |before, time| Some(Moment { time, since: std::mem::replace(before, time) }));
            let found = sooner.into_iter().find_map(|moment| {
                let choice = here.at_moment(choice, moment)?;
                Some((moment, self.done(here, &choice).ok()?))
            });
            let last = until - step;
            match found {
                Some((moment, done)) => (since, until, best) = (moment.since, moment.time, Some(done)),
                None => since = last,
            }
        }
        best
    }

    /// Performs a step. Returns the state after it, and its end in seconds.
    fn done(
        &mut self,
        here: TimedState<'a, '_>,
        choice: &TimedCandidate<'a>,
    ) -> Result<(ExecutedStep, State, f64), Refusal> {
        let TimedState { task, state, time } = here;
        let (candidate, step) = (&choice.candidate, choice.candidate.step);
        if matches!(candidate.event, Some(Event::Grasp { .. })) {
            // If the payload would touch something here, the object may still be picked elsewhere on its path.
            require_unobstructed(&here.scene_at_rest(candidate, time).0, candidate.to, "after this step")?;
        }
        let [some, each] = ROUNDED_MOTION_BUDGET;
        let stops =
            Limits::from(&task.arm).stops_at_corners() && self.motions >= some + each * self.task.steps().count();
        let (options, legs) =
            if stops { (&self.stopping, &mut self.stopping_legs) } else { (&self.options, &mut self.legs) };
        // The motion without moving obstacles.
        let motion = legs.motion(task, state, candidate)?;
        self.motions += 1;
        let (scene, trajectories) = here.scene(step);
        let problem = MotionProblem::trusted(scene, state.q, candidate.to);
        // Times from the beginning of the motion. Differences of whole nanoseconds are whole nanoseconds.
        let since = |at: f64| match at.is_finite() {
            true => seconds(nanoseconds(at).saturating_sub(nanoseconds(time))),
            false => at,
        };
        let demand = TimingRequirements {
            speed: step.speed,
            arrival: Some(choice.arrival.map(since)),
            until: choice.moment.map(|moment| since(moment.time)),
        };
        let path = motion.timed.curve.straight();
        let planned =
            time_among_moving_obstacles(&problem, &trajectories, path, (*motion.timed).clone(), options, &demand);
        let planned = planned.map_err(|error| Refusal::new(error.to_string(), false))?;
        let (TimedMotion { curve, trajectory }, figures) = planned.map_err(|reason| Refusal::new(reason, false))?;
        let arrival = after_pause(time + trajectory.duration(), 0.0);
        if arrival > choice.moment.map_or(choice.arrival[1], |moment| moment.time) {
            return Err(Refusal::new("the arm cannot rest there for the required time", false));
        }
        let q = curve.curve().path().goal();
        let (scene, trajectories) = here.scene_at_rest(candidate, arrival);
        let kept = clearance_at_rest(TimedScene { scene: &scene, trajectories: &trajectories }, q, step.dwell);
        let kept =
            kept.ok_or_else(|| Refusal::new("a moving obstacle or object arrives while the arm rests there", false))?;
        let leg = Leg {
            step: step.clone(),
            scene: self.legs.scene(task, state, step),
            moving: state.moving.clone(),
            carried: state.held.as_ref().map(|held| held.object),
            timed: Arc::new(TimedMotion { curve: curve.among_movers(kept, None), trajectory }),
            turn: None,
            raising: None,
            stroke: None,
            wrist: None,
            overlap: Overlap::NONE,
            tool_deviation: None,
            deviation: None,
            event: candidate.event,
            begin: time,
        };
        let clearance = figures.clearance.into_iter().chain(kept.is_finite().then_some(kept)).reduce(f64::min);
        let timing = Timing { clearance, ..figures };
        Ok((ExecutedStep { leg, timing }, state.after(task, candidate, q), after_pause(arrival, step.dwell)))
    }

    /// Returns the steps done up to a node.
    fn steps_up_to(&self, index: usize) -> Vec<&ExecutedStep> {
        let nodes = std::iter::successors(Some(index), |&index| self.nodes[index].parent);
        let done = nodes.filter_map(|index| match &self.nodes[index].stage {
            Stage::Reached(_, done) => done.as_deref(),
            Stage::Pending(_) => None,
        });
        let mut done: Vec<&ExecutedStep> = done.collect();
        done.reverse();
        done
    }

    /// Returns the legs up to a node.
    fn legs(&self, index: usize) -> Vec<Leg> {
        self.steps_up_to(index).into_iter().map(|done| done.leg.clone()).collect()
    }

    /// Returns how the arm passes moving obstacles in all steps up to a node.
    fn timing(&self, index: usize) -> Option<Timing> {
        let task = self.task;
        let mut whole = Timing {
            obstacles: task.workspace.movers.len() + task.initially_moving().count(),
            ways: 0,
            waits: Vec::new(),
            clearance: None,
            free_until: self.free_until(index),
        };
        for ExecutedStep { leg, timing } in self.steps_up_to(index) {
            whole.ways += timing.ways;
            whole.clearance = whole.clearance.into_iter().chain(timing.clearance).reduce(f64::min);
            let later = |wait: &Wait| Wait { from: leg.begin + wait.from, to: leg.begin + wait.to, at: wait.at };
            whole.waits.extend(timing.waits.iter().map(later));
        }
        Some(whole)
    }

    /// Returns the time until which the arm may stay at its configuration in a node, in seconds. `None` if it may stay
    /// for ever.
    fn free_until(&self, index: usize) -> Option<f64> {
        let (node, state) = (&self.nodes[index], self.nodes[index].state()?);
        let released = node.parent.and_then(|parent| self.nodes[parent].state()?.released);
        let scene = state.scene(self.task, released);
        let trajectories = self.task.trajectories_since(&state.moving, node.seconds);
        let timed = TimedScene { scene: &scene, trajectories: &trajectories };
        let movers = MovingObstacles::new(timed, scene.workspace().clearance);
        let safe = movers.safe_intervals(&Posture::new(&scene, state.q));
        safe.first().filter(|[_, until]| until.is_finite()).map(|[_, until]| node.seconds + until)
    }

    /// Explains why the search got no farther. Also returns the node that it reached.
    fn failure(&mut self) -> (FailedStep, usize) {
        let (task, legs) = (self.task, &mut self.legs);
        farthest(task, &self.refused, |node| self.nodes[node].state(), |from, step| legs.scene(task, from, step))
    }
}
