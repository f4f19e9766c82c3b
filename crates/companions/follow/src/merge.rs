//! Merges those pieces of a line that are far shorter than the tolerance.
//!
//! A file may have pieces of a few nanometres: a hook before a travel, the rounding of a closed outline, micrometre
//! steps along a curve. A motion cannot follow their directions, and need not. Tiny pieces near one point are omitted,
//! which may leave a gap between the pieces before and after them. Longer sequences of tiny pieces become straight
//! chords. Only planning uses the merged pieces. The distance of the motion is judged against the line of the file.

use cplan_deviation::{Foot, Line, Place};
use cplan_geometry::{Point, cross};
use cplan_toolpath::{Curve, Piece, wrapped};

/// A line after the merging of tiny pieces.
pub(crate) struct Merged {
    /// The pieces for planning; at least one.
    pub pieces: Vec<Piece>,
    /// The points where the motion begins, where it passes from each piece to the next one, and where it ends.
    pub joints: Vec<Point>,
    /// For each joint, true if the tip stops there because a travel begins or ends.
    pub stops: Vec<bool>,
    /// For each merged piece, the range of pieces of the line that it replaces: the first one, and the one after the last.
    sources: Vec<[usize; 2]>,
}

/// Limits of merging.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Merging {
    /// Length up to which a piece is tiny, metres. Also the greatest distance between merged pieces and their replacement.
    pub size: f64,
    /// Greatest difference between the headings of a chord and of a piece that it replaces, radians. Infinite if
    /// headings do not matter.
    pub turn: f64,
}

impl Merged {
    /// Merges the tiny pieces of a line, in `O(n)` for `n` pieces.
    pub fn new(line: &Line, merging: Merging) -> Self {
        let own = line.pieces;
        let start: Point = own[0].curve.start().into();
        let mut merged = Self { pieces: Vec::new(), joints: vec![start], stops: vec![false], sources: Vec::new() };
        // The first piece that is not merged yet, and the first one that was omitted before it.
        let (mut next, mut omitted) = (0, 0);
        while next < own.len() {
            let from = merged.joints[merged.joints.len() - 1];
            if own[next].curve.length() > merging.size {
                merged.push(own, own[next], [omitted, next, next + 1]);
                next += 1;
                omitted = next;
            } else if is_near(&own[next].curve, from, merging.size) {
                next += 1;
            } else {
                let until = chord_end(own, next, from, merging);
                let curve = Curve::Line { from: from.into(), to: own[until - 1].curve.end() };
                merged.push(own, Piece { curve, ..own[next] }, [omitted, next, until]);
                next = until;
                omitted = next;
            }
        }
        let end: Point = own[own.len() - 1].curve.end().into();
        if merged.pieces.is_empty() {
            // The whole line is tiny.
            let curve = Curve::Line { from: start.into(), to: end.into() };
            merged.push(own, Piece { curve, ..own[0] }, [0, 0, own.len()]);
        }
        let last = merged.joints.len() - 1;
        merged.joints[last] = end;
        merged
    }

    /// Appends a piece that replaces the pieces of a line from `first` up to, but excluding `until`. The pieces from
    /// `omitted` to `first` are dropped.
    fn push(&mut self, own: &[Piece], piece: Piece, [omitted, first, until]: [usize; 3]) {
        let changes = |pair: &[Piece]| pair[0].is_travel != pair[1].is_travel;
        let rest = |pieces: &[Piece]| pieces.iter().filter_map(|piece| piece.dwell).reduce(|a, b| a + b);
        if let (Some(before), Some(seconds)) = (self.pieces.last_mut(), rest(&own[omitted..first])) {
            before.dwell = Some(before.dwell.unwrap_or(0.0) + seconds);
        }
        let piece = Piece { dwell: rest(&own[first..until]), ..piece };
        let joint = self.stops.len() - 1;
        self.stops[joint] = omitted > 0 && own[omitted - 1..=first].windows(2).any(changes);
        self.pieces.push(piece);
        self.joints.push(piece.curve.end().into());
        self.stops.push(false);
        self.sources.push([first, until]);
    }

    /// Converts a place on the merged pieces to the line of the file.
    pub fn foot(&self, Foot { piece, u }: Foot) -> Foot {
        let [first, until] = self.sources[piece];
        let position = u * (until - first) as f64;
        let within = (position as usize).min(until - first - 1);
        Foot { piece: first + within, u: (position - within as f64).clamp(0.0, 1.0) }
    }

    /// Converts a place on the merged pieces to the line of the file, with its point.
    pub fn place(&self, line: &Line, place: &Place) -> Place {
        let Foot { piece, u } = self.foot(Foot { piece: place.piece, u: place.u });
        line.place(piece, u)
    }
}

/// Returns true if a whole curve is at most `size` from a point.
fn is_near(curve: &Curve, point: Point, size: f64) -> bool {
    let far = [curve.start(), curve.end()].map(|end| (Point::from(end) - point).norm());
    far[0].max(far[1]) + curve.length() / 2.0 <= size
}

/// Returns the end of the longest sequence of tiny pieces, beginning with `first`, that one chord from a point
/// replaces. The sequence has at least one piece, which may be longer. Dwells occur only at its end.
fn chord_end(own: &[Piece], first: usize, from: Point, Merging { size, turn }: Merging) -> usize {
    let radius = size / 2.0;
    // Directions of chords from the point that stay near the pieces so far, relative to the first chord.
    let (mut middle, mut least, mut greatest) = (None, f64::NEG_INFINITY, f64::INFINITY);
    let (mut farthest, mut end) = (0.0_f64, first + 1);
    for (number, piece) in own.iter().enumerate().skip(first) {
        let is_alike = piece.is_travel == own[first].is_travel && piece.speed == own[first].speed;
        let rests = number > first && own[number - 1].dwell.is_some();
        if rests || number > first && (!is_alike || piece.is_travel || piece.curve.length() > size) {
            break;
        }
        let along: cplan_geometry::Vector = Point::from(piece.curve.end()) - from;
        let distance = along.norm();
        if distance < farthest - radius {
            break;
        }
        farthest = farthest.max(distance);
        if distance <= radius {
            continue;
        }
        let middle = *middle.get_or_insert(along / distance);
        let angle = cross(middle, along).atan2(middle.dot(&along));
        let half = (radius / distance).asin();
        let heading = piece.curve.heading(0.5).map(|heading| wrapped(heading - along.y.atan2(along.x)).abs());
        if number > first && (angle < least || angle > greatest || heading.is_some_and(|off| off > turn)) {
            break;
        }
        (least, greatest, end) = (least.max(angle - half), greatest.min(angle + half), number + 1);
    }
    end
}
