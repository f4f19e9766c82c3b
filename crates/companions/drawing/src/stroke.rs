//! The area of a line with a width, with butt ends and mitred corners.

use crate::curve::{CircularArc, TooFineCurve};
use crate::map::Map;
use crate::{Point, Ring};

/// A straight or curved segment whose width changes linearly.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    pub ends: [Point; 2],
    pub bulge: f64,
    pub widths: [f64; 2],
}

/// Greatest length of a mitre, in half widths. A longer mitre is cut off, as in SVG and PostScript.
const MAX_MITRE: f64 = 4.0;

/// Greatest gap between the edges of consecutive pieces without a corner, as a fraction of the width.
const SMOOTH_TOLERANCE: f64 = 1e-9;

impl Piece {
    /// Returns the left and the right edge of the piece.
    fn edges(&self, map: &Map, tolerance: f64) -> Result<[Vec<Point>; 2], TooFineCurve> {
        let [a, b] = self.ends;
        if let Some(bow) = CircularArc::new(a, b, self.bulge) {
            let [from, to] = self.widths.map(|width| width / 2.0);
            let inwards = bow.by.signum();
            let edge = |side: f64| bow.spiral(side * inwards * from, side * inwards * to, map, tolerance);
            return Ok([edge(-1.0)?, edge(1.0)?]);
        }
        let [left, _] = self.directions().map(|[x, y]| [-y, x]);
        let edge =
            |side: f64| [0, 1].map(|end| offset_point(self.ends[end], left, side * self.widths[end] / 2.0)).to_vec();
        Ok([edge(1.0), edge(-1.0)])
    }

    /// Returns the directions of the piece's middle line at both ends.
    fn directions(&self) -> [Point; 2] {
        let [a, b] = self.ends;
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let length = dx.hypot(dy);
        let along = [dx / length, dy / length];
        if CircularArc::new(a, b, self.bulge).is_none() {
            return [along; 2];
        }
        // At each end, the angle between an arc and its chord is half of the angle by which the arc turns.
        [-1.0, 1.0].map(|side| {
            let (sin, cos) = (side * 2.0 * self.bulge.atan()).sin_cos();
            [cos * along[0] - sin * along[1], sin * along[0] + cos * along[1]]
        })
    }
}

fn offset_point(p: Point, direction: Point, distance: f64) -> Point {
    [0, 1].map(|k| p[k] + direction[k] * distance)
}

/// Returns rings that cover the same area as the pieces. They are counter-clockwise after `map` is applied. Each piece
/// must start where the previous one ends, and must have a positive length and somewhere a positive width.
pub(crate) fn covering_rings(
    pieces: &[Piece],
    is_closed: bool,
    map: &Map,
    tolerance: f64,
) -> Result<Vec<Ring>, TooFineCurve> {
    let mut edges = pieces.iter().map(|piece| piece.edges(map, tolerance)).collect::<Result<Vec<_>, _>>()?;
    let closing = (is_closed && pieces.len() > 1).then_some((pieces.len() - 1, 0));
    let corners: Vec<(usize, usize)> = (1..pieces.len()).map(|j| (j - 1, j)).chain(closing).collect();
    for &(i, j) in &corners {
        for side in 0..2 {
            let (from, to) = (edges[i][side][edges[i][side].len() - 1], edges[j][side][0]);
            if (from[0] - to[0]).hypot(from[1] - to[1]) <= SMOOTH_TOLERANCE * pieces[i].widths[1] {
                edges[j][side][0] = from;
            }
        }
    }
    let mut rings = Vec::new();
    // The rings include the corners, so that neighbours share their borders exactly.
    for (piece, [left, right]) in pieces.iter().zip(&edges) {
        let [a, b] = piece.ends;
        let back: Vec<Point> = right.iter().rev().copied().collect();
        rings.push([&[a], &left[..], &[b], &back[..]].concat());
    }
    for (i, j) in corners {
        rings.extend(corner([&pieces[i], &pieces[j]], [&edges[i], &edges[j]]));
    }
    for ring in &mut rings {
        ring.iter_mut().for_each(|p| *p = map.point(*p));
        if doubled_area(ring) < 0.0 {
            ring.reverse();
        }
    }
    Ok(rings)
}

/// Returns twice the area that a ring encloses, positive if the ring is counter-clockwise.
fn doubled_area(ring: &[Point]) -> f64 {
    let from_first = |p: &Point| [p[0] - ring[0][0], p[1] - ring[0][1]];
    let cross = |w: &[Point]| {
        let [p, q] = [from_first(&w[0]), from_first(&w[1])];
        p[0] * q[1] - p[1] * q[0]
    };
    ring.windows(2).map(cross).sum()
}

/// Returns the area between two pieces on the outer side of their corner.
fn corner([before, after]: [&Piece; 2], [edges, next_edges]: [&[Vec<Point>; 2]; 2]) -> Option<Ring> {
    let ([_, d], [e, _]) = (before.directions(), after.directions());
    let (cross, cos) = (d[0] * e[1] - d[1] * e[0], d[0] * e[0] + d[1] * e[1]);
    let outer = usize::from(cross > 0.0);
    let (from, to) = (*edges[outer].last()?, next_edges[outer][0]);
    if from == to {
        return None;
    }
    let [width, next_width] = [before.widths[1], after.widths[0]];
    let at = after.ends[0];
    let mut ring = vec![at, from];
    // The length of a mitre is half of the width divided by the cosine of half of the turn.
    let half_turn = ((1.0 + cos) / 2.0).max(0.0).sqrt();
    if width == next_width && half_turn * MAX_MITRE >= 1.0 {
        let toward = [0, 1].map(|k| (from[k] - at[k] + to[k] - at[k]) / (2.0 * half_turn * half_turn));
        ring.push([0, 1].map(|k| at[k] + toward[k]));
    }
    ring.push(to);
    Some(ring)
}
