//! The search for a coordination: pairs of paths in a fixed order, then proofs of infeasibility.

use crate::between::Between;
use crate::coordinate::{Conflict, Coordination, Coordinator};
use crate::funnel::Funnels;
use crate::joint_tree::joint_route;
use crate::refutation::{Boxes, refuted_in_boxes};
use crate::shaping::Shaping;
use crate::stage::StagePairs;
use crate::task_search::plan_tasks;
use crate::{Cell, CellArm};
use cplan_engine::{Plan, PlanError, Refutation as PlanRefutation, Searches, plan};
use cplan_legs::FailedStep;
use cplan_judge::{CertifiedPath, CheckedProof, Deviation};
use cplan_model::space::Configuration;
use cplan_model::{MotionProblem, Obstacle, Outcome, Scene, Status};
use cplan_motion::{Drive, Objective};
use cplan_solver::{Criterion, Options, solve};
use std::fmt::Write as _;

/// Gap between the duration and its lower bound at which the search ends, as a share of the bound.
pub(crate) const ACCEPTED_GAP: f64 = 0.02;

/// Greatest number of pairs of paths that are coordinated, before the search with all four joints.
const MAX_PAIRS: usize = 12;

/// Greatest number of pairs of goals for which paths are planned.
const MAX_GOAL_PAIRS: usize = 4;

/// Number of searches with all four joints, each with other samples.
const JOINT_SEARCHES: u64 = 12;

/// Number of attempts to shorten a path in four joints.
const SHORTCUTS: usize = 400;

/// Least number of routes in four joints that are shaped.
const MIN_SHAPED_ROUTES: u64 = 24;

/// Greatest number of routes in four joints that are shaped. If a route is worthwhile, twice as many are shaped as were up to it.
const MAX_SHAPED_ROUTES: u64 = 48;

/// Share of the duration that a worthwhile route gains.
const WORTHWHILE_GAIN: f64 = 0.01;

/// Greatest number of boxes that raise the lower bound on the duration.
const BOUND_BOXES: usize = 10_000;

/// Share of the bound by which it is raised at least.
const BOUND_RESOLUTION: f64 = 0.01;

/// Rounding error of a bound, as a share of it.
const BOUND_ROUNDING: f64 = 1e-9;

/// Settings of a coordination.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Options for the motion of each arm.
    pub options: Options,
    /// Seconds by which the clock of one arm may be ahead of the other's.
    pub skew: f64,
    /// Number of boxes in four joints for a proof that there is no coordination.
    pub boxes: usize,
}

impl Default for Settings {
    /// Returns the defaults: a skew of 20 ms, and 200 000 boxes.
    fn default() -> Self {
        Self { options: Options::default(), skew: 0.02, boxes: 200_000 }
    }
}

/// Proof that the arms cannot both reach their goals.
#[derive(Debug, Clone)]
pub enum Refutation {
    /// One arm alone cannot reach its goal.
    Alone {
        /// The arm, 0 or 1.
        arm: usize,
        /// The proof.
        proof: CheckedProof,
    },
    /// One arm alone cannot do its steps.
    Step {
        /// The arm, 0 or 1.
        arm: usize,
        /// The step that fails.
        failed: Box<FailedStep>,
    },
    /// The arms collide at their starts. The text names the links.
    Starts(String),
    /// The arms collide at every pair of their goals. The text names the links at the first pair.
    Goals(String),
    /// Boxes of collisions in four joints separate the starts from all goals.
    Boxes(Boxes),
}

/// The answer about a cell.
#[derive(Debug, Clone)]
pub struct CellPlan {
    /// The motions, a proof that no motions exist, or the reason for an unknown answer.
    pub outcome: Outcome<Coordination, Refutation>,
    /// Each arm without the other. `None` if it was not planned.
    pub alone: [Option<Alone>; 2],
    /// Proven lower bound on the time until both arms are at their goals, seconds, for clocks that differ by up to the skew.
    /// `None` if it is not known.
    pub lower_bound: Option<f64>,
    /// For each arm, the names of the objects that it moves, of those that either arm may move. `None` if there are none.
    pub assignment: Option<[Vec<String>; 2]>,
    /// Attempts with their results, in words, in order.
    pub tried: Vec<String>,
}

/// The motion of an arm without the other arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alone {
    /// Duration of the fastest motion that was found, seconds. `None` if none was found.
    pub duration: Option<f64>,
    /// Proven lower bound on the duration of every motion, seconds. `None` if it is not known.
    pub lower_bound: Option<f64>,
}

impl CellPlan {
    /// Returns the status: found, infeasible or unknown.
    pub fn status(&self) -> Status {
        self.outcome.status()
    }
}

/// Coordinates the arms of a cell. Reports long computations to `progress`, as lines of text.
///
/// # Errors
/// Options that do not suit the robots, and motions that cannot be timed.
pub fn plan_cell(cell: &Cell, settings: &Settings, progress: &mut dyn FnMut(&str)) -> Result<CellPlan, PlanError> {
    if let [Some(one), Some(two)] = cell.arms.each_ref().map(|arm| arm.task.as_ref()) {
        return plan_tasks(cell, [one, two], settings, progress);
    }
    let mut alone: [Option<Plan>; 2] = [None, None];
    let answer = |outcome, alone: &mut [Option<Plan>; 2], tried: Vec<String>| {
        let bounds = alone.each_ref().map(|plan| plan.as_ref().and_then(duration_bound));
        let lower_bound = bounds[0].zip(bounds[1]).map(|(a, b)| a.max(b));
        let alone = alone.each_ref().map(|plan| plan.as_ref().map(alone_of));
        Ok(CellPlan { outcome, alone, lower_bound, assignment: None, tried })
    };
    let problems = cell.arms.each_ref().map(|arm| arm.problem.query());
    let scenes = problems.map(MotionProblem::scene);
    let pairs = StagePairs::single(Between::new(scenes, cell.is_one_robot, scenes[0].workspace().clearance));
    let between = pairs.between([0, 0]);
    let names = cell.arms.each_ref().map(|arm| arm.name.as_str());
    let starts = problems.map(MotionProblem::start);
    if let Some(met) = Meeting::of(between, starts, names) {
        let outcome = match met.is_proven {
            true => Outcome::Infeasible(Refutation::Starts(met.what)),
            false => Outcome::Unknown(format!("not proven that the arms do not touch at their starts: {}", met.what)),
        };
        return answer(outcome, &mut alone, vec![]);
    }
    let drive = Drive { optimize: Objective::Time, ..settings.options.drive };
    let options = Options { drive, ..settings.options };
    for (arm, CellArm { name, problem, .. }) in cell.arms.iter().enumerate() {
        progress(&format!("planning {name} alone"));
        let plan = plan(problem, &options, Searches::NONE, progress)?;
        let outcome = match plan.outcome() {
            Outcome::Found(_) => None,
            Outcome::Infeasible(PlanRefutation::Motion(proof)) => {
                Some(Outcome::Infeasible(Refutation::Alone { arm, proof: proof.clone() }))
            }
            Outcome::Infeasible(PlanRefutation::Step(_)) => Some(Outcome::Unknown(format!("{name} has steps"))),
            Outcome::Unknown(why) => Some(Outcome::Unknown(format!("{name} alone: {why}"))),
        };
        alone[arm] = Some(plan);
        if let Some(outcome) = outcome {
            return answer(outcome, &mut alone, vec![]);
        }
    }
    let bound = alone.iter().flatten().filter_map(duration_bound).fold(0.0, f64::max);
    let coordinator = Coordinator { pairs: &pairs, drive: settings.options.drive, skew: settings.skew };
    let mut search =
        Search { problems, names, options: settings.options, coordinator, bound, best: None, pairs: 0, tried: vec![] };
    let goals = search.goal_pairs();
    if goals.pairs.is_empty()
        && let Some(what) = goals.refuted
    {
        return answer(Outcome::Infeasible(Refutation::Goals(what)), &mut alone, search.tried);
    }
    let own = alone.each_ref().map(|plan| plan.as_ref().and_then(path_of));
    if let [Some(one), Some(two)] = own {
        progress("coordinating the fastest path of each arm");
        search.consider("the fastest path of each arm alone", [&one, &two])?;
    }
    progress("shaping the motions of both arms");
    let is_shaped = search.shaped(&goals.pairs);
    if search.best.is_none() || !is_shaped {
        progress("planning each arm with the other one at rest");
        search.one_among_the_other(&goals.pairs)?;
        progress("searching with all four joints");
        search.with_all_joints(&goals.pairs)?;
    }
    progress("looking for a greater bound");
    search.raise_bound();
    let Search { best, bound, mut tried, .. } = search;
    let outcome = match best {
        Some(best) => Outcome::Found(coordinator.with_diagram(best)),
        None => {
            progress("looking for a proof of infeasibility");
            match refuted_in_boxes(between, problems, settings.boxes) {
                Ok(boxes) => Outcome::Infeasible(Refutation::Boxes(boxes)),
                Err(why) => {
                    tried.push(why);
                    Outcome::Unknown("neither coordinated motions nor a proof of infeasibility were found".into())
                }
            }
        }
    };
    let plan = answer(outcome, &mut alone, tried)?;
    Ok(CellPlan { lower_bound: plan.lower_bound.map(|known| known.max(bound)), ..plan })
}

/// Returns the motion of an arm alone.
fn alone_of(plan: &Plan) -> Alone {
    let motion = plan.motion().and_then(|(_, answer)| answer.outcome.found());
    let duration = motion.map(|motion| motion.timed.trajectory.duration());
    Alone { duration, lower_bound: duration_bound(plan) }
}

/// Describes the result of an attempt.
pub(crate) fn described(result: &Result<Coordination, Conflict>) -> String {
    match result {
        Ok(found) => format!("{:.3} s", found.duration),
        Err(conflict) => conflict.describe().to_owned(),
    }
}

/// Returns the proven lower bound on the duration of an arm's motion.
fn duration_bound(plan: &Plan) -> Option<f64> {
    let (_, answer) = plan.motion()?;
    answer.outcome.found()?.fastest.map(|fastest| fastest.lower_bound)
}

/// Returns the path of an arm's motion.
fn path_of(plan: &Plan) -> Option<CertifiedPath> {
    let (_, answer) = plan.motion()?;
    Some(answer.outcome.found()?.timed.curve.straight().clone())
}

/// Two arms that are too near to each other.
pub(crate) struct Meeting {
    /// The links, with their distance.
    pub what: String,
    pub is_proven: bool,
}

impl Meeting {
    /// Returns the meeting of two arms at rest. `None` if they are proven to be apart.
    pub fn of(between: &Between, at: [Configuration; 2], names: [&str; 2]) -> Option<Self> {
        let placed = [0, 1].map(|arm| between.at_rest(arm, at[arm]));
        let placed = placed.each_ref();
        let swept = [0, 1].map(|arm| between.swept(arm, at[arm], Deviation::Box([0.0; 2])));
        let distance = between.distance(placed, between.clearance.max(f64::MIN_POSITIVE));
        if distance.least > 0.0 && distance.least >= between.clearance {
            return None;
        }
        let (here, pair) = distance.here?;
        let mut what = between.describe(pair, names);
        let _ = match here {
            depth if depth < 0.0 => write!(what, " overlap by {:.1} mm", -depth * 1e3),
            _ => write!(what, " are {:.1} mm apart", here * 1e3),
        };
        if between.clearance > 0.0 {
            let _ = write!(what, ", less than the clearance of {:.1} mm", between.clearance * 1e3);
        }
        Some(Self { what, is_proven: between.surely_collide(swept.each_ref()) })
    }
}

/// Pairs of goals.
struct GoalPairs {
    /// The pairs at which the arms are apart.
    pairs: Vec<[Configuration; 2]>,
    /// If the arms are proven to collide at all pairs: their links at the first pair.
    refuted: Option<String>,
}

/// The search for paths.
struct Search<'a> {
    problems: [&'a MotionProblem; 2],
    names: [&'a str; 2],
    options: Options,
    coordinator: Coordinator<'a>,
    /// Proven lower bound on the duration, seconds.
    bound: f64,
    best: Option<Coordination>,
    /// Number of pairs of paths that were coordinated.
    pairs: usize,
    tried: Vec<String>,
}

impl Search<'_> {
    /// Returns the pairs of goals.
    fn goal_pairs(&self) -> GoalPairs {
        let goals = self.problems.map(|problem| problem.goals());
        let is_finite = goals.iter().all(|goals| goals.pieces().iter().all(|piece| piece.is_point()));
        let (mut pairs, mut first, mut is_refuted) = (Vec::new(), None, is_finite);
        for one in goals[0].points() {
            for two in goals[1].points() {
                match Meeting::of(self.coordinator.between(), [one, two], self.names) {
                    None => pairs.push([one, two]),
                    Some(meeting) => {
                        is_refuted &= meeting.is_proven;
                        first.get_or_insert(meeting.what);
                    }
                }
            }
        }
        let starts = self.problems.map(MotionProblem::start);
        let time = |pair: &[Configuration; 2]| {
            let of = |arm: usize| {
                let own = self.problems[arm].scene().arm();
                let by = own.topology().displacement(starts[arm], pair[arm]);
                (by[0].abs() / own.joints[0].velocity).max(by[1].abs() / own.joints[1].velocity)
            };
            of(0).max(of(1))
        };
        // The nearest goals come first.
        pairs.sort_by(|a, b| time(a).total_cmp(&time(b)));
        GoalPairs { refuted: first.filter(|_| is_refuted && pairs.is_empty()), pairs }
    }

    /// Returns true if no better motion is worth the effort.
    fn is_content(&self) -> bool {
        self.best.as_ref().is_some_and(|best| best.duration <= self.bound * (1.0 + ACCEPTED_GAP))
    }

    /// Coordinates two paths, and keeps the result if it is the best.
    fn consider(&mut self, what: &str, paths: [&CertifiedPath; 2]) -> Result<(), PlanError> {
        self.pairs += 1;
        let before = self.best.as_ref().map_or(f64::INFINITY, |best| best.duration);
        let result = self.coordinator.along(paths, before)?;
        self.tried.push(format!("{what}: {}", described(&result)));
        self.best = result.ok().or(self.best.take());
        Ok(())
    }

    /// Returns the fastest path of an arm to a goal, among more obstacles.
    fn path(&self, arm: usize, goal: Configuration, others: Vec<Obstacle>) -> Option<CertifiedPath> {
        let problem = self.problems[arm];
        let scene: Scene = problem.scene().changed(|_, workspace| workspace.obstacles.extend(others));
        let problem = MotionProblem::new(scene, problem.start(), goal).ok()?;
        let planner = self.options.planner.with_criterion(Criterion::Time);
        let options = Options { planner, bounded: false, ..self.options };
        let answer = solve(&problem, &options, &mut |_| ());
        Some(answer.outcome.found()?.certified.clone())
    }

    /// Plans one arm among the other: the first to move sees the other at its start, and the second sees it at its goal.
    /// Such paths always have a timing: one motion after the other.
    fn one_among_the_other(&mut self, goals: &[[Configuration; 2]]) -> Result<(), PlanError> {
        for (number, pair) in goals.iter().take(MAX_GOAL_PAIRS).enumerate() {
            if self.is_content() || self.pairs >= MAX_PAIRS {
                return Ok(());
            }
            let of_goals = if goals.len() > 1 { format!(" (IK solutions {})", number + 1) } else { String::new() };
            if goals.len() > 1 {
                let paths = [0, 1].map(|arm| self.path(arm, pair[arm], Vec::new()));
                if let [Some(one), Some(two)] = &paths {
                    self.consider(&format!("the fastest paths to other goals{of_goals}"), [one, two])?;
                }
            }
            for first in 0..2 {
                if self.is_content() {
                    return Ok(());
                }
                let second = 1 - first;
                let (name, other) = (self.names[first], self.names[second]);
                let between = self.coordinator.between();
                let at_start = between.obstacles(second, other, self.problems[second].start());
                let at_goal = between.obstacles(first, name, pair[first]);
                let what = format!("{name} first, {other} after it{of_goals}");
                let found = self.path(first, pair[first], at_start).zip(self.path(second, pair[second], at_goal));
                match found {
                    Some((leading, following)) if first == 0 => self.consider(&what, [&leading, &following])?,
                    Some((leading, following)) => self.consider(&what, [&following, &leading])?,
                    None => self.tried.push(format!("{what}: no path was found")),
                }
            }
        }
        Ok(())
    }

    /// Shapes the motions of both arms at once, from routes in four joints. Returns false if shapes do not consider all limits
    /// of the arms.
    fn shaped(&mut self, goals: &[[Configuration; 2]]) -> bool {
        let between = self.coordinator.between();
        let Some(mut shaping) = Shaping::new(between, self.options.drive, self.coordinator.skew) else { return false };
        let starts = self.problems.map(MotionProblem::start);
        let pairs = &goals[..goals.len().min(MAX_GOAL_PAIRS)];
        let mut last = MIN_SHAPED_ROUTES;
        for (seed, pair) in (0..MAX_SHAPED_ROUTES).zip(pairs.iter().cycle()) {
            if self.is_content() || seed >= last && self.best.is_some() {
                break;
            }
            let Some(route) = joint_route(between, starts, *pair, seed, 0) else { continue };
            let before = self.best.as_ref().map_or(f64::INFINITY, |best| best.duration);
            let shape = shaping.along(&route, before).ok_or(Conflict::Slower);
            let motions = shape.and_then(|shape| shaping.certified(&shape).ok_or(Conflict::NotCertified));
            let found = motions.and_then(|motions| self.coordinator.judged(motions));
            let outcome = described(&found);
            self.tried.push(format!("both arms at once, motion {}: {outcome}", seed + 1));
            if let Ok(found) = found {
                if found.duration < before * (1.0 - WORTHWHILE_GAIN) {
                    last = last.max(2 * seed);
                }
                self.best = Some(found);
            }
        }
        true
    }

    /// Raises the lower bound on the duration: no motions of both arms are as short.
    fn raise_bound(&mut self) {
        let Some(best) = &self.best else { return };
        let goals = self.problems.map(|problem| problem.goals());
        if !goals.iter().all(|goals| goals.pieces().iter().all(|piece| piece.is_point())) {
            return;
        }
        let starts = self.problems.map(MotionProblem::start);
        let points = goals.map(|goals| goals.points().collect::<Vec<_>>());
        let mut target = best.duration;
        let mut left = BOUND_BOXES;
        while target > self.bound * (1.0 + BOUND_RESOLUTION) && left > 0 && !self.is_content() {
            let duration = f64::midpoint(self.bound, target);
            let budget = left.div_ceil(2);
            let mut funnels = Funnels::new(self.coordinator.between(), self.coordinator.skew, budget);
            let mut pairs = points[0].iter().flat_map(|one| points[1].iter().map(move |two| [*one, *two]));
            let is_refuted = pairs.all(|pair| funnels.refute(starts, pair, duration));
            left -= budget - funnels.budget;
            if is_refuted {
                self.bound = duration * (1.0 - BOUND_ROUNDING);
            } else {
                target = duration;
            }
            let outcome = if is_refuted { "proven" } else { "not proven" };
            self.tried.push(format!("no motions of both arms end by {duration:.3} s: {outcome}"));
        }
    }

    /// Searches paths of both arms at once, in four joints.
    fn with_all_joints(&mut self, goals: &[[Configuration; 2]]) -> Result<(), PlanError> {
        let starts = self.problems.map(MotionProblem::start);
        let pairs = &goals[..goals.len().min(MAX_GOAL_PAIRS)];
        for (seed, pair) in (0..JOINT_SEARCHES).zip(pairs.iter().cycle()) {
            if self.is_content() {
                return Ok(());
            }
            let what = format!("search with all four joints, number {}", seed + 1);
            let between = self.coordinator.between();
            let route = joint_route(between, starts, *pair, seed, SHORTCUTS);
            match route.and_then(|route| route.paths(between)) {
                Some([one, two]) => self.consider(&what, [&one, &two])?,
                None => self.tried.push(format!("{what}: no paths were found")),
            }
        }
        Ok(())
    }
}
