//! Shortest paths through triangulated free space.
//!
//! This search does not use petgraph, which requires all edges of a node at once. Here, the open list also holds sets
//! of edges that are not known yet.

use super::NO_ENTRY;
use super::mesh::{Bound, Cone, ConeContinuation, Crossing, Mesh, Tangency};
use super::terminals::Terminals;
use cplan_geometry::{OpenList, Orientation, Point, cross, orientation};
use cplan_interrupt::checkpoint;
use cplan_model::space::{Measure, Segment};
use std::cmp::Reverse;

/// Sine of the angle between a ray and an edge below which they are not intersected. The inverse of the sine would
/// multiply rounding errors.
const PARALLEL_SINE: f64 = 1e-6;

/// A* over the reduced visibility graph, whose edges are found only when they are needed.
///
/// The open list holds reached nodes and *cones*. A cone is the view from a node through an edge of the triangulation.
/// Its estimate is a lower bound on the length of paths through it. So the most promising edges of a node are found
/// first, and most edges are never found. This is the search of Polyanya (Cui, Harabor, Grastien 2017) with two
/// changes. Cones are bounded by lines through vertices instead of rounded points, so visibility is exact. Turns are
/// separate nodes. The search is correct for any norm, because a taut path is never longer.
pub(super) struct Polyanya<'a> {
    mesh: &'a Mesh,
    measure: Measure,
    terminals: &'a Terminals,
    /// For each triangle, true if it contains a goal.
    has_goal: Vec<bool>,
    nodes: Vec<Node>,
    /// Least cost at which each corner has been reached so far.
    reached: Vec<f64>,
    open: OpenList<Open>,
    cones: Vec<(Cone, u32)>,
    /// Number of entries that have been put on the open list.
    pushed: u32,
    /// Both ends of each edge of the visibility graph found so far.
    pub arcs: Vec<[Point; 2]>,
}

/// A point on a path, with the previous node.
#[derive(Debug, Clone, Copy)]
struct Node {
    at: Point,
    cost: f64,
    parent: u32,
    /// Number of the corner; `NO_ENTRY` for the start and goals.
    corner: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Step {
    /// Look in all useful directions from a node.
    Turn(u32),
    /// Follow a cone, given by its index in [`Polyanya::cones`].
    Look(u32),
    /// End at a goal, given by its node.
    Arrive(u32),
}

/// An entry of the open list: a flag for an arrival, its sequence number, and the step. Of equal estimates, an arrival
/// comes first, and then the latest entry.
type Open = (Reverse<bool>, Reverse<u32>, Step);

impl<'a> Polyanya<'a> {
    pub fn new(mesh: &'a Mesh, measure: Measure, terminals: &'a Terminals) -> Self {
        let mut has_goal = vec![false; mesh.triangles()];
        terminals.parts.iter().for_each(|(triangle, _)| has_goal[*triangle as usize] = true);
        Self {
            mesh,
            measure,
            terminals,
            has_goal,
            nodes: Vec::new(),
            reached: vec![f64::INFINITY; mesh.corners().len()],
            open: OpenList::default(),
            cones: Vec::new(),
            pushed: 0,
            arcs: Vec::new(),
        }
    }

    /// Returns the number of visited nodes: the start, corners, and goals that were seen.
    pub fn nodes(&self) -> usize {
        let corners = self.reached.iter().filter(|cost| cost.is_finite()).count();
        corners + self.nodes.iter().filter(|node| node.corner == NO_ENTRY).count()
    }

    /// Returns the shortest path from the start to any goal; `None` if there is no path. No three consecutive
    /// waypoints are collinear.
    pub fn path(&mut self) -> Option<Vec<Point>> {
        let start = self.terminals.start;
        self.nodes.push(Node { at: start, cost: 0.0, parent: NO_ENTRY, corner: NO_ENTRY });
        let mesh = self.mesh;
        let mut seen = Vec::new();
        for triangle in mesh.triangles_at(start) {
            self.find_goals(0, triangle, |part| Some(*part));
            for successor in mesh.successors_within(triangle, start) {
                seen.extend(successor.seen.into_iter().flatten().filter_map(|half_edge| mesh.corner_at(half_edge)));
                self.push_cone(0, successor.cone, self.estimate(0, &successor.cone));
            }
        }
        // Triangles share corners, so remove duplicates.
        seen.sort_unstable();
        seen.dedup();
        seen.into_iter().for_each(|corner| self.add_visible_corner(0, corner));
        while let Some((_, (.., step))) = self.open.pop() {
            checkpoint();
            match step {
                Step::Arrive(node) => return Some(self.waypoints(node)),
                Step::Turn(node) => self.turn(node),
                Step::Look(cone) => {
                    let (cone, root) = self.cones[cone as usize];
                    self.follow(cone, root);
                }
            }
        }
        None
    }

    /// Returns true if a shorter path to the node's corner was found later.
    fn is_stale(&self, Node { corner, cost, .. }: Node) -> bool {
        corner != NO_ENTRY && self.reached[corner as usize] < cost
    }

    /// Adds the cones and corners that a path sees after a turn at a node.
    fn turn(&mut self, number: u32) {
        let node = self.nodes[number as usize];
        if self.is_stale(node) {
            return;
        }
        let mesh = self.mesh;
        let corner = &mesh.corners()[node.corner as usize];
        let Some(gaze) = corner.directions_after_turn(self.nodes[node.parent as usize].at) else { return };
        for successor in mesh.successors(corner, gaze) {
            self.find_goals(number, successor.cone.edge / 3, |part| Some(*part));
            let seen = successor.seen.into_iter().flatten().filter_map(|half_edge| mesh.corner_at(half_edge));
            seen.for_each(|corner| self.add_visible_corner(number, corner));
            self.push_cone(number, successor.cone, self.estimate(number, &successor.cone));
        }
    }

    /// Follows a cone from triangle to triangle while its estimate is the least on the open list.
    fn follow(&mut self, mut cone: Cone, root: u32) {
        let node = self.nodes[root as usize];
        if self.is_stale(node) {
            return;
        }
        while let Some(Crossing { entry, seen, beyond }) = self.mesh.cross(node.at, &cone) {
            self.find_goals(root, entry / 3, |part| cone.part(part));
            if let Some(corner) = seen.and_then(|half_edge| self.mesh.corner_at(half_edge)) {
                self.add_visible_corner(root, corner);
            }
            cone = match beyond {
                ConeContinuation::Through(edge) => Cone { edge, ..cone },
                ConeContinuation::One(only) => only,
                ConeContinuation::Two(right, left) => {
                    let estimates = [self.estimate(root, &right), self.estimate(root, &left)];
                    let (better, best, worse, other) = if estimates[0] <= estimates[1] {
                        (right, estimates[0], left, estimates[1])
                    } else {
                        (left, estimates[1], right, estimates[0])
                    };
                    self.push_cone(root, worse, other);
                    if self.open.peek().is_some_and(|(least, _)| least < best) {
                        self.push_cone(root, better, best);
                        return;
                    }
                    better
                }
            };
        }
    }

    /// Adds the edge from a node to a corner that it sees. If this path to the corner is the shortest so far, adds the
    /// corner as a node.
    fn add_visible_corner(&mut self, root: u32, number: u32) {
        let corner = &self.mesh.corners()[number as usize];
        let node = self.nodes[root as usize];
        if corner.tangency(node.at) == Tangency::None {
            return;
        }
        self.arcs.push([node.at, corner.at]);
        let cost = node.cost + self.measure.norm(corner.at - node.at);
        if cost < self.reached[number as usize] {
            self.reached[number as usize] = cost;
            let estimate = cost + self.terminals.distance(self.measure, corner.at);
            let next = self.push_node(Node { at: corner.at, cost, parent: root, corner: number });
            self.push(estimate, Step::Turn(next));
        }
    }

    /// Adds the goals in a triangle that the node sees, each at its nearest visible point.
    fn find_goals(&mut self, root: u32, triangle: u32, sees: impl Fn(&Segment) -> Option<Segment>) {
        if !self.has_goal[triangle as usize] {
            return;
        }
        let terminals = self.terminals;
        let Node { at: from, cost, .. } = self.nodes[root as usize];
        for (_, part) in terminals.parts_in(triangle) {
            if let Some(seen) = sees(part) {
                let at = seen.nearest(self.measure, from);
                self.arcs.push([from, at]);
                let cost = cost + self.measure.norm(at - from);
                let node = self.push_node(Node { at, cost, parent: root, corner: NO_ENTRY });
                self.push(cost, Step::Arrive(node));
            }
        }
    }

    fn push_node(&mut self, node: Node) -> u32 {
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// Returns a lower bound on the length of paths through a node and a cone; infinite at a wall.
    fn estimate(&self, root: u32, cone: &Cone) -> f64 {
        if self.mesh.is_wall(cone.edge) {
            return f64::INFINITY;
        }
        let Node { at, cost, .. } = self.nodes[root as usize];
        let line = self.mesh.ends(cone.edge);
        let ends = [meeting(cone.right, line, line[0]), meeting(cone.left, line, line[1])];
        let through = |goal: &Segment| self.measure.bound_through(at, ends, line, goal);
        cost + self.terminals.goals.iter().map(through).fold(f64::INFINITY, f64::min)
    }

    /// Puts a cone on the open list, unless its edge is a wall.
    fn push_cone(&mut self, root: u32, cone: Cone, estimate: f64) {
        if estimate.is_finite() {
            self.cones.push((cone, root));
            self.push(estimate, Step::Look(self.cones.len() as u32 - 1));
        }
    }

    fn push(&mut self, estimate: f64, step: Step) {
        self.pushed += 1;
        let is_arrival = matches!(step, Step::Arrive(_));
        self.open.push(estimate, (Reverse(is_arrival), Reverse(self.pushed), step));
    }

    fn waypoints(&self, last: u32) -> Vec<Point> {
        let mut reversed: Vec<Point> = Vec::new();
        let mut at = last;
        while at != NO_ENTRY {
            let Node { at: p, parent, .. } = self.nodes[at as usize];
            if let [.., a, b] = reversed[..]
                && orientation(a, b, p) == Orientation::Collinear
            {
                reversed.pop();
            }
            if reversed.last() != Some(&p) {
                reversed.push(p);
            }
            at = parent;
        }
        reversed.reverse();
        reversed
    }
}

/// Returns the point where a ray meets the segment from `a` to `b`. Returns `fallback` if the ray leads there, or if
/// ray and segment are nearly parallel.
fn meeting(Bound { from, to }: Bound, [a, b]: [Point; 2], fallback: Point) -> Point {
    let (line, edge) = (to - from, b - a);
    let sine = cross(line, edge);
    if to == fallback || sine * sine <= PARALLEL_SINE * PARALLEL_SINE * line.norm_squared() * edge.norm_squared() {
        return fallback;
    }
    let t = cross(line, from - a) / sine;
    a + edge * t.clamp(0.0, 1.0)
}
