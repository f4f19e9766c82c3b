//! The ladder of refinement.

use super::admission::{Admit, Ends};
use super::bound::{Bound, bound, percent};
use super::swift::{SLABS, checked};
use super::{Answer, Method, Space, Stages, Verdict, subdivision};
use crate::certify::{Connectivity, Rejection, certify, connectivity, slab_connectivity};
use crate::cspace::{Grid, Regions, outer_grid, regions};
use crate::model::{Problem, Scene};
use crate::plan::{Harmonic, Outcome, Planner, Query, Run, Trapezoid, Visibility, Wavefront};
use crate::space::Metric;
use std::time::Instant;

/// How much to try before the answer is unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Attempts, each finer than the one before: a quarter of the margin, twice the cells along each axis.
    pub levels: usize,
    /// First margin by which polygonal obstacles are grown, as a share of the arm's reach.
    pub margin: f64,
    /// First number of grid cells along each axis.
    pub cells: usize,
    /// Boxes for a proof that there is no path, and for planning by subdivision.
    pub boxes: usize,
    /// What makes a path short, for the visibility planner and for bounds.
    pub metric: Metric,
    /// Go on refining until the path is proven to be no longer than the optimum by more than this share of it (visibility
    /// planner only).
    pub gap: Option<f64>,
    /// How the wavefront planner searches its grid.
    pub wavefront: Wavefront,
}

impl Default for Effort {
    /// Margins from a thousandth of the reach down to a millionth; grids from 256 x 256 to 2048 x 2048.
    fn default() -> Self {
        Self {
            levels: 6,
            margin: 1e-3,
            cells: 256,
            boxes: 200_000,
            metric: Metric::Euclidean,
            gap: None,
            wavefront: Wavefront::default(),
        }
    }
}

/// Grids end here: 2048 x 2048 cells, beyond which fields take minutes.
const MOST_CELLS: usize = 2048;

/// Boxes of the first look for a proof, after the first attempt has failed: enough where a proof is easy, and little
/// beside a finer attempt where it is not.
const FIRST_BOXES: usize = 20_000;

/// Share of a slide's stroke that counts as reach where that is smaller, as for a gantry's slender tool.
const STROKE: f64 = 0.1;

/// Turns of the universal cover to plan in, on either side of the start.
const PERIODS: usize = 1;

/// Answers `problem` with `method`. `progress` hears about attempts that failed.
#[must_use]
pub fn solve(problem: &Problem, method: Method, effort: &Effort, progress: &mut dyn FnMut(&str)) -> Answer {
    match method {
        Method::Visibility => climb(problem, method, effort, progress, &Visibility { metric: effort.metric }, polygons),
        Method::Trapezoid => climb(problem, method, effort, progress, &Trapezoid::default(), polygons),
        Method::Wavefront => climb(problem, method, effort, progress, &effort.wavefront, cells),
        Method::Harmonic => climb(problem, method, effort, progress, &Harmonic::default(), cells),
        Method::Subdivision => subdivision::solve(problem, effort, progress),
    }
}

/// Builds the space of one level; none when there is no finer one.
type Builder<S> = fn(&Problem, &Effort, usize) -> Option<S>;

fn climb<P: Planner>(
    problem: &Problem,
    method: Method,
    effort: &Effort,
    progress: &mut dyn FnMut(&str),
    planner: &P,
    build: Builder<P::Space>,
) -> Answer
where
    P::Space: Into<Space> + Described + Admit,
{
    let clearance = problem.scene.workspace.clearance;
    let mut stages = Stages::default();
    let mut history = Vec::new();
    let mut last: Option<(Run, P::Space)> = None;
    let mut verdict = None;
    let mut best: Option<Bound> = None;
    for level in 0..effort.levels.max(1) {
        let clock = Instant::now();
        let Some(space) = build(problem, effort, level) else { break };
        let map = planner.build(&space);
        stages.build += clock.elapsed();
        let clock = Instant::now();
        let ends = Ends::new(problem, &space);
        let run = match method {
            Method::Visibility => shortest_of_all(&ends, effort.metric, |query| planner.query(&space, &map, query)),
            _ => planner.query(&space, &map, &ends.query),
        };
        stages.query += clock.elapsed();
        let failure = match &run.outcome {
            Outcome::Found(path) => {
                let clock = Instant::now();
                let judge = |path| certify(&problem.scene, path, clearance);
                let straight = ends.past_stand_ins(path).and_then(|path| judge(path).ok());
                let certified = straight.map_or_else(|| judge(ends.complete(path)), Ok);
                stages.certify += clock.elapsed();
                match certified {
                    Ok(path) => {
                        let bounded = (method == Method::Visibility).then(|| {
                            let clock = Instant::now();
                            let bound = bound(problem, path.path(), effort.metric, margin(problem, effort, level));
                            stages.bound += clock.elapsed();
                            bound
                        });
                        if best.zip(bounded).is_none_or(|(best, new)| new.upper < best.upper) {
                            verdict = Some(Verdict::Found(path));
                        }
                        best = best.zip(bounded).map_or(bounded, |(best, new)| Some(best.and(new)));
                        best.map_or_else(String::new, |bound| {
                            format!("its path is longer than the bound by {}", percent(bound.gap()))
                        })
                    }
                    Err(rejection) => format!("its path is not certified: {}", explain(&problem.scene, rejection)),
                }
            }
            Outcome::NoPath => "no path in it".into(),
            Outcome::GaveUp(reason) => reason.clone(),
        };
        let failure = format!("{}: {failure}", space.describe());
        last = Some((run, space));
        let goes_on = best.zip(effort.gap).is_some_and(|(bound, gap)| bound.gap() > gap);
        if verdict.is_some() && !goes_on {
            break;
        }
        progress(&format!("{method}: {failure}"));
        history.push(failure);
        if level == 0 && verdict.is_none() {
            verdict = prove(problem, effort.boxes.min(FIRST_BOXES), &mut stages);
            if verdict.is_some() {
                break;
            }
        }
    }
    if verdict.is_none() {
        progress(&format!("{method}: looking for a proof that there is no path"));
        verdict = prove(problem, effort.boxes, &mut stages);
    }
    let (run, space) = last.unwrap_or_else(|| unreachable!("the first level always has a space"));
    let verdict = verdict.unwrap_or_else(|| {
        let why = history.last().cloned().unwrap_or_default();
        Verdict::Unknown(format!("{method} found no certified path at its finest resolution ({why})"))
    });
    Answer { method, verdict, bound: best, history, run, space: space.into(), stages }
}

/// The run whose path is the shortest when it is completed. A planner measures to the stand-in of a goal, not to the goal:
/// where that makes a difference each goal is asked for by itself.
fn shortest_of_all(ends: &Ends, metric: Metric, query: impl Fn(&Query) -> Run) -> Run {
    if ends.query.goals.len() < 2 || !ends.has_goal_stand_ins() {
        return query(&ends.query);
    }
    let length = |run: &Run| match &run.outcome {
        Outcome::Found(path) => metric.length(&ends.past_stand_ins(path).unwrap_or_else(|| ends.complete(path))),
        Outcome::NoPath | Outcome::GaveUp(_) => f64::INFINITY,
    };
    let each = ends.query.goals.iter().map(|&goal| query(&Query { start: ends.query.start, goals: vec![goal] }));
    let shortest = each.min_by(|a, b| length(a).total_cmp(&length(b)));
    shortest.unwrap_or_else(|| query(&ends.query))
}

fn prove(problem: &Problem, boxes: usize, stages: &mut Stages) -> Option<Verdict> {
    let clock = Instant::now();
    let clearance = problem.scene.workspace.clearance;
    let (scene, start, goals) = (&problem.scene, problem.start, &problem.goals);
    // Slabs answer most questions in a small part of the time; boxes know about shapes without thickness, too.
    let proof = match slab_connectivity(scene, start, goals, clearance, SLABS.min(boxes)) {
        Connectivity::Disconnected(proof) => checked(problem, proof),
        Connectivity::Undecided { .. } => match connectivity(scene, start, goals, clearance, boxes) {
            Connectivity::Disconnected(proof) => checked(problem, proof),
            Connectivity::Connected(_) | Connectivity::Undecided { .. } => None,
        },
        // There is a path, so there is no proof.
        Connectivity::Connected(_) => None,
    };
    stages.prove += clock.elapsed();
    proof.map(Verdict::Infeasible)
}

/// Polygons grown by the level's margin.
fn polygons(problem: &Problem, effort: &Effort, level: usize) -> Option<Regions> {
    Some(regions(&problem.scene, margin(problem, effort, level), problem.start, PERIODS))
}

/// The level's margin, metres.
fn margin(problem: &Problem, effort: &Effort, level: usize) -> f64 {
    let arm = &problem.scene.arm;
    let strokes = arm.joints.iter().filter(|joint| !joint.motion.is_revolute()).map(|joint| joint.axis.extent());
    let scale = strokes.map(|stroke| STROKE * stroke).fold(arm.reach(), f64::max);
    effort.margin * scale * 0.25_f64.powi(level as i32)
}

/// Cells of the level's size.
fn cells(problem: &Problem, effort: &Effort, level: usize) -> Option<Grid> {
    let n = effort.cells << level;
    (level == 0 || n <= MOST_CELLS).then(|| outer_grid(&problem.scene, [n, n], problem.scene.workspace.clearance))
}

/// A space in a few words.
trait Described {
    fn describe(&self) -> String;
}

impl Described for Regions {
    fn describe(&self) -> String {
        format!("polygons ({})", self.proves)
    }
}

impl Described for Grid {
    fn describe(&self) -> String {
        format!("{} x {} cells", self.cells[0], self.cells[1])
    }
}

impl From<Regions> for Space {
    fn from(regions: Regions) -> Self {
        Space::Regions(Box::new(regions))
    }
}

impl From<Grid> for Space {
    fn from(grid: Grid) -> Self {
        Space::Grid(Box::new(grid))
    }
}

pub(super) fn explain(scene: &Scene, rejection: Rejection) -> String {
    match rejection {
        Rejection::OutOfLimits { waypoint, joint } => {
            format!("waypoint {waypoint} is outside the limits of joint \"{}\"", scene.arm.joints[joint].name)
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
