//! The diagram as a roadmap, and the connection of queries to it.

use super::diagram::{Chord, Diagram};
use cplan_core::planner::mesh::Mesh;
use cplan_core::planner::roadmap::{Asked, Roadmap};
use cplan_core::planner::terminals::Terminals;
use cplan_core::space::{Measure, Metric};
use cplan_geometry::{Ordered, Point};
use cplan_interrupt::checkpoint;
use petgraph::graph::NodeIndex;
use std::collections::{BTreeMap, BTreeSet};

/// Ends of arcs that are nearer than this are one, radians or metres: where bisectors meet at a small angle, rounding moves
/// the place by the root of that of coordinates.
const SAME: f64 = 1e-7;

/// Chords nearer to the boundary than this are no ways: they lead into its corners, or through where obstacles touch.
pub(super) const NARROW: f64 = SAME;

/// Chords and nodes that are tried where a configuration is joined to the diagram.
const TRIED: usize = 12;

/// The chords in a window, as a graph.
#[derive(Debug, Clone)]
pub(super) struct Ways {
    roadmap: Roadmap,
    points: Vec<Point>,
    chords: Vec<([NodeIndex; 2], Chord)>,
}

impl Ways {
    /// Builds the roadmap of the chords that lie in free space.
    pub fn new(mesh: &Mesh, chords: impl Iterator<Item = Chord>) -> Self {
        let mut ways =
            Self { roadmap: Roadmap::new(Measure::from(Metric::Euclidean)), points: Vec::new(), chords: Vec::new() };
        let mut places: BTreeMap<[i64; 2], Vec<NodeIndex>> = BTreeMap::new();
        let mut known = BTreeSet::new();
        for chord in chords {
            checkpoint();
            let [a, b] = chord.ends.ends();
            if (a - b).norm() < SAME || !mesh.is_clear(a, b) {
                continue;
            }
            let ends = [a, b].map(|end| ways.node(&mut places, end));
            if ends[0] != ends[1] && known.insert([ends[0].min(ends[1]), ends[0].max(ends[1])]) {
                ways.roadmap.join_of_width(ends[0], ends[1], chord.width);
                ways.chords.push((ends, chord));
            }
        }
        ways
    }

    /// Returns the node at a place, up to rounding.
    fn node(&mut self, places: &mut BTreeMap<[i64; 2], Vec<NodeIndex>>, at: Point) -> NodeIndex {
        let cell = [at.x, at.y].map(|value| (value / SAME).floor() as i64);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [cell[0] + i, cell[1] + j]));
        let found = around.filter_map(|cell| places.get(&cell)).flatten();
        if let Some(node) = found.copied().find(|node| (self.points[node.index()] - at).norm() < SAME) {
            return node;
        }
        let node = self.roadmap.add(at);
        self.points.push(at);
        places.entry(cell).or_default().push(node);
        node
    }

    /// Returns the roadmap with a query's ends.
    pub fn asked(&self, mesh: &Mesh, diagram: &Diagram, terminals: &Terminals) -> Asked {
        let mut asked = self.roadmap.clone().asked(terminals.start);
        let start = asked.start;
        let mut ends = vec![start];
        ends.extend(terminals.places(mesh).map(|at| asked.goal(at)));
        ends.sort_unstable();
        ends.dedup();
        // Where each chord is met: how far along it, and the node there.
        let mut met: BTreeMap<usize, Vec<(Ordered, NodeIndex)>> = BTreeMap::new();
        for &end in &ends {
            checkpoint();
            // Without obstacles, or with start and goal in the same place, the end is already on the roadmap.
            let is_there = self.chords.is_empty() || (asked.at(end) - terminals.start).norm() < SAME;
            if end != start && is_there && mesh.is_clear(terminals.start, asked.at(end)) {
                asked.join(start, end);
            }
            self.retract(mesh, diagram, end, &mut asked, &mut met);
        }
        for (chord, mut nodes) in met {
            let [first, last] = self.chords[chord].0;
            nodes.extend([(Ordered(f64::NEG_INFINITY), first), (Ordered(f64::INFINITY), last)]);
            nodes.sort_unstable();
            for pair in nodes.windows(2) {
                let [a, b] = [pair[0].1, pair[1].1].map(|node| asked.at(node));
                if a == b || mesh.is_clear(a, b) {
                    asked.join_of_width(pair[0].1, pair[1].1, diagram.clearance(a, b));
                }
            }
        }
        asked
    }

    /// Joins an end to the diagram: to the chord that the line away from the boundary meets, or else to nearby nodes.
    fn retract(
        &self,
        mesh: &Mesh,
        diagram: &Diagram,
        end: NodeIndex,
        asked: &mut Asked,
        met: &mut BTreeMap<usize, Vec<(Ordered, NodeIndex)>>,
    ) {
        let at = asked.at(end);
        if let Some(there) = diagram.retracted(at).filter(|there| mesh.is_clear(at, *there)) {
            let measure = Measure::from(Metric::Euclidean);
            let distance = |k: usize| self.chords[k].1.ends.distance(measure, there);
            let is_met = |&k: &usize| self.chords[k].1.ends.ends().iter().any(|&p| mesh.is_clear(there, p));
            if let Some(chord) = nearest(self.chords.len(), distance).into_iter().find(is_met) {
                let (nodes, Chord { ends, .. }) = self.chords[chord];
                let is_it =
                    |node: &NodeIndex| (asked.at(*node) - there).norm() < SAME && mesh.is_clear(at, asked.at(*node));
                if let Some(node) = nodes.into_iter().find(is_it) {
                    return asked.join(end, node);
                }
                let node = asked.add(there);
                asked.join(end, node);
                let [from, to] = ends.ends();
                let along = (there - from).dot(&(to - from));
                return met.entry(chord).or_default().push((Ordered(along), node));
            }
        }
        for node in nearest(self.points.len(), |k| (self.points[k] - at).norm()) {
            if mesh.is_clear(at, self.points[node]) {
                asked.join_of_width(end, NodeIndex::new(node), diagram.clearance(at, self.points[node]));
            }
        }
    }
}

/// Returns the indices of the nearest of `count` things, nearest first.
fn nearest(count: usize, distance: impl Fn(usize) -> f64) -> Vec<usize> {
    let mut order: Vec<(Ordered, usize)> = (0..count).map(|k| (Ordered(distance(k)), k)).collect();
    if count > TRIED {
        order.select_nth_unstable(TRIED);
        order.truncate(TRIED);
    }
    order.sort_unstable();
    order.into_iter().map(|(_, k)| k).collect()
}
