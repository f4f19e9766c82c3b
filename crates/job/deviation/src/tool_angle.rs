//! The proven difference between the angle of a tool and the one that is required along a line.
//!
//! [`Deviation::pairing`] pairs parts of the motion with parts of the line, in the order of both. The angle of the tool is a
//! polynomial in time, so its control points bound it on a part. The line's headings on its part are bounded, too
//! ([`cplan_toolpath::Curve::headings`]). So wherever tip and line are in their parts, the difference is at most the greatest one
//! between both ranges. A part whose bound is too large is halved. The result is valid between samples as well.
//!
//! At a sharp corner, the arm rests while the tool turns; before and after the line, it may also do so. The motion is divided at
//! these rests. A required angle that is fixed also applies during rests and travels, except before and after the line.

use crate::deviation::{Deviation, Foot};
use cplan_geometry::Point;
use cplan_handling::{Derivative, Piece, ToolAngle, WristGuide};
use cplan_toolpath::{Headings, wrapped};
use std::ops::Range;

/// Number of times that a part of the motion is halved before its bound is accepted.
const MAX_HALVINGS: u32 = 12;

/// Greatest speed, radians or metres per second, at which the arm counts as resting at a sample.
const REST_SPEED: f64 = 1e-9;

/// Allowance for rounding of angles, radians.
const ROUNDING: f64 = 1e-12;

/// A requirement on the angle of a tool along a line.
pub struct ToolDeviation<'a> {
    /// The line, the arm, and where the motion begins and ends on the line.
    pub deviation: Deviation<'a>,
    /// The required angle and its tolerance. Greater bounds are refined.
    pub guide: WristGuide,
}

/// A part of a piece of a motion, between two shares, with the part of a curve that it follows.
#[derive(Clone, Copy)]
struct Part {
    shares: [f64; 2],
    /// Index of the curve, and its parameters.
    curve: usize,
    ends: [f64; 2],
}

impl ToolDeviation<'_> {
    /// Returns an upper bound, radians, on the difference between the angle of the tool and the required one for each piece of a
    /// motion. `angles` has the angle of the tool as first components, in pieces with the same times. `O(n)` for `n` pieces; more
    /// if a bound exceeds the tolerance.
    pub fn of_pieces(&self, pieces: &[Piece], angles: &[Piece]) -> Vec<f64> {
        let offset = match self.guide.angle {
            ToolAngle::Fixed(angle) => {
                let bound = |piece: &Piece| {
                    let [middle, half] = bounds(piece, [0.0, 1.0]);
                    wrapped(middle - angle).abs() + half
                };
                let moving = moving(pieces);
                let of_piece = |(k, piece): (usize, &Piece)| if moving.contains(&k) { bound(piece) } else { 0.0 };
                return angles.iter().enumerate().map(of_piece).collect();
            }
            ToolAngle::Tangent(offset) => offset,
        };
        let mut greatest = vec![0.0_f64; pieces.len()];
        for (stretch, ends) in self.stretches(pieces) {
            self.on_stretch((pieces, angles), stretch, ends, offset, &mut greatest);
        }
        greatest
    }

    /// Raises the bounds on a range of pieces of the motion, which lead from one place on the line to another without a sharp
    /// corner in between.
    fn on_stretch(
        &self,
        (pieces, angles): (&[Piece], &[Piece]),
        stretch: Range<usize>,
        ends: [Foot; 2],
        offset: f64,
        greatest: &mut [f64],
    ) {
        let first = stretch.start;
        for pair in (Deviation { ends, ..self.deviation }).pairing(&pieces[stretch.clone()]).pairs.windows(2) {
            let [(begin, from), (end, to)] = [pair[0], pair[1]];
            let own = (begin as usize).min(stretch.len() - 1);
            let shares = [begin, end].map(|moment| (moment - own as f64).clamp(0.0, 1.0));
            let index = first + own;
            // After a corner, the next curve begins at its first end.
            let start = if from.piece == to.piece { from.u } else { 0.0 };
            let part = Part { shares, curve: to.piece, ends: [start, to.u] };
            let bound = self.of_part((&pieces[index], &angles[index]), part, offset, 0);
            greatest[index] = greatest[index].max(bound);
        }
    }

    /// Divides a motion at the sharp corners of the line where the arm rests. Returns the pieces of the motion between them, and
    /// the places where these begin and end on the line. A corner without a rest does not divide the motion.
    fn stretches(&self, pieces: &[Piece]) -> Vec<(Range<usize>, [Foot; 2])> {
        let [first, last] = self.deviation.ends;
        let Range { start, end } = moving(pieces);
        let (mut stretches, mut begin, mut from) = (Vec::new(), start, first);
        for corner in (first.piece + 1..=last.piece).filter(|corner| self.is_sharp(*corner)) {
            let at: Point = self.deviation.curve(corner).start().into();
            let rests = |k: &usize| {
                let speed = pieces[*k].derivative(Derivative::Velocity, 0.0);
                speed.amax() <= REST_SPEED
                    && (self.deviation.tip(&pieces[*k], 0.0) - at).norm() <= self.deviation.tolerance
            };
            let Some(arrival) = (begin + 1..end).find(rests) else { continue };
            let departure = arrival + (arrival..end).take_while(|k| is_still(&pieces[*k])).count();
            stretches.push((begin..arrival, [from, Foot { piece: corner - 1, u: 1.0 }]));
            (begin, from) = (departure, Foot { piece: corner, u: 0.0 });
        }
        if begin < end {
            stretches.push((begin..end, [from, last]));
        }
        stretches
    }

    fn of_part(&self, pieces: (&Piece, &Piece), part: Part, offset: f64, halvings: u32) -> f64 {
        let curve = self.deviation.curve(part.curve);
        if self.deviation.line.pieces[part.curve].is_travel {
            return 0.0;
        }
        let [middle, half] = bounds(pieces.1, part.shares);
        let off = |headings: Headings| wrapped(middle - headings.middle - offset).abs() + half + headings.half;
        let bound = curve.headings(part.ends).map_or(f64::INFINITY, off);
        let tolerance = self.guide.tolerance;
        if bound <= tolerance {
            return bound;
        }
        let at_ends = [0, 1].map(|k| {
            let [angle, _] = bounds(pieces.1, [part.shares[k]; 2]);
            curve.heading(part.ends[k]).map_or(0.0, |heading| wrapped(angle - heading - offset).abs())
        });
        let is_far = at_ends[0].min(at_ends[1]) > tolerance;
        if is_far || halvings >= MAX_HALVINGS {
            return bound;
        }
        let share = (part.shares[0] + part.shares[1]) / 2.0;
        let tip = self.deviation.tip(pieces.0, share);
        let foot = curve.nearest([tip.x, tip.y], part.ends[0]).min(part.ends[1]);
        let first = Part { shares: [part.shares[0], share], ends: [part.ends[0], foot], ..part };
        let second = Part { shares: [share, part.shares[1]], ends: [foot, part.ends[1]], ..part };
        let bound = self.of_part(pieces, first, offset, halvings + 1);
        bound.max(self.of_part(pieces, second, offset, halvings + 1))
    }

    /// Returns true if the beginning of a curve is a sharp corner: see [`is_sharp`].
    fn is_sharp(&self, curve: usize) -> bool {
        let heading = |curve: usize, u: f64| {
            let piece = &self.deviation.line.pieces[curve];
            if piece.is_travel { None } else { piece.curve.heading(u) }
        };
        is_sharp(heading(curve - 1, 1.0), heading(curve, 0.0), self.guide.tolerance)
    }
}

/// Returns true if the arm rests on a piece of a motion.
fn is_still(piece: &Piece) -> bool {
    piece.control().iter().all(|q| *q == piece.control()[0])
}

/// Returns the pieces of a motion without rests at its ends, during which the tool may turn.
fn moving(pieces: &[Piece]) -> Range<usize> {
    let start = pieces.iter().take_while(|piece| is_still(piece)).count();
    let end = pieces.iter().rposition(|piece| !is_still(piece)).map_or(start, |last| last + 1);
    start..end
}

/// Returns bounds on the first component of a piece between two shares, as their middle and half their difference.
fn bounds(piece: &Piece, shares: [f64; 2]) -> [f64; 2] {
    let [low, high] = if piece.to > piece.from {
        piece.bounds_of_sum(Derivative::Position, [1.0, 0.0], shares)
    } else {
        [piece.at(0.0)[0]; 2]
    };
    [(low + high) / 2.0, (high - low) / 2.0 + ROUNDING]
}

/// Returns true if the line's heading jumps at a corner by more than the tolerance of the tool's angle, or is unknown on one
/// side, as next to a travel. The arm rests there while the tool turns.
pub fn is_sharp(before: Option<f64>, after: Option<f64>, tolerance: f64) -> bool {
    !before.zip(after).is_some_and(|(before, after)| wrapped(after - before).abs() <= tolerance)
}
