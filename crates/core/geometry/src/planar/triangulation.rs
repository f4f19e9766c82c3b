//! Triangulation by a sweep.

use super::{Boundary, NO_ENTRY};
use crate::{Orientation, Point, orientation};
use cplan_interrupt::checkpoint;

/// Triangles as half-edges: triangle `t` has the half-edges `3 t`, `3 t + 1`, `3 t + 2`, counter-clockwise.
#[derive(Debug, Clone, Default)]
pub struct HalfEdges {
    /// The vertex at which each half-edge starts.
    pub origin: Vec<u32>,
    /// The other half of the same edge, in the triangle on its other side. `NO_ENTRY` on the boundary.
    pub twin: Vec<u32>,
}

/// Triangulates the inside of a boundary without new vertices. Every triangle is exactly counter-clockwise.
///
/// This is the sweep of Hertel and Mehlhorn (1983). To the left of the sweep line, the inside between two neighbouring
/// sides is triangulated up to a chain of vertices. The chain runs from the left end of the floor to that of the
/// ceiling, and no further triangle can be cut off. Each new vertex is joined to all vertices of the chain that it
/// sees. This takes `O(n)` after the sweep that built the boundary.
pub fn triangulate(boundary: &Boundary) -> HalfEdges {
    let mut sweep = Sweep {
        vertices: &boundary.vertices,
        links: Vec::with_capacity(2 * boundary.vertices.len()),
        pending: Vec::with_capacity(3 * boundary.vertices.len()),
        result: HalfEdges::default(),
    };
    sweep.result.origin.reserve(3 * boundary.vertices.len());
    sweep.result.twin.reserve(3 * boundary.vertices.len());
    // The unfinished region above each floor.
    let mut regions: Vec<Option<Region>> = vec![None; boundary.sides.len()];
    for v in 0..boundary.vertices.len() {
        checkpoint();
        sweep.pass(boundary, v, &mut regions);
    }
    sweep.result
}

/// A vertex of a chain.
#[derive(Debug, Clone, Copy)]
struct Link {
    vertex: u32,
    /// The neighbours in the chain.
    below: u32,
    above: u32,
    /// The edge to the link above, as an index into [`Sweep::pending`]. `NO_ENTRY` if that edge is a side.
    edge: u32,
}

/// A chain, given by the links at its two ends and at its rightmost vertex.
#[derive(Debug, Clone, Copy)]
struct Region {
    bottom: u32,
    top: u32,
    rightmost: u32,
}

struct Sweep<'a> {
    vertices: &'a [Point],
    links: Vec<Link>,
    /// For each inner edge, its first half-edge. `NO_ENTRY` if there is none yet.
    pending: Vec<u32>,
    result: HalfEdges,
}

impl Sweep<'_> {
    fn pass(&mut self, boundary: &Boundary, v: usize, regions: &mut [Option<Region>]) {
        let below = boundary.below(v);
        let is_floor = |side: &usize| boundary.sides[*side].is_floor();
        let (mut lower, mut upper) = (None, None);
        let mut under = below.filter(is_floor).and_then(|side| regions[side].take());
        let mut ending = boundary.ending(v).peekable();
        if ending.peek().is_none() {
            if let Some(region) = under {
                (lower, upper) = self.split(region, v as u32);
            }
        } else {
            lower = under.take();
            if let Some(region) = &mut lower {
                self.extend_top(region, v as u32);
            }
            while let Some(side) = ending.next() {
                let Some(mut region) = Some(side).filter(is_floor).and_then(|side| regions[side].take()) else {
                    continue;
                };
                self.extend_bottom(&mut region, v as u32);
                if ending.peek().is_none() {
                    upper = Some(region);
                }
            }
        }
        let beginning = boundary.beginning(v);
        if beginning.is_empty() {
            if let (Some(below), Some(lower), Some(upper)) = (below, lower, upper) {
                regions[below] = Some(self.merge(lower, upper));
            }
            return;
        }
        if let Some(below) = below {
            regions[below] = lower;
        }
        let highest = beginning.end - 1;
        for side in beginning.filter(|&side| side < highest && is_floor(&side)) {
            regions[side] = Some(self.begin(v as u32));
        }
        if is_floor(&highest) {
            regions[highest] = upper;
        }
    }

    fn link(&mut self, link: Link) -> u32 {
        self.links.push(link);
        self.links.len() as u32 - 1
    }

    /// Starts a region between two sides that start at `v`.
    fn begin(&mut self, v: u32) -> Region {
        let link = self.link(Link { vertex: v, below: NO_ENTRY, above: NO_ENTRY, edge: NO_ENTRY });
        Region { bottom: link, top: link, rightmost: link }
    }

    /// Joins `v` to the chain from below, where the floor ends.
    fn extend_bottom(&mut self, region: &mut Region, v: u32) {
        let link = self.link(Link { vertex: v, below: NO_ENTRY, above: region.bottom, edge: NO_ENTRY });
        self.links[region.bottom as usize].below = link;
        (region.bottom, region.rightmost) = (link, link);
        self.cut_upwards(region);
    }

    /// Joins `v` to the chain from above, where the ceiling ends.
    fn extend_top(&mut self, region: &mut Region, v: u32) {
        let link = self.link(Link { vertex: v, below: region.top, above: NO_ENTRY, edge: NO_ENTRY });
        self.links[region.top as usize].above = link;
        (region.top, region.rightmost) = (link, link);
        self.cut_downwards(region);
    }

    /// Splits a region at a vertex where sides start inside it. Returns the regions below and above these sides.
    fn split(&mut self, region: Region, v: u32) -> (Option<Region>, Option<Region>) {
        // The segment from the vertex to the rightmost vertex of the chain crosses nothing.
        let middle = region.rightmost;
        let edge = self.edge(NO_ENTRY);
        let copy = self.link(Link { below: NO_ENTRY, ..self.links[middle as usize] });
        let low = self.link(Link { vertex: v, below: middle, above: NO_ENTRY, edge: NO_ENTRY });
        let high = self.link(Link { vertex: v, below: NO_ENTRY, above: copy, edge });
        self.links[copy as usize].below = high;
        let above = self.links[middle as usize].above;
        if let Some(above) = self.links.get_mut(above as usize) {
            above.below = copy;
        }
        self.links[middle as usize] = Link { above: low, edge, ..self.links[middle as usize] };
        let top = if region.top == middle { copy } else { region.top };
        let lower = Region { bottom: region.bottom, top: low, rightmost: low };
        let upper = Region { bottom: high, top, rightmost: high };
        self.cut_downwards(&lower);
        self.cut_upwards(&upper);
        (Some(lower), Some(upper))
    }

    /// Merges two regions that end at one vertex, the top of the lower one and the bottom of the upper one.
    fn merge(&mut self, lower: Region, upper: Region) -> Region {
        let Link { above, edge, .. } = self.links[upper.bottom as usize];
        self.links[lower.top as usize] = Link { above, edge, ..self.links[lower.top as usize] };
        if let Some(above) = self.links.get_mut(above as usize) {
            above.below = lower.top;
        }
        Region { bottom: lower.bottom, top: upper.top, rightmost: lower.top }
    }

    /// Cuts off the triangles that the bottom of a chain sees.
    fn cut_upwards(&mut self, region: &Region) {
        let bottom = region.bottom as usize;
        loop {
            let near = self.links[bottom].above;
            let Some(far) = self.links.get(near as usize).map(|near| near.above).filter(|&far| far != NO_ENTRY) else {
                break;
            };
            let [v, a, b] = [self.links[bottom], self.links[near as usize], self.links[far as usize]];
            if !self.is_open(v.vertex, a.vertex, b.vertex) {
                break;
            }
            let edge = self.triangle([v.vertex, b.vertex, a.vertex], a.edge, v.edge);
            self.links[bottom] = Link { above: far, edge, ..v };
            self.links[far as usize].below = region.bottom;
        }
    }

    /// Cuts off the triangles that the top of a chain sees.
    fn cut_downwards(&mut self, region: &Region) {
        let top = region.top as usize;
        loop {
            let near = self.links[top].below;
            let Some(far) = self.links.get(near as usize).map(|near| near.below).filter(|&far| far != NO_ENTRY) else {
                break;
            };
            let [v, a, b] = [self.links[top], self.links[near as usize], self.links[far as usize]];
            if !self.is_open(b.vertex, a.vertex, v.vertex) {
                break;
            }
            let edge = self.triangle([b.vertex, v.vertex, a.vertex], a.edge, b.edge);
            self.links[top].below = far;
            self.links[far as usize] = Link { above: region.top, edge, ..b };
        }
    }

    /// Returns true if the inside lies in the angle at `b`. The vertices `a`, `b` and `c` are consecutive on a chain,
    /// from bottom to top.
    fn is_open(&self, a: u32, b: u32, c: u32) -> bool {
        let [a, b, c] = [a, b, c].map(|v| self.vertices[v as usize]);
        orientation(a, b, c) == Orientation::Clockwise
    }

    /// Makes a triangle from its corners, and from the edges after the second and the third corner. Returns the edge
    /// after the first.
    fn triangle(&mut self, corners: [u32; 3], second: u32, third: u32) -> u32 {
        let half_edge = self.result.origin.len() as u32;
        self.result.origin.extend(corners);
        self.result.twin.extend([NO_ENTRY; 3]);
        self.join(second, half_edge + 1);
        self.join(third, half_edge + 2);
        self.edge(half_edge)
    }

    /// Makes an inner edge. Only its first half-edge, `half`, exists so far.
    fn edge(&mut self, half: u32) -> u32 {
        self.pending.push(half);
        self.pending.len() as u32 - 1
    }

    /// Adds the second half-edge to an edge.
    fn join(&mut self, edge: u32, half: u32) {
        let Some(pending) = self.pending.get_mut(edge as usize) else { return };
        if *pending == NO_ENTRY {
            *pending = half;
        } else {
            self.result.twin[*pending as usize] = half;
            self.result.twin[half as usize] = *pending;
        }
    }
}
