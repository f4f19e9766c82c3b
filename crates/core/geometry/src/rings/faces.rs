//! The faces of a graph of rings and diagonals that belong to the region.

use super::super::SimplePolygon;
use super::RingError;
use super::bridges::BridgedGraph;
use super::noding::counter_clockwise;

/// An edge seen from one of its vertices.
#[derive(Clone, Copy)]
struct End {
    /// The vertex at the other end.
    to: usize,
    /// True if the region is to the left of the edge, seen from the vertex. `right` states the same for the right side.
    left: bool,
    right: bool,
    /// The hole for which the edge was made as a diagonal; `None` for other edges.
    bridge: Option<usize>,
}

/// Returns each face of the region as a simple polygon.
///
/// # Errors
/// If the inside is ambiguous at a vertex, because rings cross there, or one lies on the wrong side of another.
pub(super) fn faces(graph: &BridgedGraph) -> Result<Vec<SimplePolygon>, RingError> {
    let points = &graph.noded.points;
    let around = ends(graph);
    for (vertex, ends) in around.iter().enumerate() {
        for (i, end) in ends.iter().enumerate() {
            let next = &ends[(i + 1) % ends.len()];
            if end.left != next.right {
                return Err(match end.bridge.or(next.bridge) {
                    Some(hole) if hole > 0 => RingError::Misplaced { hole },
                    _ => RingError::CrossesAt { at: points[vertex] },
                });
            }
        }
    }
    let mut walked: Vec<Vec<bool>> = around.iter().map(|ends| vec![false; ends.len()]).collect();
    let mut faces = Vec::new();
    for vertex in 0..around.len() {
        for first in 0..around[vertex].len() {
            if !around[vertex][first].left || walked[vertex][first] {
                continue;
            }
            let (mut at, mut leave) = (vertex, first);
            let mut corners = Vec::new();
            while !std::mem::replace(&mut walked[at][leave], true) {
                corners.push(points[at]);
                let to = around[at][leave].to;
                // The region lies between the edge just walked, seen from its end, and the next edge clockwise.
                let back = around[to].iter().position(|end| end.to == at).unwrap_or(0);
                leave = (back + around[to].len() - 1) % around[to].len();
                at = to;
            }
            faces.push(SimplePolygon::trusted(corners));
        }
    }
    Ok(faces)
}

/// Returns the edges of each vertex, counter-clockwise.
fn ends(graph: &BridgedGraph) -> Vec<Vec<End>> {
    let points = &graph.noded.points;
    let mut around: Vec<Vec<End>> = vec![Vec::new(); points.len()];
    for &[from, to] in &graph.noded.edges {
        around[from].push(End { to, left: true, right: false, bridge: None });
        around[to].push(End { to: from, left: false, right: true, bridge: None });
    }
    for bridge in &graph.bridges {
        let [a, b] = bridge.ends;
        for (from, to) in [(a, b), (b, a)] {
            around[from].push(End { to, left: true, right: true, bridge: Some(bridge.ring) });
        }
    }
    for (vertex, ends) in around.iter_mut().enumerate() {
        ends.sort_by(|a, b| counter_clockwise(points, vertex, a.to, b.to));
    }
    around
}
