//! The representation of each level: successively finer approximations of one configuration space.

use super::setting::DEFAULT_CELLS;
use super::{CellCounts, GridSpace};
use cplan_model::{Arm, MotionProblem};
use cplan_planners::cspace::{
    Grid, Regions, ZonedGrid, exact_regions, grid_from_slices, not_polygons, outer_grid, regions, sampled_grid,
    traced_pairs,
};

/// Largest number of cells along an axis on levels after the first. With more than 2048 x 2048 cells, fields take
/// minutes.
const MAX_CELLS: usize = 2048;

/// Largest number of collision checks of a sampled grid on levels after the first. They take some ten seconds. A level
/// that needs more has no grid.
const MAX_CHECKS: usize = 1 << 30;

/// If the reach is smaller than this fraction of a prismatic joint's stroke, the fraction replaces it. This is so for a
/// gantry with a slender tool.
const STROKE_SHARE: f64 = 0.1;

/// Number of whole turns of continuous joints, on either side of the start, that polygons cover.
const TURNS_PER_SIDE: usize = 1;

/// Largest number of pairs of shapes from which polygons are made on the first level without a larger margin. They take
/// one or two seconds. With more pairs, [`MARGIN_INCREASE`] applies.
const MAX_FIRST_PAIRS: usize = 6144;

/// Factor by which the margin grows while there are more than [`MAX_FIRST_PAIRS`] pairs, and how often it may grow. A
/// greater margin merges shapes, so that fewer pairs remain.
const MARGIN_INCREASE: (f64, usize) = (2.0, 6);

/// Largest number of pairs of shapes from which polygons are made on levels after the first. A level with more has no
/// polygons.
const MAX_PAIRS: usize = 16_384;

/// Margin of the level after exact polygons, as a share of the arm's reach. Paths among exact polygons usually touch
/// them and are refused. With this margin, paths are still within the usual gap (1e-4) of the shortest.
const MARGIN_AFTER_EXACT: f64 = 4e-5;

/// Returns the polygons of a level. If `first`, the first margin, is 0 and C-obstacles are polygons, the first level has
/// them. All other polygons are grown. `None` if there is no finer level.
pub(super) fn polygons(problem: &MotionProblem, first: f64, level: usize) -> Option<Regions> {
    if first > 0.0 {
        return grown_polygons(problem, first, level);
    }
    match level.checked_sub(usize::from(not_polygons(problem.scene()).is_none())) {
        Some(level) => grown_polygons(problem, MARGIN_AFTER_EXACT, level),
        None => exact_regions(problem.scene()),
    }
}

/// Returns polygons grown by the level's margin. `first`, the margin of level 0, is a share of the arm's extent. Each
/// level has a quarter of the margin of the level before. `None` if there is no finer level.
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

/// Returns the arm's extent, metres, to which margins are relative: the arm's reach, or a share of a prismatic joint's
/// stroke if that is greater.
pub(super) fn extent(arm: &Arm) -> f64 {
    let strokes = arm.joints.iter().filter(|joint| !joint.joint_type.is_revolute()).map(|joint| joint.range.extent());
    strokes.map(|stroke| STROKE_SHARE * stroke).fold(arm.reach(), f64::max)
}

/// Largest ratio of the two joints' ranges for which a field's cells are square. With a larger ratio, the axis with the
/// smaller range would get too few square cells.
const MAX_SQUARE_RATIO: f64 = 16.0;

/// Returns the cells of a level. `None` if the level is too fine. `first` gives the numbers of cells on level 0.
///
/// With [`GridSpace::Rows`], the number along each axis doubles with every second level. There are two levels of each
/// size. On the first, a cell counts as free if all of it is free. On the second, it counts as free if its centre is,
/// so passages look some three cells wider. The path is certified in either case. To show the same passage, cells that
/// are free throughout would take sixteen times as long.
///
/// If `first` is `None`, cells are square in joint space, where a radian is as long as a metre. Then a field's equation
/// is that of the configuration space, and does not depend on the grid.
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

/// Returns the numbers of cells along the axes that make cells square. There are about `n * n` cells in total.
fn square_in_joint_space(problem: &MotionProblem, n: f64) -> [usize; 2] {
    let [a, b] = problem.scene().arm().topology().ranges.map(|axis| axis.extent());
    let ratio = (a / b).clamp(1.0 / MAX_SQUARE_RATIO, MAX_SQUARE_RATIO).sqrt();
    [n * ratio, n / ratio].map(|cells| cells.round().max(1.0) as usize)
}

/// Returns the cells of a level, with the preferences of the workspace's zones.
pub(super) fn zoned_cells(
    problem: &MotionProblem,
    space: GridSpace,
    first: Option<CellCounts>,
    level: usize,
) -> Option<ZonedGrid> {
    grid_cells(problem, space, first, level).map(|grid| ZonedGrid::new(grid, problem.scene()))
}

/// Returns the numbers of cells along the axes on a level; `first` gives those of level 0. `None` if the level is too
/// fine.
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
