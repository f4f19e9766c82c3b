//! The full visibility graph, with an edge between any two corners that see each other.

use super::VisibilityMap;
use crate::planner::mesh::{Cone, Mesh};
use crate::planner::roadmap::{QueryGraph, Roadmap};
use crate::planner::terminals::Terminals;
use cplan_geometry::{Orientation, Point};
use cplan_interrupt::checkpoint;
use cplan_model::space::{Measure, Segment};
use petgraph::graph::NodeIndex;

/// Greatest number of corners of free space for which the full graph is built. With `n` corners it may have
/// `n^2 / 2` edges.
const MAX_VERTICES: usize = 1500;

impl VisibilityMap {
    /// Returns the graph of the start, the goals and all corners of C-obstacles, which are cut off at joint limits. Two
    /// nodes are joined if the segment between them is a side of free space, or if it lies in free space and touches no
    /// corner between its ends (Latombe, *Robot Motion Planning*, 1991, section 4.1).
    ///
    /// A corner where two joint limits meet is no corner of a C-obstacle, so it is no node.
    ///
    /// Exact; linear in the number of triangles that lines of sight cross.
    ///
    /// # Errors
    /// If free space has more than [`MAX_VERTICES`] corners.
    pub(super) fn full(&self, measure: Measure, terminals: &Terminals) -> Result<QueryGraph, String> {
        let mesh = &self.mesh;
        let vertices = mesh.vertices();
        if vertices.len() > MAX_VERTICES {
            let count = vertices.len();
            return Err(format!(
                "the full visibility graph can have at most {MAX_VERTICES} corners, but free space has {count}; use \
                 --graph reduced, or a greater --margin"
            ));
        }
        let mut roadmap = Roadmap::new(measure);
        let is_limit = |at: &Point| (0..2).all(|k| [self.window[k].0, self.window[k].1].contains(&at[k]));
        let nodes: Vec<Option<NodeIndex>> =
            vertices.iter().map(|at| (!is_limit(at)).then(|| roadmap.add(*at))).collect();
        let mut query_graph = roadmap.query_graph(terminals.start);
        let start = query_graph.start;
        for (&root, node) in vertices.iter().zip(&nodes).chain([(&terminals.start, &Some(start))]) {
            checkpoint();
            let Some(node) = node else { continue };
            let sight = CornerView { mesh, terminals, root };
            let (mut seen, mut goals) = (Vec::new(), Vec::new());
            sight.collect_visible(&mut seen, &mut goals);
            // Each edge is found from both ends. Add it once.
            let joined = seen.into_iter().filter_map(|vertex| nodes[vertex as usize]).filter(|other| other < node);
            joined.for_each(|other| query_graph.join(*node, other));
            for part in goals {
                let goal = query_graph.goal(part.nearest(measure, root));
                query_graph.join(*node, goal);
            }
        }
        Ok(query_graph)
    }
}

/// The view from a corner or from the start.
struct CornerView<'a> {
    mesh: &'a Mesh,
    terminals: &'a Terminals,
    root: Point,
}

impl CornerView<'_> {
    /// Appends the numbers of the visible vertices to `seen`, and the visible parts of goals to `goals`.
    fn collect_visible(&self, seen: &mut Vec<u32>, goals: &mut Vec<Segment>) {
        let Self { mesh, terminals, root } = *self;
        for triangle in mesh.triangles_at(root) {
            goals.extend(terminals.parts_in(triangle).map(|(_, part)| *part));
            for successor in mesh.successors_within(triangle, root) {
                seen.extend(successor.seen.into_iter().flatten().map(|half_edge| mesh.vertex(half_edge)));
                mesh.visit_visible_triangles(root, successor.cone, |crossing, cone| {
                    let ahead = crossing.seen.filter(|&half_edge| is_within(cone, mesh.origin(half_edge)));
                    seen.extend(ahead.map(|half_edge| mesh.vertex(half_edge)));
                    let parts = terminals.parts_in(crossing.entry / 3).filter_map(|(_, part)| cone.part(part));
                    goals.extend(parts.filter(|part| !part.is_point() || sees(cone, part.ends()[0])));
                });
            }
        }
        seen.retain(|&vertex| mesh.vertices()[vertex as usize] != root);
        seen.sort_unstable();
        seen.dedup();
    }
}

/// Returns true if a point lies strictly between the bounds of a cone. Between the root and a point on a bound, the
/// line of sight touches a corner.
fn is_within(cone: &Cone, p: Point) -> bool {
    cone.right.side(p) == Orientation::CounterClockwise && cone.left.side(p) == Orientation::Clockwise
}

/// Returns true if a point is strictly within the cone, or is the corner on one of its bounds.
fn sees(cone: &Cone, p: Point) -> bool {
    is_within(cone, p) || [cone.right.to, cone.left.to].contains(&p)
}
