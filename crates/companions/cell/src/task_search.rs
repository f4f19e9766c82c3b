//! The search for a cell whose arms have steps: sequences of each arm alone, coordinated on the diagram of their times.

use crate::Cell;
use crate::assignment::{self, Assignment};
use crate::coordinate::{Coordination, Coordinator, PlannedSteps};
use crate::file_steps::with_obstacles;
use crate::legs::Legs;
use crate::plan::{ACCEPTED_GAP, Alone, CellPlan, Meeting, Refutation, Settings, described};
use crate::sequence::Sequence;
use crate::stage::StagePairs;
use crate::variants::{Variant, variants};
use cplan_engine::PlanError;
use cplan_handling::Task;
use cplan_legs::TaskAnswer;
use cplan_model::{Obstacle, Outcome, Scene};
use std::rc::Rc;

/// Greatest number of pairs of other sequences to coordinate.
const MAX_PAIRS: usize = 16;

/// Greatest number of pairs of other sequences for each of several assignments.
const MAX_PAIRS_OF_ASSIGNMENT: usize = 6;

/// Greatest number of assignments whose sequences are coordinated.
const MAX_ASSIGNMENTS: usize = 6;

/// The search for the sequences of both arms.
pub(crate) struct TaskSearch<'a> {
    cell: &'a Cell,
    settings: &'a Settings,
    scenes: [&'a Scene; 2],
    /// The best motions, with their sequences.
    best: Option<(Coordination, [Rc<Planned>; 2])>,
    tried: Vec<String>,
}

/// A task with its answer.
struct Planned {
    /// Difference from other sequences, in a few words.
    what: String,
    task: Task,
    answer: TaskAnswer,
    sequence: Option<Sequence>,
}

impl Planned {
    /// Returns true if the arm moves along the same paths.
    fn moves_like(&self, other: &Self) -> bool {
        let paths = |own: &Self| own.answer.legs.iter().map(|leg| leg.path().clone()).collect::<Vec<_>>();
        paths(self) == paths(other)
    }
}

/// The best sequences that were found for an assignment.
enum Assigned {
    /// The sequences of both arms alone, and whether they led to motions.
    Planned { alone: Box<[Alone; 2]>, is_better: bool },
    /// An arm alone cannot do its steps, or no sequence was found.
    Failed(Outcome<(), Refutation>),
}

/// Plans a cell whose arms have steps.
///
/// # Errors
/// Motions that cannot be timed.
pub(crate) fn plan_tasks(
    cell: &Cell,
    tasks: [&Task; 2],
    settings: &Settings,
    progress: &mut dyn FnMut(&str),
) -> Result<CellPlan, PlanError> {
    let scenes = cell.arms.each_ref().map(|arm| arm.problem.scene());
    let mut search = TaskSearch { cell, settings, scenes, best: None, tried: vec![] };
    let assignments = assignment::assignments(cell, tasks, settings.skew);
    let least = assignments.iter().map(|assignment| assignment.bound).fold(f64::INFINITY, f64::min);
    let mut plan = CellPlan {
        outcome: Outcome::Unknown("no assignment of the objects was planned".into()),
        alone: [None, None],
        lower_bound: Some(least),
        assignment: None,
        tried: vec![],
    };
    let count = assignments.len();
    for (number, assignment) in assignments.iter().enumerate() {
        let known = search.best.as_ref().map_or(f64::INFINITY, |(best, _)| best.duration);
        if assignment.bound >= known || known <= least * (1.0 + ACCEPTED_GAP) {
            search.tried.push(format!(
                "{} of {count} assignments cannot be faster, or not by more than {:.0} %",
                count - number,
                100.0 * ACCEPTED_GAP
            ));
            break;
        }
        if number >= MAX_ASSIGNMENTS {
            search.tried.push(format!("{} of {count} assignments were not tried", count - number));
            break;
        }
        if count > 1 {
            search.tried.push(assignment.describe(cell));
        }
        match search.assigned(assignment, progress)? {
            Assigned::Planned { alone, is_better } if is_better || plan.alone[0].is_none() => {
                plan.alone = alone.map(Some);
                plan.assignment = (!cell.shared.is_empty()).then(|| assignment.names(cell));
            }
            Assigned::Failed(Outcome::Infeasible(proof)) if count == 1 => plan.outcome = Outcome::Infeasible(proof),
            Assigned::Failed(Outcome::Unknown(why)) if search.best.is_none() => plan.outcome = Outcome::Unknown(why),
            Assigned::Planned { .. } | Assigned::Failed(_) => {}
        }
    }
    if let Outcome::Unknown(why) = &mut plan.outcome
        && plan.alone[0].is_some()
    {
        *why = "no coordination of the sequences that were tried was found".into();
    }
    let best = search.finished();
    plan.tried = search.tried;
    if let Some(best) = best {
        // Both may be the same sum of times, but in another order.
        plan.lower_bound = Some(least.min(best.duration));
        plan.outcome = Outcome::Found(best);
    }
    Ok(plan)
}

impl TaskSearch<'_> {
    /// Plans the tasks of both arms, and coordinates their sequences.
    fn assigned(&mut self, assignment: &Assignment, progress: &mut dyn FnMut(&str)) -> Result<Assigned, PlanError> {
        let mut planned = Vec::new();
        for (arm, task) in assignment.tasks.iter().enumerate() {
            let name = &self.cell.arms[arm].name;
            progress(&format!("planning the steps of {name} alone"));
            let own = self.planned(Variant { what: "fastest sequence alone".into(), task: task.clone() }, progress);
            match &own.answer.outcome {
                Outcome::Found(_) => {}
                Outcome::Infeasible(failed) => {
                    let failed = Box::new(failed.clone());
                    self.tried.push(format!("{name} alone: infeasible, proven"));
                    return Ok(Assigned::Failed(Outcome::Infeasible(Refutation::Step { arm, failed })));
                }
                Outcome::Unknown(failed) => {
                    let step = failed.step.action.describe(&task.objects);
                    let why =
                        format!("{name} alone: step {}, {step}: {}", failed.step.number, failed.reasons.join("; "));
                    self.tried.push(why.clone());
                    return Ok(Assigned::Failed(Outcome::Unknown(why)));
                }
            }
            planned.push(Rc::new(own));
        }
        let [one, two] = <[Rc<Planned>; 2]>::try_from(planned).map_err(|_| PlanError::Missing("tasks"))?;
        let alone = [&one, &two].map(|own| Alone {
            duration: own.answer.outcome.found().map(|motion| motion.seconds()),
            lower_bound: Some(own.answer.least_seconds()),
            trajectory: None,
        });
        if let Some(outcome) = self.starts([&one, &two]) {
            return Ok(Assigned::Failed(outcome));
        }
        let before = self.best.as_ref().map(|(best, _)| best.duration);
        self.coordinated([one, two], assignment.bound, progress)?;
        Ok(Assigned::Planned {
            alone: Box::new(alone),
            is_better: self.best.as_ref().map(|(best, _)| best.duration) != before,
        })
    }

    /// Plans a task alone.
    fn planned(&self, Variant { what, task }: Variant, progress: &mut dyn FnMut(&str)) -> Planned {
        let answer = cplan_tasks::plan(&task, &self.settings.options, progress);
        let sequence = answer.outcome.found().and_then(|_| Sequence::new(&task, &answer.legs));
        Planned { what, task, answer, sequence }
    }

    /// Returns the outcome if the arms collide at their starts.
    fn starts(&self, both: [&Planned; 2]) -> Option<Outcome<(), Refutation>> {
        let [Some(one), Some(two)] = both.map(|own| own.sequence.as_ref()) else {
            return Some(Outcome::Unknown("an arm without steps is not proven to stand free".into()));
        };
        let names = self.cell.arms.each_ref().map(|arm| arm.name.as_str());
        let pairs = self.pairs([one, two], both.map(|own| &own.task));
        let at = both.map(|own| own.task.start);
        let between = pairs.between([0, 0]);
        Some(Meeting::of(between, at, names)?.at_starts(between))
    }

    /// Returns the pairs of stages of two sequences.
    fn pairs(&self, both: [&Sequence; 2], tasks: [&Task; 2]) -> StagePairs<'_> {
        let stages = both.map(|own| &own.stages[..]);
        let precedences = Sequence::precedences(both, tasks);
        let clearance = self.scenes[0].workspace().clearance;
        StagePairs::new(self.scenes, stages, self.cell.is_one_robot, clearance, precedences)
    }

    /// Coordinates sequences of both arms: the fastest of each alone, then others, the shorter ones first.
    fn coordinated(
        &mut self,
        alone: [Rc<Planned>; 2],
        least: f64,
        progress: &mut dyn FnMut(&str),
    ) -> Result<(), PlanError> {
        progress("coordinating the sequences of both arms");
        self.consider(&alone)?;
        if self.is_content(least) {
            return Ok(());
        }
        progress("planning other sequences of each arm");
        let mut candidates = [vec![alone[0].clone()], vec![alone[1].clone()]];
        for arm in 0..2 {
            let mut others = variants(&alone[arm].task, &alone[arm].answer.legs);
            let other = &self.cell.arms[1 - arm].name;
            others.extend([(false, "at its start"), (true, "at its end")].map(|(is_after, when)| Variant {
                what: format!("{other} at rest {when}"),
                task: with_obstacles(&alone[arm].task, &self.resting(&alone, 1 - arm, is_after)),
            }));
            for variant in others {
                let own = self.planned(variant, progress);
                if own.sequence.is_none() {
                    self.tried.push(format!("{}, {}: no sequence was found", self.cell.arms[arm].name, own.what));
                } else if candidates[arm].iter().all(|known| !known.moves_like(&own)) {
                    candidates[arm].push(Rc::new(own));
                }
            }
        }
        let both = candidates[0].iter().flat_map(|one| candidates[1].iter().map(move |two| [one.clone(), two.clone()]));
        let mut pairs: Vec<[Rc<Planned>; 2]> = both.skip(1).collect();
        pairs.sort_by(|a, b| longest(a).total_cmp(&longest(b)));
        let most = if self.cell.shared.is_empty() { MAX_PAIRS } else { MAX_PAIRS_OF_ASSIGNMENT };
        for pair in pairs.iter().take(most) {
            if self.is_content(least) || self.best.as_ref().is_some_and(|(best, _)| longest(pair) >= best.duration) {
                break;
            }
            self.consider(pair)?;
        }
        Ok(())
    }

    /// Returns true if no better motion of this assignment is worth the effort.
    fn is_content(&self, least: f64) -> bool {
        self.best.as_ref().is_some_and(|(best, _)| best.duration <= least * (1.0 + ACCEPTED_GAP))
    }

    /// Returns an arm and its objects at rest as obstacles: before its first step, or after its last one.
    fn resting(&self, alone: &[Rc<Planned>; 2], arm: usize, is_after: bool) -> Vec<Obstacle> {
        let [Some(one), Some(two)] = alone.each_ref().map(|own| own.sequence.as_ref()) else { return Vec::new() };
        let Planned { task, .. } = &*alone[arm];
        let own = [one, two][arm];
        let pairs = self.pairs([one, two], alone.each_ref().map(|own| &own.task));
        let last = [one, two].map(|own| own.stages.len() - 1);
        let (stages, at) = if is_after { (last, own.end()) } else { ([0, 0], task.start) };
        pairs.between(stages).obstacles(arm, &self.cell.arms[arm].name, at)
    }

    /// Coordinates two sequences, and keeps the result if it is the best.
    fn consider(&mut self, both: &[Rc<Planned>; 2]) -> Result<(), PlanError> {
        let before = self.best.as_ref().map_or(f64::INFINITY, |(best, _)| best.duration);
        let Some(result) = self.with_coordinator(both, |coordinator, legs| coordinator.of_legs(legs, before)) else {
            return Ok(());
        };
        let result = result?;
        let own = |arm: usize| format!("{}, {}", self.cell.arms[arm].name, both[arm].what);
        let what = format!("{}; {}", own(0), own(1));
        self.tried.push(format!("{what}: {}", described(&result)));
        if let Ok(found) = result {
            self.best = Some((found, both.clone()));
        }
        Ok(())
    }

    /// Adds the diagram and the signals to the best motions.
    fn finished(&mut self) -> Option<Coordination> {
        let (best, both) = self.best.take()?;
        let found = self.with_coordinator(&both, |coordinator, _| coordinator.with_diagram(best))?;
        let planned = both.map(|own| PlannedSteps { task: own.task.clone(), legs: own.answer.legs.clone() });
        Some(Coordination { planned: Some(planned), ..found })
    }

    /// Calls `f` with the coordinator of two sequences and their legs.
    fn with_coordinator<T>(&self, both: &[Rc<Planned>; 2], f: impl FnOnce(&Coordinator, [&Legs; 2]) -> T) -> Option<T> {
        let [Some(one), Some(two)] = both.each_ref().map(|own| own.sequence.as_ref()) else { return None };
        let pairs = self.pairs([one, two], both.each_ref().map(|own| &own.task));
        let coordinator = Coordinator { pairs: &pairs, drive: self.settings.options.drive, skew: self.settings.skew };
        Some(f(&coordinator, [&one.legs, &two.legs]))
    }
}

/// Returns the duration of the longer of two sequences, seconds.
fn longest(both: &[Rc<Planned>; 2]) -> f64 {
    both.iter().map(|own| own.answer.duration()).fold(0.0, f64::max)
}
