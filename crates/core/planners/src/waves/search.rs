//! Classical searches over the cells of a grid, which expand no more cells than necessary.
//!
//! petgraph's searches report no number of expanded cells, have no rules for ties, and have no exact costs. Its hash
//! tables are slower than arrays. The tests compare the costs with petgraph's.

use super::deepening::deepen;
use super::{FreeCells, Neighborhood, UNREACHED};
use cplan_geometry::{OpenList, OrderedF64};
use cplan_interrupt::checkpoint;
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use std::collections::{BTreeSet, VecDeque};
use std::f64::consts::SQRT_2;

/// The order in which cells are expanded. All searches are the same algorithm with different lists of waiting cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// The cell that was found first. Finds a path with the fewest moves.
    BreadthFirst,
    /// The cell that was found last. Finds any path, seldom a short one.
    DepthFirst,
    /// The cell of least cost. Finds a shortest path.
    Dijkstra,
    /// The cell with the least sum of cost and estimated remaining cost. Finds a shortest path, usually faster than
    /// Dijkstra's algorithm. The estimate is the cost without obstacles, so no cell is expanded twice.
    AStar(Ties),
    /// The cell with the least estimated remaining cost, and of equal ones the latest. Finds some path.
    Greedy,
    /// Depth-first search within a limit of moves. The limit grows by one until the search meets a target. Finds a path
    /// with the fewest moves.
    IterativeDeepening,
}

impl Order {
    /// Returns true if the order depends on estimates of the remaining cost.
    pub fn estimates(self) -> bool {
        matches!(self, Self::AStar(_) | Self::Greedy)
    }
}

/// The rule for choosing among cells with the same estimated total cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ties {
    /// The cell farther from the source, and of equal ones the latest. The search continues straight ahead.
    #[default]
    Farthest,
    /// The cell that was added first. Cells with equal estimates are expanded in rounds, one step at a time.
    First,
}

impl Ties {
    /// Returns true for the default rule.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Farthest => "farthest",
            Self::First => "first",
        }
    }
}

/// Cost of a path from cell to cell: 1 for a straight move, and the square root of 2 for a diagonal one, whatever the
/// sizes of cells in joint space. Two integers store it exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Cost {
    /// Number of straight moves.
    pub straight: u32,
    /// Number of diagonal moves.
    pub diagonal: u32,
}

impl Cost {
    /// Returns the cost as a number. Below about 10^7 moves, different costs give different numbers in the right order.
    pub fn value(self) -> f64 {
        f64::from(self.straight) + SQRT_2 * f64::from(self.diagonal)
    }

    /// Returns the number of moves.
    pub fn moves(self) -> u32 {
        self.straight + self.diagonal
    }

    pub(super) fn and(self, other: Cost) -> Cost {
        Cost { straight: self.straight + other.straight, diagonal: self.diagonal + other.diagonal }
    }
}

/// The estimates of A\* and of greedy searches: the cost from a cell to the nearest target without obstacles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Estimates {
    /// The cells that end the search.
    pub targets: Vec<usize>,
    /// The neighbours to which a move may lead.
    pub neighborhood: Neighborhood,
}

impl Estimates {
    /// Returns the estimate of a cell. Takes time proportional to the number of targets.
    pub fn of(&self, free: &FreeCells, cell: usize) -> Cost {
        let costs = self.targets.iter().map(|&target| straight_cost(free, self.neighborhood, cell, target));
        costs.min_by(|a, b| a.value().total_cmp(&b.value())).unwrap_or_default()
    }
}

/// The result of a search, for each cell of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    pub(super) costs: Vec<Cost>,
    /// For each cell, the cell from which it was labelled. Sources have themselves. Cells without a label have [`UNREACHED`].
    pub(super) parents: Vec<u32>,
    /// The cells that were expanded, each once, in the order of their first expansion.
    pub expanded: Vec<u32>,
    /// Number of cells that were labelled, sources included.
    pub labeled: usize,
    /// The target that ended the search. `None` if the search reached no target.
    pub met: Option<usize>,
    /// Number of rounds: 1, except for iterative deepening.
    pub rounds: usize,
    /// Number of expansions in all rounds together. Repeated expansions of a cell count.
    pub expansions: usize,
}

/// Number of cells that are expanded between two checks for an interruption. They take less than a millisecond.
pub(super) const CELLS_BETWEEN_CHECKPOINTS: usize = 4096;

impl Search {
    /// Searches from all free cells among `sources` at once, until `target` or all reachable cells have been
    /// expanded.
    ///
    /// Breadth-first, depth-first and greedy search label a cell only once, when they first reach it. The others lower
    /// the cost of a cell until it is expanded. Takes time linear in the number of labelled cells, for Dijkstra and A\*
    /// times the logarithm of that number. Filling the tables takes time linear in the size of the grid.
    pub fn new(free: &FreeCells, neighborhood: Neighborhood, order: Order, sources: &[usize], target: usize) -> Self {
        Self::to_any(free, neighborhood, order, sources, &[target])
    }

    /// Like [`Search::new`], until one of several targets is expanded. The estimate is that of the nearest target, and
    /// takes time proportional to the number of targets.
    pub fn to_any(
        free: &FreeCells,
        neighborhood: Neighborhood,
        order: Order,
        sources: &[usize],
        targets: &[usize],
    ) -> Self {
        let targets: BTreeSet<usize> = targets.iter().copied().collect();
        let (mut search, sources) = Self::with_labeled_sources(free, sources);
        if order == Order::IterativeDeepening {
            deepen(&mut search, free, neighborhood, &sources, &targets);
            return search;
        }
        let mut open = OpenCells::new(order);
        let estimates = Estimates { targets: targets.iter().copied().collect(), neighborhood };
        let estimate = |cell: usize| if order.estimates() { estimates.of(free, cell) } else { Cost::default() };
        for source in sources {
            open.push(source, Cost::default(), estimate(source));
        }
        while let Some((cell, cost)) = open.pop() {
            // The cell was reached at a lower cost since, so this entry is obsolete.
            if cost != search.costs[cell] {
                continue;
            }
            search.expanded.push(cell as u32);
            if search.expanded.len().is_multiple_of(CELLS_BETWEEN_CHECKPOINTS) {
                checkpoint();
            }
            if targets.contains(&cell) {
                search.met = Some(cell);
                break;
            }
            for next in free.moves(cell, neighborhood) {
                let (straight, diagonal) = (u32::from(!next.is_diagonal), u32::from(next.is_diagonal));
                let reached = cost.and(Cost { straight, diagonal });
                let is_new = search.parents[next.to] == UNREACHED;
                if is_new || (open.relaxes() && reached.value() < search.costs[next.to].value()) {
                    search.labeled += usize::from(is_new);
                    search.parents[next.to] = cell as u32;
                    search.costs[next.to] = reached;
                    open.push(next.to, reached, estimate(next.to));
                }
            }
        }
        search.expansions = search.expanded.len();
        search
    }

    /// Labels the sources of a search, and returns the free ones, each once.
    fn with_labeled_sources(free: &FreeCells, sources: &[usize]) -> (Self, Vec<usize>) {
        let [rows, columns] = free.cells();
        let size = rows * columns;
        let (costs, mut parents) = (vec![Cost::default(); size], vec![UNREACHED; size]);
        let mut begins = Vec::new();
        for &source in sources {
            if free.is_free(source) && parents[source] == UNREACHED {
                parents[source] = source as u32;
                begins.push(source);
            }
        }
        let labeled = begins.len();
        (Self { costs, parents, expanded: Vec::new(), labeled, met: None, rounds: 1, expansions: 0 }, begins)
    }

    /// Returns the cost of the path by which `cell` was reached; `None` if it was not reached. For cells that Dijkstra
    /// or A\* has expanded, it is the least cost. After a breadth-first search, the path has the fewest moves.
    pub fn cost(&self, cell: usize) -> Option<Cost> {
        (self.parents[cell] != UNREACHED).then(|| self.costs[cell])
    }

    /// Returns, for each cell, the number of moves on the path by which it was reached, or [`UNREACHED`].
    pub fn labels(&self) -> Vec<u32> {
        let label = |(cost, &parent): (&Cost, &u32)| if parent == UNREACHED { UNREACHED } else { cost.moves() };
        self.costs.iter().zip(&self.parents).map(label).collect()
    }

    /// Returns the cells of the path from `cell` back to the source; `None` if the cell was not reached.
    pub fn path_back(&self, cell: usize) -> Option<Vec<usize>> {
        if self.parents[cell] == UNREACHED {
            return None;
        }
        let mut cells = vec![cell];
        let mut at = cell;
        while self.parents[at] as usize != at {
            at = self.parents[at] as usize;
            cells.push(at);
        }
        Some(cells)
    }
}

/// Returns the cost of a path between two cells without obstacles, in the shorter direction on circles.
fn straight_cost(free: &FreeCells, neighborhood: Neighborhood, from: usize, to: usize) -> Cost {
    let cells = free.cells();
    let apart = |axis: usize| {
        let at = |cell: usize| if axis == 0 { cell / cells[1] } else { cell % cells[1] };
        let apart = at(from).abs_diff(at(to));
        if free.circles()[axis] { apart.min(cells[axis] - apart) as u32 } else { apart as u32 }
    };
    let (a, b) = (apart(0), apart(1));
    match neighborhood {
        Neighborhood::Four => Cost { straight: a + b, diagonal: 0 },
        Neighborhood::Eight => Cost { straight: a.abs_diff(b), diagonal: a.min(b) },
    }
}

/// The keys that break ties between waiting cells with equal estimates, followed by the cell and its cost.
type WaitingCell = (Reverse<OrderedF64>, Reverse<u64>, usize, [u32; 2]);

/// The list of cells that wait for expansion.
enum OpenCells {
    Queue(VecDeque<(usize, Cost)>),
    Stack(Vec<(usize, Cost)>),
    /// The cell of least estimate first. The number counts the cells that were added.
    Least(OpenList<WaitingCell>, Ties, u64),
    /// The cell of least remaining cost comes first, and of equal ones the latest. The number counts the cells that were added.
    Nearest(OpenList<WaitingCell>, u64),
}

impl OpenCells {
    fn new(order: Order) -> Self {
        match order {
            Order::BreadthFirst => Self::Queue(VecDeque::new()),
            // Each round of iterative deepening is depth-first.
            Order::DepthFirst | Order::IterativeDeepening => Self::Stack(Vec::new()),
            Order::Dijkstra => Self::Least(OpenList::default(), Ties::First, 0),
            Order::AStar(ties) => Self::Least(OpenList::default(), ties, 0),
            Order::Greedy => Self::Nearest(OpenList::default(), 0),
        }
    }

    /// Returns true if the cost of a waiting cell may be lowered.
    fn relaxes(&self) -> bool {
        matches!(self, Self::Least(..))
    }

    fn push(&mut self, cell: usize, cost: Cost, rest: Cost) {
        match self {
            Self::Queue(queue) => queue.push_back((cell, cost)),
            Self::Stack(stack) => stack.push((cell, cost)),
            Self::Least(open, ties, count) => {
                *count += 1;
                let (farther, turn) = match ties {
                    Ties::Farthest => (cost.value(), *count),
                    Ties::First => (0.0, u64::MAX - *count),
                };
                let tie = (Reverse(OrderedF64(farther)), Reverse(turn));
                open.push(cost.and(rest).value(), (tie.0, tie.1, cell, [cost.straight, cost.diagonal]));
            }
            Self::Nearest(open, count) => {
                *count += 1;
                let tie = (Reverse(OrderedF64(0.0)), Reverse(*count));
                open.push(rest.value(), (tie.0, tie.1, cell, [cost.straight, cost.diagonal]));
            }
        }
    }

    fn pop(&mut self) -> Option<(usize, Cost)> {
        match self {
            Self::Queue(queue) => queue.pop_front(),
            Self::Stack(stack) => stack.pop(),
            Self::Least(open, ..) | Self::Nearest(open, _) => {
                open.pop().map(|(_, (.., cell, [straight, diagonal]))| (cell, Cost { straight, diagonal }))
            }
        }
    }
}
