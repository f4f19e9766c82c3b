//! Shortest paths over a grid of configurations, and the motions along them.

use cplan_interrupt::checkpoint;
use cplan_judge::StraightMotions;
use cplan_model::Scene;
use cplan_model::space::{Configuration, Path};
use cplan_planners::cspace::Grid;
use cplan_planners::waves::{FreeCells, Neighborhood};
use std::collections::{BTreeSet, VecDeque};

/// Steps between neighbouring cells that are not free, although both centres are.
pub type BlockedMoves = BTreeSet<[usize; 2]>;

/// The cells that can be reached from a configuration, and the shortest paths to them from cell to cell.
#[derive(Debug)]
pub struct Reach {
    /// Length of the shortest path to each cell; infinite if the cell cannot be reached.
    costs: Vec<f64>,
    before: Vec<u32>,
    /// Reached cells in ascending order of their costs.
    pub cells: Vec<usize>,
}

/// Cells that are still to be examined, in one queue for each length of a step and one for the start.
///
/// The search takes cells in ascending order of cost, and all entries of a queue add the same length to it. So each
/// queue is sorted without a heap.
#[derive(Debug, Default)]
struct OpenQueues([VecDeque<(f64, usize)>; 4]);

impl OpenQueues {
    fn push(&mut self, queue: usize, cost: f64, cell: usize) {
        self.0[queue].push_back((cost, cell));
    }

    fn pop(&mut self) -> Option<(f64, usize)> {
        let first = |queue: &VecDeque<(f64, usize)>| queue.front().map_or(f64::INFINITY, |&(cost, _)| cost);
        let next = self.0.iter_mut().min_by(|a, b| first(a).total_cmp(&first(b)));
        next.and_then(VecDeque::pop_front)
    }
}

/// Represents a missing cell.
const NO_CELL: u32 = u32::MAX;

impl Reach {
    /// Searches from the cells `joined` to `start` by straight motions. Calls `is_enough` for each reached cell with
    /// the length of its path, and stops when it returns true.
    pub fn new(
        grid: &Grid,
        closed: &BlockedMoves,
        start: Configuration,
        joined: &[usize],
        mut is_enough: impl FnMut(usize, f64) -> bool,
    ) -> Self {
        let free = FreeCells::new(grid);
        let count = grid.blocked.len();
        let mut reach = Self { costs: vec![f64::INFINITY; count], before: vec![NO_CELL; count], cells: Vec::new() };
        let (sides, columns) = (grid.step(), grid.cells[1]);
        let lengths = [sides[0], sides[1], sides[0].hypot(sides[1])];
        let mut open = OpenQueues::default();
        let mut begin: Vec<(f64, usize)> =
            joined.iter().map(|&cell| (grid.topology.distance(start, grid.center(cell)), cell)).collect();
        begin.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (cost, cell) in begin {
            reach.costs[cell] = cost;
            open.push(lengths.len(), cost, cell);
        }
        while let Some((cost, cell)) = open.pop() {
            checkpoint();
            if cost > reach.costs[cell] {
                continue;
            }
            reach.cells.push(cell);
            if is_enough(cell, cost) {
                break;
            }
            for step in free.moves(cell, Neighborhood::Eight) {
                let kind = if step.is_diagonal { 2 } else { usize::from(cell / columns == step.to / columns) };
                let cost = cost + lengths[kind];
                if cost < reach.costs[step.to] && !closed.contains(&[cell, step.to]) {
                    reach.costs[step.to] = cost;
                    reach.before[step.to] = cell as u32;
                    open.push(kind, cost, step.to);
                }
            }
        }
        reach
    }

    /// Returns the cells of the path to a cell, which comes last.
    pub fn route(&self, cell: usize) -> Vec<usize> {
        let mut route = vec![cell];
        while let Some(&last) = route.last().filter(|&&last| self.before[last] != NO_CELL) {
            route.push(self.before[last] as usize);
        }
        route.reverse();
        route
    }

    /// Returns the path to a cell. If `cell` is `None`, returns the reachable cells as the error.
    pub fn route_to(self, cell: Option<usize>) -> Result<Vec<usize>, Self> {
        cell.map(|cell| self.route(cell)).ok_or(self)
    }
}

/// Returns the configurations of a path, in unwrapped values: the start, then the centres of the cells.
pub fn unwrapped(grid: &Grid, start: Configuration, route: &[usize]) -> Vec<Configuration> {
    let mut at = vec![start];
    for &cell in route {
        at.push(grid.topology.lift(grid.center(cell), at[at.len() - 1]));
    }
    at.dedup();
    at
}

/// Returns the cells near a configuration to whose centres a free straight motion leads, the nearest first.
pub fn join(scene: &Scene, grid: &Grid, q: Configuration) -> Vec<usize> {
    let motions = straight_motions(scene);
    let mut near = free_around(grid, q);
    near.retain(|&cell| motions.is_free(q, grid.topology.lift(grid.center(cell), q)));
    near
}

/// Returns the free cells near a configuration, the nearest first.
pub fn free_around(grid: &Grid, q: Configuration) -> Vec<usize> {
    let middle = grid.locate(q);
    let beside = std::iter::once(middle).chain(grid.neighbors(middle));
    let mut near: Vec<usize> = beside.flat_map(|cell| std::iter::once(cell).chain(grid.neighbors(cell))).collect();
    near.sort_unstable();
    near.dedup();
    near.retain(|&cell| !grid.blocked[cell]);
    near.sort_by(|a, b| {
        let far = |cell: usize| grid.topology.distance(q, grid.center(cell));
        far(*a).total_cmp(&far(*b)).then(a.cmp(b))
    });
    near
}

/// Returns a test whether straight motions keep the scene's clearance.
pub fn straight_motions(scene: &Scene) -> StraightMotions<'_> {
    StraightMotions::new(scene, scene.workspace().clearance)
}

/// Removes waypoints. From each remaining waypoint, a galloping search finds a far one that a free straight motion
/// reaches, among the next `most`.
///
/// # Errors
/// The index of the first step, if no free straight motion leads even to the next waypoint.
pub fn tightened(scene: &Scene, waypoints: &[Configuration], most: usize) -> Result<Path, usize> {
    let motions = straight_motions(scene);
    let mut kept = vec![waypoints[0]];
    let mut at = 0;
    while at + 1 < waypoints.len() {
        let goes = |to: usize| motions.is_free(waypoints[at], waypoints[to]);
        if !goes(at + 1) {
            return Err(at);
        }
        let end = waypoints.len().min(at.saturating_add(most).saturating_add(1));
        let (mut good, mut bad) = (at + 1, end);
        let mut step = 2;
        while good + 1 < bad {
            let next = if bad == end { (at + step).min(bad - 1) } else { usize::midpoint(good, bad) };
            if goes(next) {
                good = next
            } else {
                bad = next
            }
            step *= 2;
            if good == end - 1 {
                break;
            }
        }
        kept.push(waypoints[good]);
        at = good;
    }
    Ok(Path::new(kept))
}

/// Returns configurations along a path, at most `step` apart, including all corners but not the start.
pub fn places(path: &Path, step: f64) -> Vec<Configuration> {
    let pieces = path.segments().flat_map(|(from, to)| {
        let count = ((to - from).norm() / step).ceil().max(1.0) as usize;
        (1..=count).map(move |k| if k == count { to } else { from + (to - from) * (k as f64 / count as f64) })
    });
    pieces.collect()
}
