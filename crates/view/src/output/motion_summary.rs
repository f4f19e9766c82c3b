//! The summary of a single motion for people.

use super::summary::{Line, Told, configuration, field, goal_lines, non_empty, torque};
use cplan_core::model::{Arm, Scene};
use cplan_core::planner::Proposal;
use cplan_core::space::{Configuration, Metric};
use cplan_engine::explain::{BlockingSet, Question, blocking_set};
use cplan_engine::{Answer, Bound, MotionPlan, Plan, Space, Timing, Verdict, Wait};
use cplan_motion::CertifiedCurve;
use cplan_motion::Fastest;
use cplan_text::{at_least, counted, percent};

/// What the planner found and did; start and goals.
pub(super) fn told(whole: &Plan, plan: &MotionPlan) -> Told {
    let (scene, arm) = (plan.problem.scene(), whole.arm());
    let moving = match scene.workspace().movers.len() {
        0 => String::new(),
        count => format!(", {count} moving"),
    };
    let obstacles = counted(scene.workspace().obstacles.len(), "obstacle") + &moving;
    let mut asked = vec![
        ("world", format!("{}, {obstacles}", non_empty(&scene.workspace().name))),
        ("start", configuration(arm, plan.problem.start())),
    ];
    asked.extend(goal_lines(arm, plan.problem.goals()));
    Told { found: found(whole, plan), asked }
}

fn found(whole: &Plan, plan: &MotionPlan) -> Vec<Line> {
    let (MotionPlan { problem, answer, curve, timing }, report) = (plan, whole.report());
    let mut lines = Vec::new();
    match &answer.verdict {
        Verdict::Found(certified) => {
            let path = certified.path();
            let kind = if answer.method.has_own_path() { format!(", {} path", answer.path) } else { String::new() };
            let found = {
                let pieces = counted(path.segments().count(), "straight piece");
                format!("found and certified: {pieces}, length {:.4}{kind}", path.length())
            };
            lines.push(("result", found));
            if problem.goals().pieces().iter().any(|goals| !goals.is_point()) {
                lines.push(("reached", configuration(whole.arm(), path.goal())));
            }
            if let Some(bound) = &answer.bound {
                lines.push(("optimum", optimum(bound)));
            }
        }
        Verdict::Infeasible(_) => {
            lines.push(("result", format!("there is no path; {}", report.reason.as_deref().unwrap_or_default())));
        }
        Verdict::Unknown(reason) => lines.push(("result", format!("unknown: {reason}"))),
    }
    if let (Some(curve), Some(trajectory)) = (curve, whole.trajectory()) {
        let (samples, corners) = (trajectory.time.len(), corners(curve));
        lines.push(("motion", format!("{:.3} s, {samples} samples{corners}", trajectory.duration())));
        lines.extend(torque(whole.arm(), trajectory));
        lines.extend(report.fastest.as_ref().map(|fastest| ("fastest", least_time(fastest))));
        lines.push(("clearance", clearance(problem.scene(), curve)));
        lines.extend(timing.iter().flat_map(|timing| among_movers(whole.arm(), timing)));
    }
    let graph = whole.options().planner.graph().map(|graph| format!("{} graph", graph.name()));
    let search: Vec<String> = report.search.iter().map(ToString::to_string).chain(graph).collect();
    let search = (!search.is_empty()).then(|| format!(" ({})", search.join(", ")));
    let space = report.space.map(|space| format!(", {space}"));
    let how = search.unwrap_or_default() + &space.unwrap_or_default();
    lines.push(("planner", format!("{}{how}: {}", answer.method, answer.run.size)));
    lines.extend(cells(whole, answer));
    lines.extend(exact(whole, answer));
    lines.extend(answer.run.note.map(|note| ("planner", note.to_string())));
    lines.extend(field(whole.options()));
    lines
}

/// How many cells there are, if they are not those that were asked for.
fn cells(whole: &Plan, answer: &Answer) -> Option<Line> {
    let Space::Grid(grid) = &answer.space else { return None };
    let asked = whole.options().planner.cells().filter(|asked| asked.0 != grid.cells)?;
    let [used, asked] = [grid.cells, asked.0].map(|[a, b]| format!("{a} x {b}"));
    Some(("cells", format!("{used}: {asked} show no certified path")))
}

/// What became of the attempt among exact polygons.
fn exact(whole: &Plan, answer: &Answer) -> Option<Line> {
    let Space::Regions(_) = &answer.space else { return None };
    let is_found = matches!(answer.verdict, Verdict::Found(_));
    let Proposal::Found(path) = &answer.run.outcome else { return None };
    (whole.options().planner.is_exact() && is_found).then(|| {
        let length = path.length();
        let told = match answer.history[..] {
            [] => "the path lies among the exact polygons and touches none".to_owned(),
            _ => format!(
                "length {length:.4} among the exact polygons, but that path touches them, which is contact; the certified one keeps clear \
                 of polygons grown by a little"
            ),
        };
        ("exact", told)
    })
}

/// Boxes that are looked at for each decision on what is in the way: what takes more is left to `cplan explain`.
const BOXES: usize = 500;

/// Among more pairs of shapes the decisions may take seconds.
const FEW_PAIRS: usize = 1000;

/// What is in the way, if there is no motion and that is soon told: some milliseconds. `cplan explain` has more to say.
pub(super) fn blocked_by(plan: &MotionPlan) -> Option<Line> {
    let (proof, scene) = (plan.answer.verdict.proof()?, plan.problem.scene());
    let is_small = scene.pairs().len() <= FEW_PAIRS;
    let set = is_small.then(|| blocking_set(&Question::from(&plan.problem), Some(proof.clone()), [BOXES; 2]));
    let told = set.filter(BlockingSet::is_irreducible).map(|set| set.describe(scene));
    Some(("blocked by", told.unwrap_or_else(|| "what `cplan explain` tells".into())))
}

/// What the motion keeps, and where it comes nearest.
fn clearance(scene: &Scene, curve: &CertifiedCurve) -> String {
    match curve.nearest() {
        Some(nearest) => format!(
            "{} m proven; closest: {} at {}",
            at_least(curve.clearance(), 6),
            scene.describe(nearest.contact.pair),
            configuration(scene.arm(), nearest.at)
        ),
        None => "nothing can be hit".into(),
    }
}

/// How the motion gets by what moves.
pub(super) fn among_movers(arm: &Arm, timing: &Timing) -> Vec<Line> {
    let Timing { obstacles, ways, waits, clearance, free_until } = timing;
    let kept = clearance
        .map_or_else(|| "none of them can meet the arm".into(), |kept| format!("{} m proven", at_least(kept, 6)));
    let stays = free_until.map_or_else(|| "for ever".into(), |until| format!("until {until:.3} s"));
    let tried = counted(*ways, "way");
    let mut lines = vec![(
        "moving",
        format!("{}, {kept}; {tried} tried; at the goal the arm may stay {stays}", counted(*obstacles, "obstacle")),
    )];
    lines.extend(waits.iter().map(|Wait { from, to, at }| {
        ("waits", format!("from {from:.3} to {to:.3} s at {}", configuration(arm, Configuration::from(*at))))
    }));
    lines
}

/// What becomes of the path's corners, if it has any.
fn corners(curve: &CertifiedCurve) -> String {
    let radii = curve.radii();
    let corners = radii.len().saturating_sub(2);
    let blended = radii.iter().filter(|radius| **radius > 0.0).count();
    match blended {
        _ if corners == 0 => String::new(),
        0 => format!("; stops at {corners} corners"),
        _ => {
            let largest = radii.iter().copied().fold(0.0, f64::max);
            format!("; {blended} of {corners} corners blended, radius up to {largest:.4}")
        }
    }
}

/// How near the motion is to the fastest.
fn least_time(fastest: &Fastest) -> String {
    let Fastest { lower_bound, gap, .. } = *fastest;
    let longer = gap.map_or_else(String::new, |gap| format!(", so at most {} longer than the fastest", percent(gap)));
    format!("proven: no motion takes less than {} s{longer}", at_least(lower_bound, 3))
}

/// How near the path is to the optimum.
fn optimum(bound: &Bound) -> String {
    let Bound { metric, lower, upper } = *bound;
    let measure = match metric {
        Metric::Euclidean => format!("length {upper:.4}"),
        Metric::Weighted { weights: [a, b] } => format!("weighted length {upper:.4} (weights {a}, {b})"),
        Metric::Time { .. } => format!("{upper:.4} s at top speed"),
    };
    let (lower, gap) = (at_least(lower, 4), percent(bound.gap()));
    format!("{measure}; proven: none below {lower}, so at most {gap} longer than the shortest")
}
