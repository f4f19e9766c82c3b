//! The results of a plan: its figures, its JSON and its files.

mod errors_report;
mod files;
mod json;
mod messages;
mod step_report;

pub use messages::MessageError;
pub(crate) use messages::Messages;
pub(crate) use step_report::{StepReport, step_reports};

use super::plan::Plan;
use cplan_handling::Task;
use cplan_legs::FailedStep;
use cplan_model::Status;
use cplan_model::space::{Metric, Path};
use cplan_motion::{LengthOptimality, SearchReport, Timing, Trajectory};
use cplan_planners::planner::VisibilityGraph;
use cplan_solver::{Bound, Planner, Setting, Settings};

impl Plan {
    /// Returns the reason why there is no motion, or why this is not known. `None` if there is a motion.
    pub fn reason(&self) -> Option<String> {
        match self.task() {
            None => self.motion().and_then(|(_, answer)| answer.reason()),
            Some((task, answer)) => answer.failed().map(|failed| reason(task, failed, self.status())),
        }
    }

    /// Returns the waypoints of the motion, between which its path is straight, before corners are rounded. For a task, returns
    /// those of all motions.
    pub fn waypoints(&self) -> Option<Vec<[f64; 2]>> {
        let mut whole: Vec<[f64; 2]> = Vec::new();
        // Each motion begins where the previous one ends.
        for path in self.found()?.paths {
            let path: Vec<[f64; 2]> = path.waypoints().iter().map(|q| [q[0], q[1]]).collect();
            let shared = usize::from(whole.last() == path.first());
            whole.extend(&path[shared..]);
        }
        Some(whole)
    }

    /// Returns the Euclidean length of the path in joint space. For a task, returns the total length of all its paths.
    pub fn length(&self) -> Option<f64> {
        self.found().map(|found| found.paths.into_iter().map(Path::length).sum())
    }

    /// Returns the duration of the motion, in seconds.
    pub fn duration(&self) -> Option<f64> {
        self.trajectory().map(Trajectory::duration)
    }

    /// Returns a proven lower bound on the distance between arm and obstacles at all times, metres. `None` if there is
    /// no motion, or no obstacle is within reach.
    pub fn clearance(&self) -> Option<f64> {
        self.found().and_then(|found| finite(found.clearance))
    }

    /// Describes the link and the obstacle that come nearest in a single motion.
    pub fn closest(&self) -> Option<String> {
        let (problem, answer) = self.motion()?;
        let nearest = answer.outcome.found()?.timed.curve.nearest()?;
        Some(problem.scene().describe(nearest.contact.pair))
    }

    /// Returns the bounds on the path length of a single motion. `None` if the planner computes none.
    pub fn bound(&self) -> Option<Bound> {
        self.motion().and_then(|(_, answer)| answer.bound())
    }

    /// Returns how the motion passes moving obstacles. `None` if no obstacle moves.
    pub fn timing(&self) -> Option<&Timing> {
        self.found()?.timing
    }

    /// Returns how the planner searched its grid. For a roadmap, reports only an unusual search.
    pub fn search(&self) -> Option<SearchReport> {
        search_used(&self.options().planner)
    }
}

/// Describes the failing step and the reason in a sentence.
fn reason(task: &Task, FailedStep { step, .. }: &FailedStep, status: Status) -> String {
    let cycle = if step.cycle > 1 { format!(" of cycle {}", step.cycle) } else { String::new() };
    let which = format!("step {}{cycle}, {} ({})", step.number, step.action.describe(&task.objects), step.place);
    match status {
        Status::Infeasible => {
            format!("infeasible: {which} has no motion, whatever the choices before it (proven)")
        }
        _ => format!("unknown: neither a motion for {which} nor a proof that none exists was found"),
    }
}

/// Returns a value if it is finite. JSON has no infinity.
pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Converts a bound to the form of the result.
fn optimum(bound: Bound) -> LengthOptimality {
    let (metric, weights) = match bound.metric {
        Metric::Euclidean => ("euclidean", None),
        Metric::Weighted { weights } => ("weighted", Some(weights)),
        Metric::Time { .. } => ("time", None),
        Metric::Motor { .. } => ("motor", None),
    };
    LengthOptimality { metric, weights, length: bound.upper, lower_bound: bound.lower, gap: finite(bound.gap()) }
}

/// Returns how a planner searches its grid. For a roadmap, reports only an unusual search.
fn search_used(planner: &Planner) -> Option<SearchReport> {
    let Settings { grid_search, ties, forward, neighborhood, .. } = planner.settings();
    if planner.method().reads(Setting::GridSearch) {
        return Some(SearchReport {
            search: grid_search.name(),
            ties: (!ties.is_default()).then(|| ties.name()),
            neighbors: Some(neighborhood.count()),
            backward: forward.then_some(false),
            graph: None,
        });
    }
    let graph = planner.graph().filter(|graph| *graph == VisibilityGraph::Full).map(VisibilityGraph::name);
    let search = planner.search().filter(|search| !search.is_default() || graph.is_some())?;
    let backward = Some(search.backward);
    Some(SearchReport { search: search.order.name(), ties: None, neighbors: None, backward, graph })
}
