//! The graph search of all roadmaps. Search orders determine which node is expanded next.
//!
//! The algorithms are petgraph's. Its A\* is Dijkstra's algorithm if the estimate is 0, and the greedy search if
//! edges cost nothing. Its walkers search breadth-first and depth-first, without recursion. This module adds the
//! order in which nodes are expanded, and the predecessors of a walker's nodes.

use cplan_interrupt::checkpoint;
use petgraph::algo::astar;
use petgraph::graph::{NodeIndex, UnGraph};
use petgraph::visit::{Bfs, Dfs, VisitMap};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The rule that selects the next node to expand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SearchOrder {
    /// The node that was found first. Finds a path with the fewest edges.
    BreadthFirst,
    /// The node that was found last. Finds any path, seldom a short one.
    DepthFirst,
    /// The node of least cost. Finds a shortest path.
    Dijkstra,
    /// The node with the least sum of cost and straight distance to a goal. Finds a shortest path, usually faster than
    /// Dijkstra's algorithm.
    #[default]
    AStar,
    /// The node with the least straight distance to a goal. Finds some path fast.
    Greedy,
}

impl SearchOrder {
    /// All orders, as listed in the command line's help.
    pub const ALL: [Self; 5] = [Self::BreadthFirst, Self::DepthFirst, Self::Dijkstra, Self::AStar, Self::Greedy];

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::BreadthFirst => "bfs",
            Self::DepthFirst => "dfs",
            Self::Dijkstra => "dijkstra",
            Self::AStar => "astar",
            Self::Greedy => "greedy",
        }
    }

    /// Returns true if the search finds a shortest path on the roadmap.
    pub fn is_optimal(self) -> bool {
        matches!(self, Self::Dijkstra | Self::AStar)
    }
}

/// The search method for a roadmap (LaValle, *Planning Algorithms*, 2006, section 2.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoadmapSearch {
    /// The rule that selects the next node to expand.
    pub order: SearchOrder,
    /// True to search from the goals to the start. False to search from the start to a goal.
    pub backward: bool,
}

impl RoadmapSearch {
    /// Returns true for the default search: A\* from the start.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl fmt::Display for RoadmapSearch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.order.name(), if self.backward { ", backward" } else { "" })
    }
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SearchResult {
    /// The route from the start to a goal, for both directions of search. `None` if no goal is connected with the start.
    pub path: Option<Vec<NodeIndex>>,
    /// The nodes in the order of their expansion. The node that ended the search is the last.
    pub expanded: Vec<NodeIndex>,
}

/// The input of a search. Estimates must never exceed the true cost, and must be consistent, as straight distances are.
pub struct SearchProblem<G, C, A, B> {
    /// The node at which routes begin.
    pub start: NodeIndex,
    /// Returns true if a node is a goal.
    pub is_goal: G,
    /// Returns the cost of an edge, at least 0.
    pub cost: C,
    /// Returns an estimate of the cost from a node to the nearest goal.
    pub ahead: A,
    /// Returns an estimate of the cost from the start to a node.
    pub behind: B,
}

/// Searches a graph from the start to any goal, or from the goals to the start. For `n` nodes and `m` edges,
/// breadth-first and depth-first search take `O(n + m)`; the others take `O((n + m) log n)`. A forward search visits
/// only the nodes that it expands, except for tables of all nodes. A backward search copies the graph first.
pub fn search<N, E, G, C, A, B>(
    graph: &UnGraph<N, E>,
    how: RoadmapSearch,
    question: &SearchProblem<G, C, A, B>,
) -> SearchResult
where
    G: Fn(NodeIndex) -> bool,
    C: Fn(&E) -> f64,
    A: Fn(NodeIndex) -> f64,
    B: Fn(NodeIndex) -> f64,
{
    let SearchProblem { start, is_goal, cost, ahead, behind } = question;
    if !how.backward {
        return run(graph, *start, is_goal, how.order, cost, ahead);
    }
    // The search begins at all goals at once: an additional node is joined to each of them at no cost.
    let mut turned = graph.map(|_, _| (), |_, edge| cost(edge));
    let hub = turned.add_node(());
    let mut nearest = f64::INFINITY;
    for goal in graph.node_indices().filter(|&node| is_goal(node)) {
        turned.add_edge(hub, goal, 0.0);
        nearest = nearest.min(behind(goal));
    }
    let rest = |node: NodeIndex| if node == hub { nearest } else { behind(node) };
    let mut searched = run(&turned, hub, |node| node == *start, how.order, |cost| *cost, rest);
    searched.expanded.retain(|&node| node != hub);
    if let Some(path) = &mut searched.path {
        path.retain(|&node| node != hub);
        path.reverse();
        // If the route contains several goals, the motion ends at the first one.
        let end = path.iter().position(|&node| is_goal(node)).map_or(path.len(), |at| at + 1);
        path.truncate(end);
    }
    searched
}

fn run<N, E>(
    graph: &UnGraph<N, E>,
    from: NodeIndex,
    is_end: impl Fn(NodeIndex) -> bool,
    order: SearchOrder,
    cost: impl Fn(&E) -> f64,
    estimate: impl Fn(NodeIndex) -> f64,
) -> SearchResult {
    let (guided, priced) = match order {
        SearchOrder::BreadthFirst | SearchOrder::DepthFirst => return walk(graph, from, is_end, order),
        SearchOrder::Dijkstra => (false, true),
        SearchOrder::AStar => (true, true),
        SearchOrder::Greedy => (true, false),
    };
    let (mut expanded, mut seen) = (Vec::new(), vec![false; graph.node_count()]);
    let ends_at = |node: NodeIndex| {
        // A node that a shorter path reaches again counts only once.
        if !std::mem::replace(&mut seen[node.index()], true) {
            expanded.push(node);
        }
        is_end(node)
    };
    let passing = |edge: petgraph::graph::EdgeReference<'_, E>| {
        checkpoint();
        if priced { cost(edge.weight()) } else { 0.0 }
    };
    // At an end the remaining cost is 0, despite rounding.
    let rest = |node: NodeIndex| if guided && !is_end(node) { estimate(node) } else { 0.0 };
    let path = astar(graph, from, ends_at, passing, rest).map(|(_, path)| path);
    SearchResult { path, expanded }
}

/// Searches breadth-first or depth-first.
fn walk<N, E>(
    graph: &UnGraph<N, E>,
    from: NodeIndex,
    is_end: impl Fn(NodeIndex) -> bool,
    order: SearchOrder,
) -> SearchResult {
    enum Traversal<B, D> {
        Breadth(B),
        Depth(D),
    }
    let mut walker = match order {
        SearchOrder::DepthFirst => Traversal::Depth(Dfs::new(graph, from)),
        _ => Traversal::Breadth(Bfs::new(graph, from)),
    };
    let mut parents: Vec<Option<NodeIndex>> = vec![None; graph.node_count()];
    let mut expanded = Vec::new();
    loop {
        checkpoint();
        let next = match &mut walker {
            Traversal::Breadth(bfs) => bfs.next(graph),
            Traversal::Depth(dfs) => dfs.next(graph),
        };
        let Some(node) = next else { return SearchResult { path: None, expanded } };
        expanded.push(node);
        if is_end(node) {
            let mut path: Vec<_> = std::iter::successors(Some(node), |at| parents[at.index()]).collect();
            path.reverse();
            return SearchResult { path: Some(path), expanded };
        }
        for neighbor in graph.neighbors(node).filter(|&neighbor| neighbor != from) {
            let parent = &mut parents[neighbor.index()];
            match &walker {
                // The first predecessor put the node into the queue.
                Traversal::Breadth(_) => *parent = parent.or(Some(node)),
                // The last predecessor put the node on top of the stack.
                Traversal::Depth(dfs) if !dfs.discovered.is_visited(&neighbor) => *parent = Some(node),
                Traversal::Depth(_) => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Places in the plane and straight edges between them. Some places are goals.
    #[derive(Debug, Clone)]
    struct Case {
        places: Vec<[i16; 2]>,
        edges: Vec<[usize; 2]>,
        goals: Vec<usize>,
    }

    fn cases() -> impl Strategy<Value = Case> {
        (1usize..12).prop_flat_map(|n| {
            let places = proptest::collection::vec([-3i16..4, -3i16..4], n);
            let edges = proptest::collection::vec([0..n, 0..n], 0..3 * n);
            (places, edges, proptest::collection::vec(0..n, 0..4)).prop_map(|(places, edges, goals)| Case {
                places,
                edges,
                goals,
            })
        })
    }

    impl Case {
        fn distance(&self, a: usize, b: usize) -> f64 {
            let [p, q] = [a, b].map(|k| self.places[k].map(f64::from));
            (p[0] - q[0]).hypot(p[1] - q[1])
        }

        fn searched(&self, how: RoadmapSearch) -> SearchResult {
            let mut graph = UnGraph::new_undirected();
            let _: Vec<NodeIndex> = self.places.iter().map(|_| graph.add_node(())).collect();
            for &[a, b] in &self.edges {
                graph.add_edge(NodeIndex::new(a), NodeIndex::new(b), self.distance(a, b));
            }
            let question = SearchProblem {
                start: NodeIndex::new(0),
                is_goal: |node: NodeIndex| self.goals.contains(&node.index()),
                cost: |length: &f64| *length,
                ahead: |node: NodeIndex| {
                    self.goals.iter().map(|&goal| self.distance(node.index(), goal)).fold(f64::INFINITY, f64::min)
                },
                behind: |node: NodeIndex| self.distance(0, node.index()),
            };
            search(&graph, how, &question)
        }

        /// Returns, for each pair of places, the least sum of `of` over the edges of a route, by the algorithm of Floyd
        /// and Warshall.
        fn least(&self, of: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
            let n = self.places.len();
            let mut least = vec![vec![f64::INFINITY; n]; n];
            (0..n).for_each(|k| least[k][k] = 0.0);
            for &[a, b] in &self.edges {
                least[a][b] = least[a][b].min(of(a, b));
                least[b][a] = least[a][b];
            }
            for via in 0..n {
                for a in 0..n {
                    for b in 0..n {
                        least[a][b] = least[a][b].min(least[a][via] + least[via][b]);
                    }
                }
            }
            least
        }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(512))]

        /// Tests that a route is found if and only if there is one. In both directions, the route follows edges, and
        /// has the length and the number of edges that its order promises. No node is expanded twice.
        #[test]
        fn each_order_finds_what_it_claims_in_both_directions(case in cases()) {
            let to_goal = |all: &[Vec<f64>]| case.goals.iter().map(|&goal| all[0][goal]).fold(f64::INFINITY, f64::min);
            let shortest = to_goal(&case.least(|a, b| case.distance(a, b)));
            let fewest = to_goal(&case.least(|_, _| 1.0));
            let ways = SearchOrder::ALL.into_iter().flat_map(|order| [false, true].map(|backward| (order, backward)));
            for (order, backward) in ways {
                let SearchResult { path, expanded } = case.searched(RoadmapSearch { order, backward });
                let mut once = expanded.clone();
                once.sort_unstable();
                once.dedup();
                prop_assert_eq!(once.len(), expanded.len());
                prop_assert_eq!(path.is_some(), shortest.is_finite(), "{:?} {}", order, backward);
                let Some(path) = path else { continue };
                prop_assert!(path[0].index() == 0 && case.goals.contains(&path[path.len() - 1].index()));
                let mut length = 0.0;
                for pair in path.windows(2) {
                    let [a, b] = [pair[0].index(), pair[1].index()];
                    prop_assert!(case.edges.iter().any(|&edge| edge == [a, b] || edge == [b, a]));
                    length += case.distance(a, b);
                }
                prop_assert!(length >= shortest - 1e-9);
                if order.is_optimal() {
                    prop_assert!((length - shortest).abs() < 1e-9, "{:?} {}: {} {}", order, backward, length, shortest);
                }
                if order == SearchOrder::BreadthFirst {
                    prop_assert_eq!(path.len() - 1, fewest as usize);
                }
            }
        }

        /// Tests that A\* and Dijkstra's algorithm expand no node whose cost (for A\* plus the estimate) exceeds the
        /// cost of the goal.
        #[test]
        fn nothing_beyond_the_goal_is_expanded(case in cases()) {
            let least = case.least(|a, b| case.distance(a, b));
            let nearest = case.goals.iter().map(|&goal| least[0][goal]).fold(f64::INFINITY, f64::min);
            for order in [SearchOrder::Dijkstra, SearchOrder::AStar] {
                for node in case.searched(RoadmapSearch { order, backward: false }).expanded {
                    let rest = case.goals.iter().map(|&goal| case.distance(node.index(), goal)).fold(f64::INFINITY, f64::min);
                    let estimate = if order == SearchOrder::AStar && nearest.is_finite() { rest } else { 0.0 };
                    prop_assert!(least[0][node.index()] + estimate <= nearest + 1e-9, "{:?}", order);
                }
            }
        }
    }

    #[test]
    fn each_search_order_agrees_with_the_textbook() {
        // The graph is a square with a tail; the goal is the tail's end.
        //   1 - 2
        //   |   |
        //   0 - 3 - 4
        let case = Case {
            places: vec![[0, 0], [0, 1], [1, 1], [1, 0], [2, 0]],
            edges: vec![[0, 1], [1, 2], [2, 3], [0, 3], [3, 4]],
            goals: vec![4],
        };
        let of = |order, backward| {
            case.searched(RoadmapSearch { order, backward }).expanded.iter().map(|n| n.index()).collect::<Vec<_>>()
        };
        assert_eq!(of(SearchOrder::Greedy, false), [0, 3, 4]);
        assert_eq!(of(SearchOrder::AStar, false), [0, 3, 4]);
        assert_eq!(of(SearchOrder::Greedy, true), [4, 3, 0]);
        // The neighbours of the start come before all other nodes.
        let mut breadth = of(SearchOrder::BreadthFirst, false);
        breadth[1..3].sort_unstable();
        assert_eq!(breadth[..3], [0, 1, 3]);
    }
}
