//! A* over the cells of a decomposition.

use super::NONE;
use super::decomposition::{CellPortal, Decomposition};
use super::terminals::Terminals;
use crate::geometry::{OpenList, Ordered, Point};
use crate::interrupt::checkpoint;
use crate::space::{Measure, Metric, Segment};

/// Cells to pass, with the portals between them: one less than cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Channel {
    pub start: Point,
    /// Any of these will do, all in the last cell.
    pub goals: Segment,
    pub cells: Vec<usize>,
    pub portals: Vec<usize>,
}

/// Which portals each cell has, and what ways through them cost.
#[derive(Debug, Clone)]
pub(super) struct Adjacency {
    /// The portals of cell `c` are `portals[first[c]..first[c + 1]]`.
    first: Vec<u32>,
    portals: Vec<u32>,
    /// Centres of the cells.
    pub centers: Vec<Point>,
    /// Middles of the portals.
    pub middles: Vec<Point>,
}

impl Adjacency {
    /// Linear.
    pub fn new(decomposition: &Decomposition, centers: Vec<Point>) -> Self {
        let mut first = vec![0; centers.len() + 1];
        for cell in decomposition.portals.iter().flat_map(|portal| portal.cells) {
            first[cell + 1] += 1;
        }
        for k in 1..first.len() {
            first[k] += first[k - 1];
        }
        let mut place = first.clone();
        let mut portals = vec![0; 2 * decomposition.portals.len()];
        for (portal, number) in decomposition.portals.iter().zip(0..) {
            for cell in portal.cells {
                portals[place[cell] as usize] = number;
                place[cell] += 1;
            }
        }
        let middles = decomposition.portals.iter().map(|portal| nalgebra::center(&portal.low, &portal.high)).collect();
        Self { first, portals, centers, middles }
    }

    /// The cheapest channel from the start, given the cells that contain it, to any goal: passing from a cell to the
    /// next costs the way from the one's centre over the portal's middle to the other's, with the start and the nearest goal for
    /// the centres of the end cells. `O(n log n)` for `n` cells.
    pub fn channel(&self, portals: &[CellPortal], terminals: &Terminals, start_cells: &[usize]) -> Option<Channel> {
        let goal_cells = &terminals.parts;
        let mut search = Search {
            adjacency: self,
            portals,
            terminals,
            nodes: vec![Node { cost: f64::INFINITY, ..Node::START }; self.centers.len() + goal_cells.len()],
            is_goal: vec![false; self.centers.len()],
            open: OpenList::default(),
        };
        goal_cells.iter().for_each(|&(cell, _)| search.is_goal[cell as usize] = true);
        for &cell in start_cells {
            search.leave(cell, terminals.start, Node { cell: cell as u32, ..Node::START });
        }
        while let Some((_, (node, Ordered(cost)))) = search.open.pop() {
            checkpoint();
            if cost > search.nodes[node as usize].cost {
                continue;
            }
            if let Some(goal) = (node as usize).checked_sub(self.centers.len()) {
                return Some(search.channel(node, goal_cells[goal].1));
            }
            let from = Node { before: node, portal: NONE, cost, cell: node };
            search.leave(node as usize, self.centers[node as usize], from);
        }
        None
    }
}

/// How a cell, or a goal in a cell, is reached.
#[derive(Debug, Clone, Copy)]
struct Node {
    cost: f64,
    /// The cell before, `NONE` from the start.
    before: u32,
    /// The portal passed, `NONE` from the start to a goal in its cell.
    portal: u32,
    /// The cell left.
    cell: u32,
}

impl Node {
    const START: Self = Self { cost: 0.0, before: NONE, portal: NONE, cell: NONE };
}

struct Search<'a> {
    adjacency: &'a Adjacency,
    portals: &'a [CellPortal],
    terminals: &'a Terminals,
    nodes: Vec<Node>,
    is_goal: Vec<bool>,
    /// Nodes (those beyond the cells are goals) and their costs when they were put there, by estimate.
    open: OpenList<(u32, Ordered)>,
}

impl Search<'_> {
    /// Reaches what lies in a cell, which is left from `at`, and beyond its portals.
    fn leave(&mut self, cell: usize, at: Point, from: Node) {
        let Adjacency { first, portals, centers, middles } = self.adjacency;
        if from.before == NONE {
            self.reach_goals(cell, from, at, |goal| (goal - at).norm());
        }
        for &portal in &portals[first[cell] as usize..first[cell + 1] as usize] {
            let [left, right] = self.portals[portal as usize].cells;
            let other = if left == cell { right } else { left };
            let middle = middles[portal as usize];
            let way = |to: Point| (middle - at).norm() + (to - middle).norm();
            let through = Node { portal, ..from };
            self.reach(other, centers[other], Node { cost: from.cost + way(centers[other]), ..through });
            self.reach_goals(other, through, middle, way);
        }
    }

    /// Reaches the goals in a cell, of each the nearest to `last`.
    fn reach_goals(&mut self, cell: usize, from: Node, last: Point, way: impl Fn(Point) -> f64) {
        if self.is_goal[cell] {
            let parts = &self.terminals.parts;
            let first = parts.partition_point(|part| (part.0 as usize) < cell);
            let here = parts.iter().enumerate().skip(first).take_while(|(_, part)| part.0 as usize == cell);
            for (k, (_, goals)) in here {
                let goal = Point::from(goals.nearest(Measure::from(Metric::Euclidean), last.coords));
                self.reach(self.adjacency.centers.len() + k, goal, Node { cost: from.cost + way(goal), ..from });
            }
        }
    }

    fn reach(&mut self, node: usize, at: Point, by: Node) {
        if by.cost < self.nodes[node].cost {
            self.nodes[node] = by;
            let estimate = by.cost + self.terminals.straight_distance(at);
            self.open.push(estimate, (node as u32, Ordered(by.cost)));
        }
    }

    /// The way to a goal, backwards.
    fn channel(&self, last: u32, goals: Segment) -> Channel {
        let last = self.nodes[last as usize];
        let goal_cell = if last.portal == NONE { last.cell } else { self.beyond(last.portal, last.cell) };
        let (mut cells, mut portals) = (vec![goal_cell as usize], Vec::new());
        let mut node = last;
        while node.portal != NONE {
            portals.push(node.portal as usize);
            cells.push(node.cell as usize);
            if node.before == NONE {
                break;
            }
            node = self.nodes[node.before as usize];
        }
        cells.reverse();
        portals.reverse();
        Channel { start: self.terminals.start, goals, cells, portals }
    }

    /// The other cell of a portal.
    fn beyond(&self, portal: u32, cell: u32) -> u32 {
        let [left, right] = self.portals[portal as usize].cells;
        (if left == cell as usize { right } else { left }) as u32
    }
}
