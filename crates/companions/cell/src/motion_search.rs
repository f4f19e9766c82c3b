//! The search for the motions of arms without steps: pairs of paths in a fixed order, and a greater lower bound.

use crate::coordinate::{Conflict, Coordination, Coordinator};
use crate::funnel::Funnels;
use crate::joint_tree::joint_route;
use crate::plan::{ACCEPTED_GAP, Meeting, Refutation, described};
use crate::proof::GoalContact;
use crate::shaping::Shaping;
use cplan_engine::PlanError;
use cplan_judge::CertifiedPath;
use cplan_model::space::Configuration;
use cplan_model::{MotionProblem, Obstacle, Scene};
use cplan_solver::{Criterion, Options, solve};

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

/// Rounding error of a bound, as a share of it.
const BOUND_ROUNDING: f64 = 1e-9;

/// Pairs of goals.
pub(crate) struct GoalPairs {
    /// The pairs at which the arms are apart.
    pub pairs: Vec<[Configuration; 2]>,
    /// The proof that the arms collide at all pairs, if they do.
    pub refutation: Option<Refutation>,
}

/// The search for paths.
pub(crate) struct Search<'a> {
    pub problems: [&'a MotionProblem; 2],
    pub names: [&'a str; 2],
    pub options: Options,
    pub coordinator: Coordinator<'a>,
    /// Proven lower bound on the duration, seconds.
    pub bound: f64,
    pub best: Option<Coordination>,
    /// Number of pairs of paths that were coordinated.
    pub pairs: usize,
    pub tried: Vec<String>,
}

impl Search<'_> {
    /// Returns the pairs of goals.
    pub fn goal_pairs(&self) -> GoalPairs {
        let goals = self.problems.map(|problem| problem.goals());
        let is_finite = goals.iter().all(|goals| goals.pieces().iter().all(|piece| piece.is_point()));
        let between = self.coordinator.between();
        let (mut pairs, mut first, mut contacts, mut is_refuted) = (Vec::new(), None, Vec::new(), is_finite);
        for one in goals[0].points() {
            for two in goals[1].points() {
                match Meeting::of(between, [one, two], self.names) {
                    None => pairs.push([one, two]),
                    Some(meeting) => {
                        let parts = meeting.colliding.and_then(|pair| between.link_parts(pair));
                        is_refuted &= parts.is_some();
                        contacts.extend(parts.map(|parts| GoalContact { goals: [one.into(), two.into()], parts }));
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
        let contact = first.filter(|_| is_refuted && pairs.is_empty());
        GoalPairs { refutation: contact.map(|contact| Refutation::Goals { contact, pairs: contacts }), pairs }
    }

    /// Returns true if no better motion is worth the effort.
    fn is_content(&self) -> bool {
        self.best.as_ref().is_some_and(|best| best.duration <= self.bound * (1.0 + ACCEPTED_GAP))
    }

    /// Coordinates two paths, and keeps the result if it is the best.
    pub fn consider(&mut self, what: &str, paths: [&CertifiedPath; 2]) -> Result<(), PlanError> {
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
    pub fn one_among_the_other(&mut self, goals: &[[Configuration; 2]]) -> Result<(), PlanError> {
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
    pub fn shaped(&mut self, goals: &[[Configuration; 2]]) -> bool {
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
    pub fn raise_bound(&mut self) {
        let Some(best) = &self.best else { return };
        let goals = self.problems.map(|problem| problem.goals());
        if !goals.iter().all(|goals| goals.pieces().iter().all(|piece| piece.is_point())) {
            return;
        }
        let starts = self.problems.map(MotionProblem::start);
        let points = goals.map(|goals| goals.points().collect::<Vec<_>>());
        // A greater bound does not matter.
        let greatest = best.duration / (1.0 + ACCEPTED_GAP) * (1.0 + 2.0 * BOUND_ROUNDING);
        if greatest <= self.bound {
            return;
        }
        let ends = [self.bound, greatest];
        let mut funnels = Funnels::new(self.coordinator.between(), self.coordinator.skew, ends, BOUND_BOXES);
        let pairs = points[0].iter().flat_map(|one| points[1].iter().map(move |two| [*one, *two]));
        let proven = funnels.proven(starts, pairs);
        let boxes = BOUND_BOXES - funnels.budget;
        self.tried.push(if proven > self.bound {
            self.bound = proven * (1.0 - BOUND_ROUNDING);
            format!("no motions of both arms end by {:.3} s: proven with {boxes} boxes", self.bound)
        } else {
            format!("a greater bound than {:.3} s: not proven with {boxes} boxes", self.bound)
        });
    }

    /// Searches paths of both arms at once, in four joints.
    pub fn with_all_joints(&mut self, goals: &[[Configuration; 2]]) -> Result<(), PlanError> {
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
