//! The space of each level: successively finer approximations of a configuration space.

use super::setting::DEFAULT_CELLS;
use super::{CellCounts, GridSpace};
use cplan_model::{Arm, MotionProblem};
use cplan_planners::cspace::{
    Grid, Regions, ZonedGrid, exact_regions, grid_from_slices, not_polygons, outer_grid, regions, sampled_grid,
    traced_pairs,
};

/// Largest number of cells along an axis, except on the first level. With more, fields take minutes.
const MAX_CELLS: usize = 2048;

/// Largest number of collision checks of a sampled grid, except on the first level. They take some ten seconds. A level that
/// needs more has no grid.
const MAX_CHECKS: usize = 1 << 30;

/// For a gantry with a slender tool, the reach is small. If it is below this fraction of a prismatic joint's stroke, the fraction
/// of the stroke replaces it.
const STROKE_SHARE: f64 = 0.1;

/// Number of whole turns of continuous joints that polygons cover on either side of the start.
const TURNS_PER_SIDE: usize = 1;

/// Largest number of pairs of shapes from which polygons are made on the first level with the requested margin. They take one or
/// two seconds. With more pairs, [`MARGIN_INCREASE`] applies.
const MAX_FIRST_PAIRS: usize = 6144;

/// Factor by which the margin grows while there are more than [`MAX_FIRST_PAIRS`] pairs, and the greatest number of such
/// increases. Greater margins merge shapes, which reduces the number of pairs.
const MARGIN_INCREASE: (f64, usize) = (2.0, 6);

/// Largest number of pairs of shapes from which polygons are made, except on the first level. A level with more pairs has no
/// polygons.
const MAX_PAIRS: usize = 16_384;

/// Margin, as a share of the arm's reach, of the level after exact polygons. Paths among exact polygons usually touch them and
/// are refused. With this margin, paths stay within the usual gap (1e-4) of the shortest one.
const MARGIN_AFTER_EXACT: f64 = 4e-5;

/// Returns the polygons of a level. The first level has exact polygons if `first`, its margin, is 0 and C-obstacles are polygons.
/// All other polygons are grown. `None` if there is no finer level.
pub(super) fn polygons(problem: &MotionProblem, first: f64, level: usize) -> Option<Regions> {
    if first > 0.0 {
        return grown_polygons(problem, first, level);
    }
    match level.checked_sub(usize::from(not_polygons(problem.scene()).is_none())) {
        Some(level) => grown_polygons(problem, MARGIN_AFTER_EXACT, level),
        None => exact_regions(problem.scene()),
    }
}

/// Returns polygons grown by the level's margin, a quarter of the margin of the level before. `first`, the margin of level 0, is
/// a share of the arm's extent. `None` if there is no finer level.
fn grown_polygons(problem: &MotionProblem, first: f64, level: usize) -> Option<Regions> {
    let scene = problem.scene();
    let few = |margin: f64, most: usize| scene.pairs().len() <= most || traced_pairs(scene, margin) <= most;
    let (mut margin, (factor, times)) = (margin(problem, first, level), MARGIN_INCREASE);
    for _ in 0..times {
        let first = margin * 4_f64.powi(level as i32);
        if few(first, MAX_FIRST_PAIRS) {
            break;
        }
        margin *= factor;
    }
    (level == 0 || few(margin, MAX_PAIRS)).then(|| regions(scene, margin, problem.start(), TURNS_PER_SIDE))
}

/// Returns the level's margin, metres.
fn margin(problem: &MotionProblem, first: f64, level: usize) -> f64 {
    first * extent(problem.scene().arm()) * 0.25_f64.powi(level as i32)
}

/// Returns the arm's extent in metres, to which margins are relative: the arm's reach, or a share of a prismatic joint's stroke
/// if that is greater.
pub(super) fn extent(arm: &Arm) -> f64 {
    let strokes = arm.joints.iter().filter(|joint| !joint.joint_type.is_revolute()).map(|joint| joint.range.extent());
    strokes.map(|stroke| STROKE_SHARE * stroke).fold(arm.reach(), f64::max)
}

/// Largest ratio of the joints' ranges for which a field's cells are square. With a larger ratio, the axis with the smaller range
/// would have too few cells.
const MAX_SQUARE_RATIO: f64 = 16.0;

/// Returns the cells of a level. `None` if the level is too fine. `first` gives the numbers of cells on level 0.
///
/// With [`GridSpace::Rows`], there are two levels for each number of cells, which then doubles along each axis. On the first one,
/// a cell is free if all of it is free. On the second one, it is free if its centre is, so passages look some three cells wider;
/// to show the same passage, cells that are free throughout would take sixteen times as long. The path is certified in either
/// case.
///
/// If `first` is `None`, cells are square in joint space, where a radian is as long as a metre. Then a field's equation does not
/// depend on the grid.
pub(super) fn grid_cells(
    problem: &MotionProblem,
    space: GridSpace,
    first: Option<CellCounts>,
    level: usize,
) -> Option<Grid> {
    let shape = finer(problem, space, first.unwrap_or(CellCounts::square(DEFAULT_CELLS)), level)?;
    let shape = if first.is_some() { shape } else { square_in_joint_space(problem, shape[0] as f64) };
    Some(grid(problem, space, level, shape))
}

/// Returns the numbers of cells along the axes, about `n * n` in total, that make cells square.
fn square_in_joint_space(problem: &MotionProblem, n: f64) -> [usize; 2] {
    let [a, b] = problem.scene().arm().topology().ranges.map(|axis| axis.extent());
    let ratio = (a / b).clamp(1.0 / MAX_SQUARE_RATIO, MAX_SQUARE_RATIO).sqrt();
    [n * ratio, n / ratio].map(|cells| cells.round().max(1.0) as usize)
}

/// Returns the cells of a level with the workspace's preferences.
pub(super) fn zoned_cells(
    problem: &MotionProblem,
    space: GridSpace,
    first: Option<CellCounts>,
    level: usize,
) -> Option<ZonedGrid> {
    grid_cells(problem, space, first, level).map(|grid| ZonedGrid::new(grid, problem.scene()))
}

/// Returns the numbers of cells along the axes on a level. `first` has those of level 0. `None` if the level is too fine.
fn finer(problem: &MotionProblem, space: GridSpace, CellCounts(first): CellCounts, level: usize) -> Option<[usize; 2]> {
    let (finer, checks) = match space {
        GridSpace::Rows => (level / 2, 0),
        GridSpace::Whole | GridSpace::Centers => (level, 0),
        GridSpace::Sampled => (level, problem.scene().pairs().len()),
    };
    let [a, b] = first.map(|n| n << finer);
    let is_few = || a.max(b) <= MAX_CELLS && a * b <= MAX_CHECKS / checks.max(1);
    (finer == 0 || is_few()).then_some([a, b])
}

fn grid(problem: &MotionProblem, space: GridSpace, level: usize, shape: [usize; 2]) -> Grid {
    let build = match space {
        GridSpace::Sampled => sampled_grid,
        GridSpace::Whole => outer_grid,
        GridSpace::Rows if level.is_multiple_of(2) => outer_grid,
        GridSpace::Rows | GridSpace::Centers => grid_from_slices,
    };
    build(problem.scene(), shape, problem.scene().workspace().clearance)
}
