//! About the shortest path, and how near it is to the optimum.
//!
//! Slabs say whether there is a path; the first one bounds how far to look. The search that bounds the optimum from below is
//! run among obstacles that are grown by a hair: its way keeps off the true ones, and is certified. Then it is run among the
//! true ones with the same slices, for the bound. No polygons, graphs or grids are built unless that fails.

use super::bound::{Bound, motions};
use super::corners::fewer_corners;
use super::first::answer;
use super::ladder::{CLOSE, FIRST_BOXES, climb_polygons};
use super::settle::decide;
use super::{Answer, Effort, Method, Stages, Verdict};
use crate::check::CertifiedPath;
use crate::model::MotionProblem;
use crate::planner::{Size, Trace};
use crate::search::{least_length, short_motion};
use std::time::Instant;

/// What paths keep from obstacles beyond the clearance, as shares of the arm's reach and of the gap, one after the other.
const KEPT: [f64; 4] = [0.25, 0.06, 0.015, 0.004];

/// Share of the arm's reach that they keep at most, whatever gap is asked for.
const MOST_KEPT: f64 = 0.01;

/// With more pairs of shapes than this there is a single attempt, ...
const FEW_PAIRS: usize = 1000;

/// ... and with more than this none.
const MOST_PAIRS: usize = 20_000;

/// Part of the gap that the bound may leave open.
const PART: f64 = 0.5;

/// Part of what is left of the gap that fewer corners may cost.
const SPENT: f64 = 0.9;

/// Answers `problem` with about the shortest path. Where slabs do not tell whether there is one, or it is not proven to be within
/// the gap, a visibility graph has its turn, and the better of both paths is the answer.
pub(super) fn solve(problem: &MotionProblem, effort: &Effort, progress: &mut dyn FnMut(&str)) -> Answer {
    let clock = Instant::now();
    let first = decide(problem, effort.boxes.min(FIRST_BOXES));
    let stages = Stages { query: clock.elapsed(), ..Stages::default() };
    let mut by_graph = || climb_polygons(problem, Method::Shortest, effort, progress);
    let (own, by_graph) = match first {
        Verdict::Infeasible(_) => return answer(Method::Shortest, first, stages),
        // Among so many pieces polygons, which cover them by fewer, are the better way.
        Verdict::Found(_) if problem.scene().pairs().len() > MOST_PAIRS => {
            let by_graph = by_graph();
            let own = answer(Method::Shortest, first, stages);
            (own, by_graph)
        }
        Verdict::Found(path) => {
            let own = shorter(problem, effort, path, stages);
            if is_content(&own, effort) {
                return own;
            }
            (own, by_graph())
        }
        Verdict::Unknown(_) => {
            let by_graph = by_graph();
            let Verdict::Found(path) = &by_graph.verdict else {
                return Answer { stages: by_graph.stages + stages, ..by_graph };
            };
            (shorter(problem, effort, path.clone(), stages), by_graph)
        }
    };
    let length = |answer: &Answer| match &answer.verdict {
        Verdict::Found(path) => effort.metric.length(path.path()),
        _ => f64::INFINITY,
    };
    let lower = [&own, &by_graph].into_iter().filter_map(|answer| answer.bound).map(|b| b.lower).fold(0.0, f64::max);
    let stages = own.stages + by_graph.stages;
    let mut best = if length(&own) <= length(&by_graph) { own } else { by_graph };
    best.stages = stages;
    best.bound = best.bound.map(|bound| Bound { lower, ..bound });
    best
}

/// Whether there is nothing to be made better.
fn is_content(answer: &Answer, effort: &Effort) -> bool {
    !effort.bounded || answer.bound.is_some_and(|bound| bound.gap() <= effort.gap.unwrap_or(CLOSE))
}

/// The answer that begins with a first path.
fn shorter(problem: &MotionProblem, effort: &Effort, first: CertifiedPath, mut stages: Stages) -> Answer {
    let gap = effort.gap.unwrap_or(CLOSE);
    let motions = motions(problem, effort.metric);
    let length = |path: &CertifiedPath| effort.metric.length(path.path());
    let mut bound = Bound { metric: effort.metric, lower: 0.0, upper: length(&first) };
    let (mut path, mut free) = (first, Vec::new());
    let close = |bound: &Bound, slices: &[f64], stages: &mut Stages| {
        let clock = Instant::now();
        let lower = least_length(&motions, bound.upper, PART * gap, slices);
        stages.bound += clock.elapsed();
        Bound { lower: lower.max(bound.lower), ..*bound }
    };
    if effort.bounded && path.path().waypoints().len() == 2 {
        // Straight: seldom to be made shorter.
        bound = close(&bound, &[], &mut stages);
    }
    // Among thousands of pieces an attempt may take a second.
    let attempts = if problem.scene().pairs().len() <= FEW_PAIRS { KEPT.len() } else { 1 };
    for share in &KEPT[..attempts] {
        if bound.gap() <= gap {
            break;
        }
        let clock = Instant::now();
        let kept = (share * gap).min(MOST_KEPT) * problem.scene().arm().reach();
        let found = short_motion(&motions, kept, bound.upper);
        stages.query += clock.elapsed();
        let Some(found) = found.filter(|found| length(&found.path) < bound.upper) else { continue };
        (path, free) = (found.path, found.free);
        bound.upper = length(&path);
        if !effort.bounded {
            break;
        }
        if bound.gap() > gap {
            bound = close(&bound, &found.slices, &mut stages);
        }
    }
    if effort.bounded && bound.lower == 0.0 {
        bound = close(&bound, &[], &mut stages);
    }
    let clock = Instant::now();
    let rest = if effort.bounded { bound.lower * (1.0 + gap) - bound.upper } else { gap / 2.0 * bound.upper };
    if let Some(fewer) = fewer_corners(problem.scene(), &path, effort.metric, SPENT * rest) {
        bound.upper = length(&fewer);
        path = fewer;
    }
    stages.query += clock.elapsed();
    let mut answer = answer(Method::Shortest, Verdict::Found(path), stages);
    answer.bound = effort.bounded.then_some(bound);
    if !free.is_empty() {
        answer.run.size = Size::Slices { slices: free.len() };
        answer.run.trace = Trace::Slices { free };
    }
    answer
}
