//! The points of a line that are nearest to a moving tip, in the order of the line.

use cplan_deviation::{Line, advance};
use cplan_toolpath::{Curve, Toolpath};

/// The point of the line that is nearest to the tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Index of the piece.
    pub piece: usize,
    /// The piece's parameter, from 0 to 1.
    pub u: f64,
    /// Distance of the tip from the line, metres: positive to the left, negative to the right.
    pub offset: f64,
}

/// Follows the point of a line that is nearest to a tip, while the tip moves along the line. This point never moves backwards.
pub struct Tracker<'a> {
    line: Line<'a>,
    tolerance: f64,
    /// The current point, and the end of the line.
    feet: [cplan_deviation::Foot; 2],
    last: [f64; 2],
}

impl<'a> Tracker<'a> {
    /// Begins at the start of a line. `tolerance` is the greatest distance between tip and line, metres.
    pub fn new(line: &'a Toolpath, tolerance: f64) -> Self {
        let end = cplan_deviation::Foot { piece: line.pieces().len() - 1, u: 1.0 };
        let feet = [cplan_deviation::Foot { piece: 0, u: 0.0 }, end];
        Self { line: Line::new(line), tolerance, feet, last: line.start() }
    }

    /// Advances to the next position of the tip. `O(1)` unless the tip passes whole pieces of the line.
    pub fn advance(&mut self, tip: [f64; 2]) -> Foot {
        let step = distance(tip, self.last);
        self.last = tip;
        let foot = advance(&self.line, self.tolerance, self.feet, tip.into(), step);
        self.feet[0] = foot;
        let curve = self.line.curve(foot.piece);
        Foot { piece: foot.piece, u: foot.u, offset: left(curve, foot.u, curve.at(foot.u), tip) }
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns the distance of `point` from `at`, the point of the curve at `u`: negative if `point` is to the right of the curve.
fn left(curve: &Curve, u: f64, at: [f64; 2], point: [f64; 2]) -> f64 {
    let along = match u {
        u if u <= 0.0 || u >= 1.0 => curve.direction(u).unwrap_or([1.0, 0.0]),
        u => curve.derivative(u),
    };
    let side = along[0] * (point[1] - at[1]) - along[1] * (point[0] - at[0]);
    distance(at, point).copysign(side)
}
