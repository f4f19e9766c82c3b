//! Plans cells: the arms alone, then together, then proofs of infeasibility.

use crate::between::Between;
use crate::coordinate::{Conflict, Coordination, Coordinator};
use crate::motion_search::Search;
use crate::proof::{BoxProof, GoalContact, LinkPart};
use crate::refutation::refuted_in_boxes;
use crate::stage::StagePairs;
use crate::straighten::with_fewer_corners;
use crate::task_search::plan_tasks;
use crate::{Cell, CellArm};
use cplan_engine::{Plan, PlanError, Refutation as PlanRefutation, Searches, plan};
use cplan_judge::{CertifiedPath, CheckedProof, Deviation};
use cplan_legs::FailedStep;
use cplan_model::space::Configuration;
use cplan_model::{MotionProblem, Outcome, Status};
use cplan_motion::{Drive, Objective, Trajectory};
use cplan_solver::Options;
use std::fmt::Write as _;

/// Gap between the duration and its lower bound at which the search ends, as a share of the bound.
pub(crate) const ACCEPTED_GAP: f64 = 0.02;

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
    /// The arms collide at their starts.
    Starts {
        /// The links, in words.
        contact: String,
        /// The colliding part of each arm. `None` if objects collide.
        parts: Option<[LinkPart; 2]>,
    },
    /// The arms collide at every pair of their goals.
    Goals {
        /// The links at the first pair, in words.
        contact: String,
        /// All pairs of goals.
        pairs: Vec<GoalContact>,
    },
    /// Boxes of collisions in four joints separate the starts from all goals.
    Boxes(BoxProof),
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
    /// For each arm, the names of the shared objects that it moves. `None` if the cell has no shared objects.
    pub assignment: Option<[Vec<String>; 2]>,
    /// Attempts with their results, in words, in order.
    pub tried: Vec<String>,
}

/// The motion of an arm without the other arm.
#[derive(Debug, Clone, PartialEq)]
pub struct Alone {
    /// Duration of the fastest motion that was found, seconds. `None` if none was found.
    pub duration: Option<f64>,
    /// Proven lower bound on the duration of every motion, seconds. `None` if it is not known.
    pub lower_bound: Option<f64>,
    /// The fastest motion that was found. `None` if the arm has steps, or if there is no such motion.
    pub trajectory: Option<Trajectory>,
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
        return answer(met.at_starts(between), &mut alone, vec![]);
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
    if let Some(refutation) = goals.refutation {
        return answer(Outcome::Infeasible(refutation), &mut alone, search.tried);
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
    if drive.blend == 0.0
        && let Some(best) = search.best.take()
    {
        progress("removing corners, at which the arms stop");
        let straighter = with_fewer_corners(&coordinator, best)?;
        search.tried.push(format!("with fewer corners: {:.3} s", straighter.duration));
        search.best = Some(straighter);
    }
    progress("looking for a greater bound");
    search.raise_bound();
    let Search { best, bound, mut tried, .. } = search;
    let outcome = match best {
        Some(best) => Outcome::Found(coordinator.with_diagram(best)),
        None => {
            progress("looking for a proof of infeasibility");
            match refuted_in_boxes(between, problems, settings.boxes) {
                Ok(proof) => Outcome::Infeasible(Refutation::Boxes(proof)),
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
    let trajectory = motion.map(|motion| motion.timed.trajectory.clone());
    Alone { duration: trajectory.as_ref().map(Trajectory::duration), lower_bound: duration_bound(plan), trajectory }
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
    /// The bodies that are proven to collide. `None` if it is not proven that any do.
    pub colliding: Option<[usize; 2]>,
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
        Some(Self { what, colliding: between.colliding_pair(swept.each_ref()) })
    }

    /// Returns the outcome for a meeting at the starts.
    pub fn at_starts<F>(self, between: &Between) -> Outcome<F, Refutation> {
        match self.colliding {
            Some(pair) => {
                Outcome::Infeasible(Refutation::Starts { contact: self.what, parts: between.link_parts(pair) })
            }
            None => Outcome::Unknown(format!("not proven that the arms do not touch at their starts: {}", self.what)),
        }
    }
}
