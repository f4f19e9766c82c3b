//! The summary of a single motion for people.

use super::summary::{Line, configuration, torque};
use cplan_blockers::{BlockingSet, MotionQuestion, blocking_set};
use cplan_engine::{Motion, Plan};
use cplan_model::space::{Configuration, Metric};
use cplan_model::{Arm, MotionProblem, Outcome, Scene};
use cplan_motion::{CertifiedCurve, DurationOptimality, PlaceTime, TimedMotion, Timing, Wait};
use cplan_planners::cspace::{Grid, Proves};
use cplan_planners::planner::{Proposal, VisibilityGraph};
use cplan_solver::{Answer, Bound, GridSpace, Space};
use cplan_text::{counted, length_down, percent, round_down};

/// Returns the lines about the result. The verdict comes first.
pub(super) fn result_lines(problem: &MotionProblem, answer: &Answer<Motion>) -> Vec<Line> {
    match &answer.outcome {
        Outcome::Found(motion) => motion_lines(problem, answer, motion),
        Outcome::Infeasible(proof) => vec![("result", format!("infeasible: there is no path; {}", proof.describe()))],
        Outcome::Unknown(unknown) => vec![("result", format!("unknown: {}", unknown.reason))],
    }
}

/// Returns the lines about the work of the planner.
pub(super) fn work_lines(plan: &Plan, answer: &Answer<Motion>) -> Vec<Line> {
    let graph = plan.options().planner.graph();
    let has_all_nodes = graph == Some(VisibilityGraph::Full);
    let graph = graph.map(|graph| format!("{} graph", graph.name()));
    let search: Vec<String> = plan.search().iter().map(ToString::to_string).chain(graph).collect();
    let search = (!search.is_empty()).then(|| format!(" ({})", search.join(", ")));
    let space = plan.options().planner.space().and_then(GridSpace::reported_name).map(|space| format!(", {space}"));
    let how = search.unwrap_or_default() + &space.unwrap_or_default();
    let mut lines = vec![("planner", format!("{}{how}: {}", answer.method, answer.run.size))];
    lines.extend(has_all_nodes.then(|| ("nodes", FULL_GRAPH_NODES.to_owned())));
    lines.extend(cells(plan, answer));
    lines.extend(second_attempt(plan, answer).map(|text| ("attempts", text)));
    lines.extend(exact(plan, answer));
    lines.extend(answer.run.note.map(|note| ("planner", note.to_string())));
    lines
}

/// The nodes of the full visibility graph.
const FULL_GRAPH_NODES: &str = "start, goal, and the corners of C-obstacles (cut off at the joint limits)";

/// Returns the lines about a motion that was found, with the properties that are proven.
fn motion_lines(problem: &MotionProblem, answer: &Answer<Motion>, motion: &Motion) -> Vec<Line> {
    let (scene, arm, path) = (problem.scene(), problem.scene().arm(), motion.path.path());
    let TimedMotion { curve, trajectory } = &motion.timed;
    let kind = if answer.method.has_own_path() { format!(", {} path", answer.path_kind) } else { String::new() };
    let pieces = counted(path.segments().count(), "straight piece");
    let mut lines =
        vec![("result", format!("found and certified: {pieces}, length {}{kind}", arm.format_length(path.length())))];
    if problem.goals().pieces().iter().any(|goals| !goals.is_point()) {
        lines.push(("reached", configuration(arm, path.goal())));
    }
    let is_timed = motion.timing.is_some();
    lines.extend(motion.path.bound.iter().map(|bound| ("optimum", optimum(arm, bound, is_timed))));
    let (samples, corners) = (trajectory.time.len(), corners(curve));
    lines.push(("motion", format!("{:.3} s, {samples} samples{corners}", trajectory.duration())));
    lines.extend(torque(arm, trajectory));
    lines.extend(motion.fastest.as_ref().map(|fastest| ("fastest", least_time(fastest))));
    lines.push(("clearance", clearance(scene, curve)));
    lines
}

/// Returns a line with the number of cells. `None` if the planner used the requested number.
fn cells(plan: &Plan, answer: &Answer<Motion>) -> Option<Line> {
    let Space::Grid(grid) = &answer.space else { return None };
    let asked = plan.options().planner.cells().filter(|asked| asked.0 != grid.cells)?;
    let [used, asked] = [grid.cells, asked.0].map(|[a, b]| format!("{a} x {b}"));
    Some(("cells", format!("{used}, because {asked} cells show no certified path")))
}

/// Describes the planner's cells if they are from its second attempt, in which the centre of a cell decides whether the cell is
/// free. `None` if the cells are as requested.
pub(super) fn second_attempt(plan: &Plan, answer: &Answer<Motion>) -> Option<String> {
    let is_second =
        |grid: &Grid| grid.proves == Proves::Sampled && plan.options().planner.space() == Some(GridSpace::Rows);
    let Space::Grid(grid) = &answer.space else { return None };
    is_second(grid).then(|| {
        let [a, b] = grid.cells;
        format!("second attempt with {a} x {b} cells: a cell counts as free if its centre is free; wholly free cells show no certified path")
    })
}

/// Returns a line about planning among exact polygons. `None` if the planner uses none, or found no path.
fn exact(plan: &Plan, answer: &Answer<Motion>) -> Option<Line> {
    let Space::Regions(_) = &answer.space else { return None };
    let is_found = matches!(answer.outcome, Outcome::Found(_));
    let Proposal::Found(path) = &answer.run.outcome else { return None };
    (plan.options().planner.is_exact() && is_found).then(|| {
        let length = plan.arm().format_length(path.length());
        let summary_lines = match answer.history[..] {
            [] => "the path was planned among the exact polygons and touches none".to_owned(),
            _ => format!(
                "the path among the exact polygons has length {length}, but touches them; the certified path avoids \
                 slightly grown polygons"
            ),
        };
        ("exact", summary_lines)
    })
}

/// Number of boxes that each decision about blocking obstacles may examine. `cplan explain` searches longer.
const BOXES_PER_DECISION: usize = 500;

/// Largest number of pairs of shapes for which blocking obstacles are determined. With more pairs, the decisions can
/// take seconds.
const MAX_PAIRS: usize = 1000;

/// Returns the obstacles that block the motion, if there is no motion and the search takes milliseconds. `cplan explain` reports
/// more.
pub(super) fn blocked_by(problem: &MotionProblem, answer: &Answer<Motion>) -> Option<Line> {
    answer.outcome.infeasible()?;
    let summary_lines = blocking(problem, answer).map(|set| set.describe(problem.scene()));
    Some(("blocked", summary_lines.unwrap_or_else(|| "unknown; `cplan explain` takes more time to find out".into())))
}

/// Returns the elements that block the motion, if there is no motion and the search takes milliseconds.
pub(super) fn blocking(problem: &MotionProblem, answer: &Answer<Motion>) -> Option<BlockingSet> {
    let (proof, scene) = (answer.outcome.infeasible()?, problem.scene());
    let is_small = scene.pairs().len() <= MAX_PAIRS;
    let set =
        is_small.then(|| blocking_set(&MotionQuestion::from(problem), Some(proof.clone()), [BOXES_PER_DECISION; 2]));
    set.filter(|set| set.is_irreducible() && !set.blockers.is_empty())
}

/// Describes the clearance of the motion, and the place nearest to an obstacle.
fn clearance(scene: &Scene, curve: &CertifiedCurve) -> String {
    match curve.nearest() {
        Some(nearest) => format!(
            "{} proven; closest: {} at {}",
            length_down(curve.clearance()),
            scene.describe(nearest.contact.pair),
            configuration(scene.arm(), nearest.at)
        ),
        None => "no obstacle within reach".into(),
    }
}

/// Describes how the motion avoids moving obstacles. `plane` has the reasons for its waits.
pub(super) fn among_movers(arm: &Arm, timing: &Timing, plane: Option<&PlaceTime>) -> Vec<Line> {
    let Timing { obstacles, ways, waits, clearance, free_until } = timing;
    let kept =
        clearance.map_or_else(|| "all of them out of reach".into(), |kept| format!("{} proven", length_down(kept)));
    let stays = free_until.map_or_else(|| "for ever".into(), |until| format!("until {until:.3} s"));
    let tried = counted(*ways, "route");
    let mut lines = vec![(
        "moving",
        format!("{}, {kept}; {tried} tried; the arm may stay at the goal {stays}", counted(*obstacles, "obstacle")),
    )];
    lines.extend(plane.into_iter().flat_map(|plane| plane.reasons(waits)).map(|reason| {
        let Wait { from, to, at } = reason.wait;
        let place = configuration(arm, Configuration::from(at));
        ("waits", format!("{}: from {from:.3} to {to:.3} s at {place}", reason.words()))
    }));
    lines
}

/// Describes how the motion passes the path's corners. Empty if there are none.
fn corners(curve: &CertifiedCurve) -> String {
    let radii = curve.radii();
    let corners = radii.len().saturating_sub(2);
    let blended = radii.iter().filter(|radius| **radius > 0.0).count();
    match blended {
        _ if corners == 0 => String::new(),
        0 => format!("; stops at {}", counted(corners, "corner")),
        _ => {
            let largest = radii.iter().copied().fold(0.0, f64::max);
            format!("; {blended} of {corners} corners blended, radius up to {largest:.4}")
        }
    }
}

/// Describes how near the motion's duration is to the least possible one.
fn least_time(fastest: &DurationOptimality) -> String {
    let DurationOptimality { lower_bound, gap, .. } = *fastest;
    let longer = gap.map_or_else(String::new, |gap| format!(", so at most {} longer than the fastest", percent(gap)));
    format!("every motion takes at least {} s (proven){longer}", round_down(lower_bound, 3))
}

/// Describes how near the path is to the optimum. Among moving obstacles, the bound says little, because it ignores them.
fn optimum(arm: &Arm, bound: &Bound, is_among_movers: bool) -> String {
    let Bound { metric, lower, upper } = *bound;
    let measure = match metric {
        Metric::Euclidean => format!("length {}", arm.format_length(upper)),
        Metric::Weighted { weights: [a, b] } => format!("weighted length {upper:.4} (weights {a}, {b})"),
        Metric::Time { .. } => format!("{upper:.4} s at top speed"),
        Metric::Motor { .. } => format!("length in motor angles {upper:.4} rad"),
    };
    let (lower, gap) = (round_down(lower, 4), percent(bound.gap()));
    if is_among_movers {
        return format!("{measure}; without the moving obstacles, at least {lower} (proven)");
    }
    format!("{measure}; every path has at least {lower} (proven), so at most {gap} longer than the shortest")
}
