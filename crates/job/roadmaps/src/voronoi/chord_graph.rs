//! The diagram as a roadmap, and the connection of queries to it.

use super::diagram::{Chord, Diagram};
use cplan_geometry::{OrderedF64, Point};
use cplan_interrupt::checkpoint;
use cplan_model::space::{Measure, Metric};
use cplan_planners::planner::mesh::Mesh;
use cplan_planners::planner::roadmap::{QueryGraph, Roadmap};
use cplan_planners::planner::terminals::Terminals;
use petgraph::graph::NodeIndex;
use std::collections::{BTreeMap, BTreeSet};

/// Ends of arcs closer than this become one node, radians or metres. Where bisectors meet at a small angle, the error of their
/// intersection is the square root of the rounding error of coordinates.
const JOIN_DISTANCE: f64 = 1e-7;

/// Chords closer than this to the boundary are not used, radians or metres. They lead into corners of the boundary, or between
/// obstacles that touch.
pub(super) const MIN_CHORD_CLEARANCE: f64 = JOIN_DISTANCE;

/// Number of nearest chords, and of nearest nodes, to which a configuration may be joined.
const MAX_TRIED_CONNECTIONS: usize = 12;

/// The chords in a window as a graph.
#[derive(Debug, Clone)]
pub(super) struct ChordGraph {
    roadmap: Roadmap,
    points: Vec<Point>,
    chords: Vec<([NodeIndex; 2], Chord)>,
}

impl ChordGraph {
    /// Builds the roadmap of the chords that lie in free space.
    pub fn new(mesh: &Mesh, chords: impl Iterator<Item = Chord>) -> Self {
        let mut graph =
            Self { roadmap: Roadmap::new(Measure::from(Metric::Euclidean)), points: Vec::new(), chords: Vec::new() };
        let mut places: BTreeMap<[i64; 2], Vec<NodeIndex>> = BTreeMap::new();
        let mut known = BTreeSet::new();
        for chord in chords {
            checkpoint();
            let [a, b] = chord.ends.ends();
            if (a - b).norm() < JOIN_DISTANCE || !mesh.is_clear(a, b) {
                continue;
            }
            let ends = [a, b].map(|end| graph.node(&mut places, end));
            if ends[0] != ends[1] && known.insert([ends[0].min(ends[1]), ends[0].max(ends[1])]) {
                graph.roadmap.join_of_width(ends[0], ends[1], chord.width);
                graph.chords.push((ends, chord));
            }
        }
        graph
    }

    /// Returns the node at a point, up to [`JOIN_DISTANCE`], and adds it if necessary.
    fn node(&mut self, places: &mut BTreeMap<[i64; 2], Vec<NodeIndex>>, at: Point) -> NodeIndex {
        let cell = [at.x, at.y].map(|value| (value / JOIN_DISTANCE).floor() as i64);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [cell[0] + i, cell[1] + j]));
        let found = around.filter_map(|cell| places.get(&cell)).flatten();
        if let Some(node) = found.copied().find(|node| (self.points[node.index()] - at).norm() < JOIN_DISTANCE) {
            return node;
        }
        let node = self.roadmap.add(at);
        self.points.push(at);
        places.entry(cell).or_default().push(node);
        node
    }

    /// Returns the roadmap with the start and the goals of a query.
    pub fn query_graph(&self, mesh: &Mesh, diagram: &Diagram, terminals: &Terminals) -> QueryGraph {
        let mut query_graph = self.roadmap.clone().query_graph(terminals.start);
        let start = query_graph.start;
        let mut ends = vec![start];
        ends.extend(terminals.places(mesh).map(|at| query_graph.goal(at)));
        ends.sort_unstable();
        ends.dedup();
        // For each chord to which an end is joined, positions along the chord and the nodes there.
        let mut met: BTreeMap<usize, Vec<(OrderedF64, NodeIndex)>> = BTreeMap::new();
        for &end in &ends {
            checkpoint();
            // Without obstacles, or if start and goal coincide, both can be joined directly.
            let is_there = self.chords.is_empty() || (query_graph.at(end) - terminals.start).norm() < JOIN_DISTANCE;
            if end != start && is_there && mesh.is_clear(terminals.start, query_graph.at(end)) {
                query_graph.join(start, end);
            }
            self.retract(mesh, diagram, end, &mut query_graph, &mut met);
        }
        for (chord, mut nodes) in met {
            let [first, last] = self.chords[chord].0;
            nodes.extend([(OrderedF64(f64::NEG_INFINITY), first), (OrderedF64(f64::INFINITY), last)]);
            nodes.sort_unstable();
            for pair in nodes.windows(2) {
                let [a, b] = [pair[0].1, pair[1].1].map(|node| query_graph.at(node));
                if a == b || mesh.is_clear(a, b) {
                    query_graph.join_of_width(pair[0].1, pair[1].1, diagram.clearance(a, b));
                }
            }
        }
        query_graph
    }

    /// Joins an end to the chord that the line away from the boundary meets; otherwise to nearby nodes.
    fn retract(
        &self,
        mesh: &Mesh,
        diagram: &Diagram,
        end: NodeIndex,
        query_graph: &mut QueryGraph,
        met: &mut BTreeMap<usize, Vec<(OrderedF64, NodeIndex)>>,
    ) {
        let at = query_graph.at(end);
        if let Some(there) = diagram.retracted(at).filter(|there| mesh.is_clear(at, *there)) {
            let measure = Measure::from(Metric::Euclidean);
            let distance = |k: usize| self.chords[k].1.ends.distance(measure, there);
            let is_met = |&k: &usize| self.chords[k].1.ends.ends().iter().any(|&p| mesh.is_clear(there, p));
            if let Some(chord) = nearest(self.chords.len(), distance).into_iter().find(is_met) {
                let (nodes, Chord { ends, .. }) = self.chords[chord];
                let is_it = |node: &NodeIndex| {
                    (query_graph.at(*node) - there).norm() < JOIN_DISTANCE && mesh.is_clear(at, query_graph.at(*node))
                };
                if let Some(node) = nodes.into_iter().find(is_it) {
                    return query_graph.join(end, node);
                }
                let node = query_graph.add(there);
                query_graph.join(end, node);
                let [from, to] = ends.ends();
                let along = (there - from).dot(&(to - from));
                return met.entry(chord).or_default().push((OrderedF64(along), node));
            }
        }
        for node in nearest(self.points.len(), |k| (self.points[k] - at).norm()) {
            if mesh.is_clear(at, self.points[node]) {
                query_graph.join_of_width(end, NodeIndex::new(node), diagram.clearance(at, self.points[node]));
            }
        }
    }
}

/// Returns the indices of the nearest of `count` items, nearest first, at most [`MAX_TRIED_CONNECTIONS`].
fn nearest(count: usize, distance: impl Fn(usize) -> f64) -> Vec<usize> {
    let mut order: Vec<(OrderedF64, usize)> = (0..count).map(|k| (OrderedF64(distance(k)), k)).collect();
    if count > MAX_TRIED_CONNECTIONS {
        order.select_nth_unstable(MAX_TRIED_CONNECTIONS);
        order.truncate(MAX_TRIED_CONNECTIONS);
    }
    order.sort_unstable();
    order.into_iter().map(|(_, k)| k).collect()
}
