//! Divides the line at nodes. While the joints move straight between neighbouring nodes, the tip stays near the line.

use cplan_deviation::{Kinematics, Line, Place, sag};
use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use cplan_model::space::Configuration;
use cplan_toolpath::Curve;
use std::f64::consts::FRAC_PI_2;

/// Greatest number of nodes. A line that needs more is too long for its tolerance.
pub(crate) const MAX_NODES: usize = 400_000;

/// Greatest number of halvings of a piece. Near singular places, joint values change like the root of the distance, so
/// parts must be about this short.
const MAX_HALVINGS: u32 = 44;

/// Number of parts into which a cubic curve is cut initially.
const CUBIC_PARTS: u32 = 4;

/// A place of the line, with its IK solutions.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub place: Place,
    /// Both IK solutions, which continue those of the previous node. `None` if the place is out of reach, or if a joint
    /// is free there.
    pub solutions: Option<[Configuration; 2]>,
    /// Distance between the tip in these solutions and the place, metres.
    pub off: f64,
    /// True if the solutions continue those of the previous node without jumps.
    pub is_continued: bool,
}

/// A part of the line between two nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part {
    pub piece: usize,
    /// The parameters of the piece at both ends.
    pub ends: [f64; 2],
}

/// The nodes of a line in order. Part `i` is between the nodes `i` and `i + 1`.
pub(crate) struct Nodes {
    pub nodes: Vec<Node>,
    pub parts: Vec<Part>,
}

/// Settings for the division of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Division {
    /// Greatest distance of the tip from the line while the joints move straight between two nodes, metres.
    pub deviation: f64,
    /// Distance from the reach up to which a place is replaced by the nearest place in reach, metres.
    pub slack: f64,
    /// Least number of parts of each piece.
    pub least_parts: u32,
    /// Greatest turn of the line's direction between two nodes of a piece, radians. Infinite if it does not matter.
    pub turn: f64,
    /// True if all parts of a cubic curve are as short as its strongest bend demands. Then a wrist turns evenly along
    /// it, and a smooth curve has evenly spaced points.
    pub is_even: bool,
}

impl Nodes {
    /// Divides a line. If `joints` is given, the motion begins, passes from piece to piece, and ends at these points,
    /// which may differ from the ends of the pieces. `None` if there are more than [`MAX_NODES`].
    pub fn new(kinematics: &Kinematics, line: &Line, joints: Option<&[Point]>, division: Division) -> Option<Self> {
        let mut divider = Divider { kinematics, line, joints, division, nodes: Vec::new(), parts: Vec::new() };
        for (piece, own) in line.pieces.iter().enumerate() {
            if piece == 0 {
                divider.push(0, 0.0);
            }
            let count = match own.curve {
                Curve::Line { .. } => 1,
                Curve::Arc { by, .. } => (by.abs() / FRAC_PI_2).ceil().max(1.0) as u32,
                Curve::Cubic(_) => CUBIC_PARTS,
            };
            let count = count.max(division.least_parts);
            let share = |k: u32| f64::from(k) / f64::from(count);
            (0..count).try_for_each(|k| divider.divide(piece, [share(k), share(k + 1)]))?;
        }
        Some(Self { nodes: divider.nodes, parts: divider.parts })
    }
}

struct Divider<'a, 'l> {
    kinematics: &'a Kinematics<'a>,
    line: &'a Line<'l>,
    joints: Option<&'a [Point]>,
    division: Division,
    nodes: Vec<Node>,
    parts: Vec<Part>,
}

impl Divider<'_, '_> {
    fn node(&self, piece: usize, u: f64) -> Node {
        let place = self.line.place(piece, u);
        let joint = self.joint(piece, u);
        let target = self.kinematics.reachable(joint.unwrap_or(place.point), self.division.slack);
        let solutions = target.and_then(|target| self.kinematics.solutions(target));
        // Where two pieces join, the end of the first and the beginning of the second may differ.
        let next = if joint.is_some() { piece + usize::from(u > 0.0) } else { piece };
        let other = self.line.pieces.get(next).filter(|_| next > piece).map_or(place.point, |p| p.curve.start().into());
        let far = |q: &Configuration| {
            let tip = self.kinematics.arm.tip_at(*q);
            (tip - place.point).norm().max((tip - other).norm())
        };
        let off = solutions.iter().flatten().map(far).fold(0.0, f64::max);
        Node { place, solutions, off, is_continued: false }
    }

    /// Returns the point where the motion passes an end of a piece.
    fn joint(&self, piece: usize, u: f64) -> Option<Point> {
        let joint = match u {
            0.0 => piece,
            1.0 => piece + 1,
            _ => return None,
        };
        Some(self.joints?[joint])
    }

    fn push(&mut self, piece: usize, u: f64) {
        let node = self.node(piece, u);
        self.nodes.push(node);
    }

    /// Appends the nodes of a part of a piece. The last node is at the beginning of the part.
    fn divide(&mut self, piece: usize, [from, to]: [f64; 2]) -> Option<()> {
        let mut open = vec![(self.node(piece, to), 0_u32)];
        let mut from = from;
        while let Some((mut next, halvings)) = open.pop() {
            checkpoint();
            let last = self.nodes.last().expect("the line's first node");
            let to = next.place.u;
            let Some((solutions, deviation)) = self.continued(last, &next, piece, [from, to]) else {
                // An end of the part is out of reach, or a joint is free there. The part is not divided: nodes out of
                // reach suffice for a proof.
                self.accept(next, piece, [from, to])?;
                from = to;
                continue;
            };
            let middle = from + (to - from) / 2.0;
            let is_fine = deviation <= self.division.deviation && self.turns_little(piece, [from, to]);
            if is_fine || halvings >= MAX_HALVINGS || middle <= from || middle >= to {
                (next.solutions, next.is_continued) = (Some(solutions), true);
                self.accept(next, piece, [from, to])?;
                from = to;
            } else {
                let half = self.node(piece, middle);
                open.push((next, halvings + 1));
                open.push((half, halvings + 1));
            }
        }
        Some(())
    }

    fn turns_little(&self, piece: usize, ends: [f64; 2]) -> bool {
        self.division.turn.is_infinite()
            || self.line.curve(piece).headings(ends).is_none_or(|headings| 2.0 * headings.half <= self.division.turn)
    }

    fn accept(&mut self, node: Node, piece: usize, ends: [f64; 2]) -> Option<()> {
        if self.nodes.len() >= MAX_NODES {
            return None;
        }
        self.nodes.push(node);
        self.parts.push(Part { piece, ends });
        Some(())
    }

    /// Returns the solutions of `next` that continue those of `last`. Also returns a bound on the distance of the tip
    /// from the line on the straight motions to them, the greater one of both.
    fn continued(&self, last: &Node, next: &Node, piece: usize, ends: [f64; 2]) -> Option<([Configuration; 2], f64)> {
        let (before, after) = (last.solutions?, next.solutions?);
        let lifted = [0, 1].map(|s| self.kinematics.near(after[s], before[s]));
        let off = last.off.max(next.off);
        let curve = self.line.curve(piece);
        let part = ends[1] - ends[0];
        let sag = if self.division.is_even { curve.bend() * part * part / 8.0 } else { sag(curve, ends) };
        let deviation = |s: usize| off + sag + chord_deviation(self.kinematics, before[s], lifted[s]);
        Some((lifted, deviation(0).max(deviation(1))))
    }
}

/// Bounds the distance between the tip on a straight motion in joint space and the point at the same share of the
/// straight line between both positions of the tip.
pub(crate) fn chord_deviation(kinematics: &Kinematics, from: Configuration, to: Configuration) -> f64 {
    let d = to - from;
    kinematics.bend((from + to) / 2.0, d / 2.0, d, d) / 8.0
}

/// Returns the chord of a part as points of the plane.
pub(crate) fn chord(line: &Line, part: &Part) -> [Point; 2] {
    part.ends.map(|u| line.curve(part.piece).at(u).into())
}
