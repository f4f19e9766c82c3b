//! The representation of each level: finer and finer approximations of one configuration space.

use super::setting::FIRST_CELLS;
use super::{CellCounts, GridSpace, Space};
use cplan_core::cspace::{
    Grid, Proves, Regions, ZonedGrid, exact_regions, grid_from_slices, has_exact_polygons, outer_grid, regions,
    sampled_grid, traced_pairs,
};
use cplan_core::model::{Arm, MotionProblem};

/// Grids end here: 2048 x 2048 cells, beyond which fields take minutes.
const MOST_CELLS: usize = 2048;

/// Collision checks of a sampled grid: some ten seconds' worth. Where it takes more there is no finer one.
const MOST_CHECKS: usize = 1 << 30;

/// Share of a slide's stroke that counts as reach where that is smaller, as for a gantry's slender tool.
const STROKE: f64 = 0.1;

/// Turns of the universal cover to plan in, on either side of the start.
const PERIODS: usize = 1;

/// Pairs of shapes that polygons are made of on the first level: a second's worth, or two. With more, the margin is greater,
/// ...
const FIRST_PAIRS: usize = 6144;

/// ... by this factor as often as need be, up to so many times.
const WIDER: (f64, usize) = (2.0, 6);

/// Pairs of shapes on finer levels. With more there is no such level.
const MOST_PAIRS: usize = 16_384;

/// The first margin after exact polygons, as a share of the arm's reach: paths among the exact ones mostly touch, and these are to be as
/// near as a path within the usual gap of the shortest.
const AFTER_EXACT: f64 = 4e-5;

/// Polygons of the level: with a first margin of 0 exact ones first, if the arm has any, then grown ones; else all grown. None when
/// there is no finer level.
pub(super) fn polygons(problem: &MotionProblem, first: f64, level: usize) -> Option<Regions> {
    if first > 0.0 {
        return grown_polygons(problem, first, level);
    }
    match level.checked_sub(usize::from(has_exact_polygons(problem.scene()))) {
        Some(level) => grown_polygons(problem, AFTER_EXACT, level),
        None => exact_regions(problem.scene()),
    }
}

/// Polygons grown by the level's margin, a quarter of that of the level before, of which the first is a share of the arm's
/// reach; none when there is no finer level.
fn grown_polygons(problem: &MotionProblem, first: f64, level: usize) -> Option<Regions> {
    let scene = problem.scene();
    let few = |margin: f64, most: usize| scene.pairs().len() <= most || traced_pairs(scene, margin) <= most;
    let (mut margin, (factor, times)) = (margin(problem, first, level), WIDER);
    for _ in 0..times {
        let first = margin * 4_f64.powi(level as i32);
        if few(first, FIRST_PAIRS) {
            break;
        }
        margin *= factor;
    }
    (level == 0 || few(margin, MOST_PAIRS)).then(|| regions(scene, margin, problem.start(), PERIODS))
}

/// The level's margin, metres.
fn margin(problem: &MotionProblem, first: f64, level: usize) -> f64 {
    first * extent(problem.scene().arm()) * 0.25_f64.powi(level as i32)
}

/// What margins are shares of: the arm's reach, or so much of a slide's stroke.
pub(super) fn extent(arm: &Arm) -> f64 {
    let strokes = arm.joints.iter().filter(|joint| !joint.joint_type.is_revolute()).map(|joint| joint.range.extent());
    strokes.map(|stroke| STROKE * stroke).fold(arm.reach(), f64::max)
}

/// Ratio of the axes' ranges up to which a field's cells are square. Beyond, the finer axis would get too few.
const MOST_OBLONG: f64 = 16.0;

/// Cells of the level's size: twice as many with every second level. On the first of two levels of
/// one size free cells are wholly free; should these be too few, cells of free centres follow on the second, which show
/// passages some three cells wider. What a path among those is worth is for the certificate to say; it takes a sixteenth of
/// the time that wholly free cells of the same passage take.
///
/// Where no number is given cells are square in joint space, where a radian is as long as a metre: then a field's equation is
/// that of the configuration space, not of its picture on a grid.
pub(super) fn grid_cells(
    problem: &MotionProblem,
    space: GridSpace,
    first: Option<CellCounts>,
    level: usize,
) -> Option<Grid> {
    let shape = finer(problem, space, first.unwrap_or(CellCounts::square(FIRST_CELLS)), level)?;
    let shape = if first.is_some() { shape } else { square_in_joint_space(problem, shape[0] as f64) };
    Some(grid(problem, space, level, shape))
}

/// Numbers of cells along the axes, `n * n` in all, so that cells are as long along one as along the other.
fn square_in_joint_space(problem: &MotionProblem, n: f64) -> [usize; 2] {
    let [a, b] = problem.scene().arm().topology().ranges.map(|axis| axis.extent());
    let ratio = (a / b).clamp(1.0 / MOST_OBLONG, MOST_OBLONG).sqrt();
    [n * ratio, n / ratio].map(|cells| cells.round().max(1.0) as usize)
}

/// The same with the workspace's preferences.
pub(super) fn zoned_cells(
    problem: &MotionProblem,
    space: GridSpace,
    first: Option<CellCounts>,
    level: usize,
) -> Option<ZonedGrid> {
    grid_cells(problem, space, first, level).map(|grid| ZonedGrid::new(grid, problem.scene()))
}

/// Cells along the axes, if the level is not too fine.
fn finer(problem: &MotionProblem, space: GridSpace, CellCounts(first): CellCounts, level: usize) -> Option<[usize; 2]> {
    let (finer, checks) = match space {
        GridSpace::Rows => (level / 2, 0),
        GridSpace::Centers => (level, 0),
        GridSpace::Sampled => (level, problem.scene().pairs().len()),
    };
    let [a, b] = first.map(|n| n << finer);
    let is_few = || a.max(b) <= MOST_CELLS && a * b <= MOST_CHECKS / checks.max(1);
    (finer == 0 || is_few()).then_some([a, b])
}

fn grid(problem: &MotionProblem, space: GridSpace, level: usize, shape: [usize; 2]) -> Grid {
    let build = match space {
        GridSpace::Sampled => sampled_grid,
        GridSpace::Rows if level.is_multiple_of(2) => outer_grid,
        GridSpace::Rows | GridSpace::Centers => grid_from_slices,
    };
    build(problem.scene(), shape, problem.scene().workspace().clearance)
}

/// A space in a few words.
pub(super) trait Described {
    fn describe(&self) -> String;
}

impl Described for Regions {
    fn describe(&self) -> String {
        format!("polygons ({})", self.proves)
    }
}

impl Described for Grid {
    fn describe(&self) -> String {
        let kind = if self.proves == Proves::Sampled { " by their centres" } else { "" };
        format!("{} x {} cells{kind}", self.cells[0], self.cells[1])
    }
}

impl Described for ZonedGrid {
    fn describe(&self) -> String {
        self.grid.describe()
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

impl From<ZonedGrid> for Space {
    fn from(zoned: ZonedGrid) -> Self {
        zoned.grid.into()
    }
}
