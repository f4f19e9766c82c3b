//! Pictures of the compared paths, for files and for the page.

use super::cases::{Case, Cases};
use super::runner::ComparisonResults;
use crate::check::CheckedProof;
use crate::compare::{Comparison, Overlay, PathPictures, Purpose, Study, labels};
use crate::engine::{Options, Problem, plan};
use crate::model::{MotionProblem, Scene, Status};
use crate::output;
use crate::space::Path;
use crate::view::{self, Picture, View};

/// Largest number of random queries with pictures on a page. Each query has its own picture.
const MAX_DRAWN_QUERIES: usize = 6;

/// Largest number of worlds with pictures on a page. Each world has its own picture.
const MAX_DRAWN_WORLDS: usize = 60;

/// Largest number of queries whose paths are drawn in one picture of a page.
const MAX_OVERLAID_PATHS: usize = 300;

/// Largest deviation of contours in a page's small pictures, as a fraction of the arm's reach.
const CONTOUR_TOLERANCE: f64 = 4e-3;

/// Returns the page's drawings of workspace and configuration space, one per problem. Among random queries, it chooses
/// those for which the planners' path lengths differ most.
pub fn pictures(cases: &Cases, study: &Study, done: &ComparisonResults) -> Vec<PathPictures> {
    let mut chosen: Vec<usize> = (0..study.comparisons.len()).collect();
    if cases.sampling.is_some() {
        let longest = |i: &usize| {
            let comparison = &study.comparisons[*i];
            comparison.rows.iter().filter_map(|row| comparison.ratio(row)).fold(0.0, f64::max)
        };
        chosen.sort_by(|a, b| longest(b).total_cmp(&longest(a)));
        chosen.truncate(MAX_DRAWN_QUERIES);
    }
    let drawn = chosen.into_iter().take(MAX_DRAWN_WORLDS).filter_map(|problem| {
        let view = view(&cases.cases[problem], &study.comparisons[problem], &done.paths[problem]);
        let comparison = &study.comparisons[problem];
        // The recommended paths are drawn above the others.
        let top =
            Purpose::ALL.into_iter().filter_map(|purpose| comparison.path_index(comparison.recommended(purpose)?));
        let top: Vec<usize> = top.collect();
        Some(PathPictures { problem, drawn: view::compared(&view, &format!("problem{problem}"), &top)? })
    });
    drawn.collect()
}

/// Returns, for each world with random queries, pictures with all paths of each planner.
pub fn overlays(cases: &Cases, study: &Study, done: &ComparisonResults) -> Vec<Overlay> {
    let Some(sampling) = cases.sampling else { return Vec::new() };
    let worlds = cases.cases.chunks(sampling.queries).zip(done.paths.chunks(sampling.queries));
    worlds.filter_map(|(world, paths)| Some(overlay(world.first()?, study, paths))).collect()
}

fn overlay(first: &Case, study: &Study, paths: &[Vec<Option<Path>>]) -> Overlay {
    let scene = first.base.scene();
    let shown = &paths[..paths.len().min(MAX_OVERLAID_PATHS)];
    let of = |planner: usize| {
        let found = shown.iter().filter_map(|row| row.get(planner)?.as_ref());
        found.map(|path| path.waypoints().iter().map(|q| [q[0], q[1]]).collect()).collect()
    };
    let axes = scene.arm().topology().ranges;
    Overlay {
        title: output::title_of(scene),
        joints: scene.arm().joints.each_ref().map(|joint| {
            let around = if joint.range.is_circle() { ", wraps around" } else { "" };
            format!("{} [{}{around}]", joint.name, joint.unit())
        }),
        window: axes.map(|axis| axis.domain()),
        circles: axes.map(|axis| axis.is_circle()),
        blocked: blocked(scene),
        planners: study.planners().into_iter().enumerate().map(|(i, name)| (name.to_owned(), of(i))).collect(),
        pens: study.comparisons.first().map_or_else(Vec::new, Comparison::pens),
        note: (shown.len() < paths.len()).then(|| format!("The first {} of {} queries.", shown.len(), paths.len())),
    }
}

fn blocked(scene: &Scene) -> Vec<Vec<[f64; 2]>> {
    let tolerance = CONTOUR_TOLERANCE * scene.arm().reach();
    let contours = crate::cspace::c_obstacles(scene, tolerance, tolerance);
    contours.into_iter().map(|c| c.contour.iter().map(|p| [p.x, p.y]).collect()).collect()
}

/// Returns the view of the paths of one problem.
pub fn view(case: &Case, comparison: &Comparison, paths: &[Option<Path>]) -> View {
    let problem = case.problem();
    let planners: Vec<&str> = comparison.rows.iter().map(|row| row.planner.as_str()).collect();
    let named = labels(&planners).into_iter().zip(paths).filter_map(|(name, path)| Some((name, path.as_ref()?)));
    let pens = comparison.pens().into_iter().zip(paths).filter_map(|(pen, path)| path.as_ref().map(|_| pen));
    let pens: Vec<_> = pens.collect();
    let (proof, arm) = (proof(&problem, comparison), problem.scene().arm());
    View::of_picture(&Picture {
        title: vec![output::title_of(problem.scene())],
        status: comparison.outcome(),
        goals: problem.goals().pieces(),
        paths: named.map(|(name, path)| (format!("{name}: {}", arm.format_length(path.length())), path)).collect(),
        pens: &pens,
        proof: proof.as_ref(),
        c_obstacles: &output::contours(problem.scene()),
        ..Picture::new(problem.scene(), problem.start())
    })
}

/// If planners proved that there is no path, returns the proof of the default planner. The proof is computed again,
/// which is cheaper than storing the proofs of all problems, because only a few are drawn.
fn proof(problem: &MotionProblem, comparison: &Comparison) -> Option<CheckedProof> {
    let is_proven = comparison.rows.iter().any(|row| row.outcome == Status::Infeasible);
    let made = is_proven.then(|| plan(&Problem::from(problem.clone()), &Options::default()))?.ok()?;
    made.motion()?.1.outcome.infeasible().cloned()
}
