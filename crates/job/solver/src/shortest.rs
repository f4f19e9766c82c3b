//! The planner `shortest`: an approximately shortest path, with a bound on its distance from the optimum.
//!
//! Slabs decide whether there is a path, and the first path limits the search for a shorter one. The search for a lower bound
//! runs twice: among slightly grown obstacles, so that its path keeps off the true ones, and with the same slices among the true
//! ones for the bound. The remaining gap allows corners to be removed. The result is certified.
//!
//! Polygons and visibility graphs are used only if this fails, or for gantries, whose C-obstacles are polygons. For these, one
//! visibility graph gives the path and another one the bound.

use super::bound::{Bound, MAX_UNITED_PAIRS, lower_bound, motions};
use super::corners::fewer_corners;
use super::decision::decide;
use super::first::answer;
use super::ladder::{CLOSE_GAP, FIRST_BOXES, Request, by_visibility};
use super::{Answer, BoundedPath, Method, Options, Stages};
use cplan_interrupt::Instant;
use cplan_judge::{CertifiedPath, certify};
use cplan_model::{MotionProblem, Outcome};
use cplan_planners::planner::{Size, Trace};
use cplan_proofs::{MotionQuery, ProposedPath, RefusalReason, short_motion};
use std::time::Duration;

/// Extra clearances in the order of the attempts, as fractions of the arm's reach times the gap.
const CLEARANCE_FRACTIONS: [f64; 4] = [0.25, 0.06, 0.015, 0.004];

/// Upper limit of the extra clearance, as a fraction of the arm's reach.
const MAX_EXTRA_CLEARANCE: f64 = 0.01;

/// Largest number of pairs of shapes with which all extra clearances are tried. With more, only the first one is tried.
const MAX_PAIRS_FOR_RETRIES: usize = 1000;

/// Largest number of pairs of shapes with which slices look for a shorter path. With more, a visibility graph does.
const MAX_PAIRS: usize = 20_000;

/// The lower bound is refined until it is within this fraction of the requested gap. The rest of the gap allows corners to be
/// removed.
const BOUND_FRACTION: f64 = 0.5;

/// Fraction of the remaining gap by which the path may become longer when corners are removed.
const SLACK_FRACTION: f64 = 0.9;

/// Answers a request with an approximately shortest path. If slabs do not decide whether there is a path, or the path is not
/// proven to be within the gap, a visibility graph plans as well. The shorter path is the answer.
pub(super) fn solve(Request { problem, options, progress }: Request) -> Answer {
    let metric = options.planner.metric(problem.scene().arm());
    let clock = Instant::now();
    let first = decide(problem, options.boxes.min(FIRST_BOXES));
    let stages = Stages { query: clock.elapsed(), ..Stages::default() };
    if problem.scene().arm().is_gantry()
        && let Outcome::Found(_) = first
        && problem.scene().pairs().len() <= MAX_UNITED_PAIRS
        && let Some(answer) = among_polygons(problem, options, stages)
    {
        return answer;
    }
    let mut by_graph = || by_visibility(Request { problem, options, progress });
    let (own, by_graph) = match first {
        Outcome::Infeasible(_) => return answer(Method::Shortest, first, stages),
        // Polygons unite pieces, so the visibility graph is faster if there are this many.
        Outcome::Found(_) if problem.scene().pairs().len() > MAX_PAIRS => {
            let by_graph = by_graph();
            let own = answer(Method::Shortest, first, stages);
            (own, by_graph)
        }
        Outcome::Found(path) => {
            let own = shorter(problem, options, path, stages);
            if meets_gap(&own, options) {
                return own;
            }
            (own, by_graph())
        }
        Outcome::Unknown(_) => {
            let by_graph = by_graph();
            let Outcome::Found(path) = &by_graph.outcome else {
                return Answer { stages: by_graph.stages + stages, ..by_graph };
            };
            (shorter(problem, options, path.certified.clone(), stages), by_graph)
        }
    };
    let length = |answer: &Answer| answer.path().map_or(f64::INFINITY, |path| metric.length(path));
    let lower = [&own, &by_graph].into_iter().filter_map(|answer| answer.bound()).map(|b| b.lower).fold(0.0, f64::max);
    let stages = own.stages + by_graph.stages;
    let mut best = if length(&own) <= length(&by_graph) { own } else { by_graph };
    best.stages = stages;
    if let Outcome::Found(BoundedPath { bound: Some(bound), .. }) = &mut best.outcome {
        bound.lower = lower;
    }
    best
}

/// The first margin by which a gantry's polygons are grown is at most this multiple of the gap, as a fraction of the arm's reach.
/// A greater margin keeps paths farther from corners, which makes motions faster. If the margin is too large for the gap, it is
/// quartered.
const MARGIN_FRACTION: f64 = 0.4;

/// Answers for a gantry, whose C-obstacles are polygons: finds the shortest path among slightly grown polygons. Returns
/// `None` if no path is proven to be within the gap.
fn among_polygons(problem: &MotionProblem, options: &Options, stages: Stages) -> Option<Answer> {
    let (scene, gap) = (problem.scene(), options.planner.gap().unwrap_or(CLOSE_GAP));
    let planner =
        options.planner.with_gap(gap).with_margin(options.planner.settings().margin.min(MARGIN_FRACTION * gap));
    let options = &Options { planner, ..*options };
    let mut answer = by_visibility(Request { problem, options, progress: &mut |_| () });
    answer.stages = answer.stages + stages;
    let path = answer.outcome.found()?;
    if !meets_gap(&answer, options) {
        return None;
    }
    let (metric, clock) = (planner.metric(scene.arm()), Instant::now());
    let upper = metric.length(path.path());
    let room = length_allowance(upper, path.bound.map(|bound| bound.lower), gap);
    if let Some(fewer) = fewer_corners(scene, path.path(), metric, room) {
        answer.outcome = Outcome::Found(path.replaced_by(fewer));
    }
    answer.stages.query += clock.elapsed();
    Some(answer)
}

fn meets_gap(answer: &Answer, options: &Options) -> bool {
    !options.bounded || answer.bound().is_some_and(|bound| bound.gap() <= options.planner.gap().unwrap_or(CLOSE_GAP))
}

/// Returns the answer with the path `first`, or with a shorter path if one is found and certified.
fn shorter(problem: &MotionProblem, options: &Options, first: CertifiedPath, mut stages: Stages) -> Answer {
    let (scene, planner) = (problem.scene(), options.planner);
    let (metric, gap) = (planner.metric(scene.arm()), planner.gap().unwrap_or(CLOSE_GAP));
    let motions = motions(problem, metric);
    let mut bounding = PathBounding {
        motions,
        gap,
        is_asked: options.bounded,
        lower: 0.0,
        bounded_length: 0.0,
        time_spent: Duration::ZERO,
    };
    let clock = Instant::now();
    let (mut upper, mut path, mut free) = (metric.length(first.path()), first, Vec::new());
    if path.path().waypoints().len() == 2 {
        // A straight path can seldom be shortened.
        bounding.bound(upper, &[]);
    }
    // With thousands of pieces, an attempt may take a second.
    let attempts = if scene.pairs().len() <= MAX_PAIRS_FOR_RETRIES { CLEARANCE_FRACTIONS.len() } else { 1 };
    for share in &CLEARANCE_FRACTIONS[..attempts] {
        if bounding.is_close(upper) {
            break;
        }
        let kept = (share * gap).min(MAX_EXTRA_CLEARANCE) * scene.arm().reach();
        let mut tries = 0;
        let judge = |ProposedPath { path: proposal, slices, is_shortest }: ProposedPath| {
            let length = metric.length(&proposal);
            let certificate = || certify(scene, proposal.clone()).map_err(RefusalReason::By);
            // The first proposal is usually good. Then only the path with fewer corners needs a certificate.
            tries += 1;
            let certified = if tries > 1 { Some(certificate()?) } else { None };
            bounding.bound(length, &slices);
            if !is_shortest && !bounding.is_close(length) {
                return Err(RefusalReason::TooLong);
            }
            let fewer = fewer_corners(scene, &proposal, metric, bounding.length_allowance(length));
            fewer.or(certified).map_or_else(certificate, Ok)
        };
        let Some(found) = short_motion(&motions, kept, upper, judge) else { continue };
        let length = metric.length(found.path.path());
        if length < upper {
            (upper, path, free) = (length, found.path, found.free);
            if !options.bounded {
                break;
            }
        }
    }
    if bounding.lower == 0.0 {
        bounding.bound(upper, &[]);
    }
    if free.is_empty()
        && let Some(fewer) = fewer_corners(scene, path.path(), metric, bounding.length_allowance(upper))
    {
        (upper, path) = (metric.length(fewer.path()), fewer);
    }
    stages.bound += bounding.time_spent;
    stages.query += clock.elapsed() - bounding.time_spent;
    let mut answer = answer(Method::Shortest, Outcome::Found(path), stages);
    if let Outcome::Found(path) = &mut answer.outcome {
        path.bound = options.bounded.then_some(Bound { metric, lower: bounding.lower, upper });
    }
    if !free.is_empty() {
        answer.run.size = Size::Slices { slices: free.len() };
        answer.run.trace = Trace::Slices { free };
    }
    answer
}

/// The computation of the best lower bound on the length of the shortest path.
struct PathBounding<'a> {
    motions: MotionQuery<'a>,
    /// The gap to reach.
    gap: f64,
    /// True if a bound is requested. If false, the lower bound stays 0.
    is_asked: bool,
    /// Lower bound on the lengths of all motions from start to goals.
    lower: f64,
    /// Length of the path up to which the bound was last computed.
    bounded_length: f64,
    /// Time spent on bounds.
    time_spent: Duration,
}

impl PathBounding<'_> {
    /// Improves the lower bound up to `upper`, the length of a path. Does nothing if the path is known to be within the gap, or
    /// if this length is the same as last time.
    fn bound(&mut self, upper: f64, slices: &[f64]) {
        if self.is_asked && upper != self.bounded_length && !self.is_close(upper) {
            let clock = Instant::now();
            self.bounded_length = upper;
            self.lower = self.lower.max(lower_bound(&self.motions, upper, BOUND_FRACTION * self.gap, slices));
            self.time_spent += clock.elapsed();
        }
    }

    /// Returns true if a path of length `upper` is known to be within the gap.
    fn is_close(&self, upper: f64) -> bool {
        Bound { metric: self.motions.metric, lower: self.lower, upper }.gap() <= self.gap
    }

    /// Returns by how much a path of length `upper` may grow when corners are removed.
    fn length_allowance(&self, upper: f64) -> f64 {
        length_allowance(upper, self.is_asked.then_some(self.lower), self.gap)
    }
}

/// Returns by how much a path of length `upper` may grow when corners are removed. Without a lower bound, it is a share of the
/// requested gap.
fn length_allowance(upper: f64, lower: Option<f64>, gap: f64) -> f64 {
    SLACK_FRACTION * lower.map_or(gap / 2.0 * upper, |lower| lower * (1.0 + gap) - upper)
}
