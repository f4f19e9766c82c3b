//! The places of a line that are nearest to a moving tip, in the order of the line.

use cplan_toolpath::{Curve, Toolpath};

/// Remaining length of a piece from which the next piece is considered, as a multiple of the tolerance. The tip cuts a
/// corner of a few degrees this far before it.
const LOOKAHEAD_TOLERANCES: f64 = 100.0;

/// Least distance by which the next piece must be nearer than the present one, as a share of the tolerance. Where the
/// line returns on itself, both are equally near up to the deviation of the tip.
const SWITCH_SHARE: f64 = 0.1;

/// The place of the line that is nearest to the tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Index of the piece.
    pub piece: usize,
    /// The piece's parameter, from 0 to 1.
    pub u: f64,
    /// Distance of the tip to the left of the line, metres; negative to the right.
    pub offset: f64,
}

/// Follows the nearest place of a line while the tip moves along it. It never returns.
#[derive(Debug, Clone)]
pub struct Tracker<'a> {
    line: &'a Toolpath,
    tolerance: f64,
    piece: usize,
    u: f64,
    last: [f64; 2],
}

impl<'a> Tracker<'a> {
    /// Begins at the start of a line. `tolerance` is the greatest distance of the tip from it, metres.
    #[must_use]
    pub fn new(line: &'a Toolpath, tolerance: f64) -> Self {
        Self { line, tolerance, piece: 0, u: 0.0, last: line.start() }
    }

    /// Advances to the next place of the tip. It takes `O(1)` if no piece is passed.
    pub fn advance(&mut self, tip: [f64; 2]) -> Foot {
        let step = distance(tip, self.last);
        self.last = tip;
        let lookahead = (LOOKAHEAD_TOLERANCES * self.tolerance).max(2.0 * step);
        self.u = self.curve().nearest(tip, self.u);
        while let Some(next) = self.line.pieces().get(self.piece + 1) {
            let own = self.curve();
            if own.length() - own.length_to(self.u) > lookahead {
                break;
            }
            let u = next.curve.nearest(tip, 0.0);
            let nearer = distance(own.at(self.u), tip) - distance(next.curve.at(u), tip);
            let is_past = self.u >= 1.0 && u > 0.0 && nearer >= 0.0;
            if !is_past && nearer <= SWITCH_SHARE * self.tolerance {
                break;
            }
            (self.piece, self.u) = (self.piece + 1, u);
        }
        let (at, curve) = (self.curve().at(self.u), self.curve());
        Foot { piece: self.piece, u: self.u, offset: left(curve, self.u, at, tip) }
    }

    fn curve(&self) -> &'a Curve {
        &self.line.pieces()[self.piece].curve
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns the distance of a point from the foot `at`, negative to the right of the curve.
fn left(curve: &Curve, u: f64, at: [f64; 2], point: [f64; 2]) -> f64 {
    let along = match u {
        u if u <= 0.0 || u >= 1.0 => curve.direction(u).unwrap_or([1.0, 0.0]),
        u => curve.derivative(u),
    };
    let side = along[0] * (point[1] - at[1]) - along[1] * (point[0] - at[0]);
    distance(at, point).copysign(side)
}
