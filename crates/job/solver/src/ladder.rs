//! The ladder of refinement: a planner tries finer and finer spaces until its path is certified and good enough.

use super::admission::Ends;
use super::bound::{Bound, bound};
use super::decision::decide;
use super::planner_space::PlannerSpace;
use super::rungs::{grid_cells, polygons, zoned_cells};
use super::{Answer, BoundedPath, Options, Settings, Stages, Unknown};
use cplan_fields::FieldChoice;
use cplan_interrupt::Instant;
use cplan_judge::{CertifiedPath, CheckedProof, Rejection, certify};
use cplan_model::space::{Metric, Path, Segment};
use cplan_model::{MotionProblem, Outcome, Scene};
use cplan_planners::cspace::{Grid, Regions, ZonedGrid, not_polygons};
use cplan_planners::planner::{Note, Planner, Proposal, Query, Run, Visibility};
use cplan_text::percent;

/// Number of boxes of the first search for a proof, after the first attempt has failed. Easy proofs need no more, and the search
/// is cheap compared with a finer attempt.
pub(super) const FIRST_BOXES: usize = 20_000;

/// A lower bound is refined until the path is longer by at most this share.
pub(super) const CLOSE_GAP: f64 = 1e-4;

/// A path with a larger gap is planned again on finer levels, even if no gap was requested. A shorter path may lead through a
/// passage that is closed on the first level; this happens to about one path in a hundred.
const WIDE_GAP: f64 = 0.05;

/// Last level on which [`WIDE_GAP`] matters. The margin of each level is a quarter of that before, so this level shows passages
/// down to a five-thousandth of the arm's reach.
const LAST_LEVEL_FOR_GAP: usize = 2;

/// Answers `problem` with the options' planner. Failed attempts are reported to `progress`.
///
/// The search omits obstacles out of the arm's reach, but paths are certified among all obstacles.
pub fn solve(problem: &MotionProblem, options: &Options, progress: &mut dyn FnMut(&str)) -> Answer {
    let scene = problem.scene();
    let Some(near) = scene.within_reach() else { return answered(problem, options, progress) };
    let near = MotionProblem::trusted(near, problem.start(), problem.goals().clone());
    let mut answer = answered(&near, options, progress);
    let among_all = |path: &CertifiedPath| certify(scene, path.path().clone()).ok();
    match &mut answer.outcome {
        Outcome::Found(path) => match among_all(&path.certified) {
            Some(certified) => path.certified = certified,
            None => return answered(problem, options, progress),
        },
        Outcome::Infeasible(_) => {}
        Outcome::Unknown(unknown) => unknown.witness = unknown.witness.as_ref().and_then(among_all),
    }
    answer
}

fn answered(problem: &MotionProblem, options: &Options, progress: &mut dyn FnMut(&str)) -> Answer {
    let solve = options.planner.method().descriptor().solve;
    solve(Request { problem, options, progress })
}

/// A planning request, with the receiver of messages about failed attempts.
pub(super) struct Request<'a> {
    pub problem: &'a MotionProblem,
    pub options: &'a Options,
    pub progress: &'a mut dyn FnMut(&str),
}

/// Answers with a planner that works among polygons. `planner` creates the planner from the settings and the number of
/// the level.
pub(super) fn on_polygons<P>(request: Request, planner: impl Fn(&Settings, usize) -> P) -> Answer
where
    P: Planner<Space = Regions>,
{
    let (problem, margin) = (request.problem, request.options.planner.settings().margin);
    climb(request, planner, |level| polygons(problem, margin, level))
}

/// Answers with a planner that works on the cells of a grid. `planner` creates the planner from the settings and the
/// number of the level.
pub(super) fn on_cells<P>(request: Request, planner: impl Fn(&Settings, usize) -> P) -> Answer
where
    P: Planner<Space = Grid>,
{
    let (problem, &Settings { space, cells, .. }) = (request.problem, request.options.planner.settings());
    climb(request, planner, |level| grid_cells(problem, space, cells, level))
}

/// Answers with a planner that works on the cells of a grid with the world's preferences. `planner` creates the planner
/// from the settings and the number of the level.
pub(super) fn on_zoned_cells<P>(request: Request, planner: impl Fn(&Settings, usize) -> P) -> Answer
where
    P: Planner<Space = ZonedGrid>,
{
    let (problem, &Settings { space, cells, .. }) = (request.problem, request.options.planner.settings());
    climb(request, planner, |level| zoned_cells(problem, space, cells, level))
}

/// Answers by a visibility graph. Other planners that minimise length use this as well.
pub(super) fn by_visibility(request: Request) -> Answer {
    let metric = request.options.planner.metric(request.problem.scene().arm());
    on_polygons(request, |s, _| Visibility { metric, search: s.search, graph: s.graph })
}

/// Plans level after level, until a path is good enough or a proof is found. `planner` creates the planner of a level.
/// `build` creates the level's space; it returns `None` if there is no finer space.
fn climb<P: Planner>(
    Request { problem, options, progress }: Request,
    planner: impl Fn(&Settings, usize) -> P,
    build: impl Fn(usize) -> Option<P::Space>,
) -> Answer
where
    P::Space: PlannerSpace,
{
    let (method, metric) = (options.planner.method(), options.planner.metric(problem.scene().arm()));
    let mut climb = Climb { problem, options, metric, level: 0, stages: Stages::default(), path: None };
    let mut history = Vec::new();
    let mut last: Option<(Run, P::Space)> = None;
    let mut known = None;
    let mut sweeps_end = false;
    let keeps_first = options.planner.is_exact() && not_polygons(problem.scene()).is_none();
    for level in 0..options.levels.max(1) {
        let clock = Instant::now();
        let Some(space) = build(level) else { break };
        let planner = planner(options.planner.settings(), level);
        let map = planner.build(&space);
        climb.stages.build += clock.elapsed();
        let clock = Instant::now();
        let ends = Ends::new(problem, &space);
        let run = match method {
            _ if options.planner.optimizes() => {
                shortest_of_all(&ends, metric, |query| planner.query(&space, &map, query))
            }
            _ => planner.query(&space, &map, &ends.query),
        };
        climb.stages.query += clock.elapsed();
        climb.level = level;
        // On a finer grid, a field takes even more sweeps.
        let takes_more = matches!((&run.outcome, &run.note), (Proposal::GaveUp(_), Some(Note::Unconverged { .. })));
        let failure = climb.judge(&ends, &run.outcome).map(|failure| format!("{}: {failure}", space.describe()));
        // Pictures and files should show exact polygons, so the answer keeps them even if the path needs another space.
        if level == 0 || !keeps_first {
            last = Some((run, space));
        }
        let Some(failure) = failure else { break };
        progress(&format!("{method}: {failure}"));
        history.push(failure);
        if level == 0 && climb.path.is_none() {
            known = decide_feasibility(problem, options.boxes.min(FIRST_BOXES), &mut climb.stages);
            if let Some(Outcome::Infeasible(_)) = known {
                break;
            }
        }
        if takes_more {
            sweeps_end = true;
            break;
        }
    }
    let path = climb.path.take();
    if path.is_none() && known.is_none() {
        progress(&format!("{method}: looking for a proof that there is no path"));
        known = decide_feasibility(problem, options.boxes, &mut climb.stages);
    }
    let (run, space) = last.unwrap_or_else(|| unreachable!("the first level always has a space"));
    let why = || history.last().cloned().unwrap_or_default();
    // Force fields still have local minima on finer grids.
    let has_minima = options.planner.field().is_some_and(|planner| matches!(planner.field, FieldChoice::Khatib(_)));
    let is_coarse = options.planner.cells().is_some() && history.len() == options.levels && !has_minima;
    let hint = if is_coarse && !sweeps_end { "; more --cells or --levels may find one" } else { "" };
    let finest =
        if sweeps_end { "the finest resolution for which its sweeps suffice" } else { "its finest resolution" };
    let unknown = || format!("{method} found no certified path at {finest} ({}){hint}", why());
    let outcome = match (path, known) {
        (Some(path), _) => Outcome::Found(path),
        (None, Some(Outcome::Infeasible(proof))) => Outcome::Infeasible(proof),
        (None, Some(Outcome::Found(witness))) => {
            let reason = "a path exists (certified by subdivision), but not in this planner's cells or graph";
            Outcome::Unknown(Unknown { reason: format!("{reason}: {}", unknown()), witness: Some(witness) })
        }
        (None, _) => Outcome::Unknown(unknown().into()),
    };
    let (path_kind, stages) = (options.planner.path_kind(), climb.stages);
    Answer { method, outcome, path_kind, history, run, space: space.into_space(), stages }
}

/// The state of a search that goes from level to level.
struct Climb<'a> {
    problem: &'a MotionProblem,
    options: &'a Options,
    metric: Metric,
    level: usize,
    stages: Stages,
    /// The shortest certified path so far, with its bounds. The lower bound is valid on all levels.
    path: Option<BoundedPath>,
}

impl Climb<'_> {
    /// Judges a level's outcome. Returns the reason, in words, why a finer level must be tried, if there is one.
    fn judge(&mut self, ends: &Ends, outcome: &Proposal) -> Option<String> {
        let proposal = match outcome {
            Proposal::Found(path) => path,
            Proposal::NoPath => return self.reason_to_refine("no path in it".into()),
            Proposal::GaveUp(reason) => return self.reason_to_refine(reason.clone()),
        };
        match self.certify_proposal(ends, proposal) {
            Ok(path) => {
                self.keep_if_shorter(path);
                // Without a bound, no finer level is tried, so the message always has a number.
                let excess = self.bound().map_or_else(String::new, |bound| percent(bound.gap()));
                self.reason_to_refine(format!("the path of the planner is {excess} longer than the proven bound"))
            }
            Err(rejection) => {
                let why = explain(self.problem.scene(), rejection);
                self.reason_to_refine(format!("the path of the planner is not certified: {why}"))
            }
        }
    }

    /// Returns `failure` if a finer level must be tried: no path is known, or the gap of the best path exceeds the requested one.
    /// If none was requested, [`WIDE_GAP`] is the limit on levels before [`LAST_LEVEL_FOR_GAP`], and there is no limit from there
    /// on.
    fn reason_to_refine(&self, failure: String) -> Option<String> {
        let gap = self.options.planner.gap().or((self.level < LAST_LEVEL_FOR_GAP).then_some(WIDE_GAP));
        // A search that does not minimise length accepts any path.
        let gap = gap.filter(|_| self.options.planner.optimizes());
        let wants_more = self.bound().zip(gap).is_some_and(|(bound, gap)| bound.gap() > gap);
        (self.path.is_none() || wants_more).then_some(failure)
    }

    /// Certifies a proposed path. If it begins or ends at a stand-in, completes it to the true start and goal: first directly,
    /// and if that fails, through the stand-in.
    fn certify_proposal(&mut self, ends: &Ends, proposal: &Path) -> Result<CertifiedPath, Rejection> {
        let clock = Instant::now();
        let judge = |path| certify(self.problem.scene(), path);
        let straight = ends.past_stand_ins(proposal).and_then(|path| judge(path).ok());
        let certified = straight.map_or_else(|| judge(ends.complete(proposal)), Ok);
        self.stages.certify += clock.elapsed();
        certified
    }

    /// Returns the bounds of the best path. `None` if there is no path, or if bounds are not computed.
    fn bound(&self) -> Option<Bound> {
        self.path.as_ref().and_then(|path| path.bound)
    }

    /// Keeps a path, with its bounds, if it is the shortest so far. If the planner does not minimise length, or no bounds were
    /// requested, keeps every path without bounds.
    fn keep_if_shorter(&mut self, certified: CertifiedPath) {
        if !self.options.bounded || !self.options.planner.method().optimizes() {
            self.path = Some(certified.into());
            return;
        }
        let clock = Instant::now();
        let (metric, gap) = (self.metric, self.options.planner.gap());
        let upper = metric.length(certified.path());
        // The lower bound does not depend on the path, so it is computed only once.
        let best = self.bound();
        let found = best.map_or_else(
            || bound(self.problem, certified.path(), metric, gap.map_or(CLOSE_GAP, |gap| CLOSE_GAP.min(gap / 2.0))),
            |best| Bound { upper, ..best },
        );
        self.stages.bound += clock.elapsed();
        if best.is_none_or(|best| found.upper < best.upper) {
            self.path = Some(BoundedPath { certified, bound: Some(found) });
        }
    }
}

/// Returns the run whose path to the true goal is the shortest. A planner measures only the length to a goal's stand-in. So if
/// there are several goals, some with stand-ins, each goal is planned for separately.
fn shortest_of_all(ends: &Ends, metric: Metric, query: impl Fn(&Query) -> Run) -> Run {
    if ends.query.goals.pieces().len() < 2 || !ends.has_goal_stand_ins() {
        return query(&ends.query);
    }
    let length = |run: &Run| match &run.outcome {
        Proposal::Found(path) => metric.length(&ends.past_stand_ins(path).unwrap_or_else(|| ends.complete(path))),
        Proposal::NoPath | Proposal::GaveUp(_) => f64::INFINITY,
    };
    let one = |piece: &Segment| query(&Query { start: ends.query.start, goals: (*piece).into() });
    let each = ends.query.goals.pieces().iter().map(one);
    let shortest = each.min_by(|a, b| length(a).total_cmp(&length(b)));
    shortest.unwrap_or_else(|| query(&ends.query))
}

/// Decides whether a path exists, without the planner's own space. `None` if the question stays undecided.
fn decide_feasibility(
    problem: &MotionProblem,
    boxes: usize,
    stages: &mut Stages,
) -> Option<Outcome<CertifiedPath, CheckedProof>> {
    let clock = Instant::now();
    let decided = decide(problem, boxes);
    stages.prove += clock.elapsed();
    (!matches!(decided, Outcome::Unknown(_))).then_some(decided)
}

pub(super) fn explain(scene: &Scene, rejection: Rejection) -> String {
    match rejection {
        Rejection::OutOfLimits { waypoint, limited } => {
            format!("waypoint {waypoint} is outside the limits of {}", scene.arm().describe_limit(limited))
        }
        Rejection::TooClose(nearest) | Rejection::Undecided(nearest) => format!(
            "{} come within {:.3e} m of each other at ({:.6}, {:.6})",
            scene.describe(nearest.contact.pair),
            nearest.contact.separation.distance,
            nearest.at[0],
            nearest.at[1],
        ),
    }
}
