//! Adds a cell to circles with an odd number of cells, because coarsening needs an even number.

use super::frame::{Ends, Frame};
use super::machine::Machine;
use super::stencil::{Line, Operator};

/// An operator with one more column or row at the seam of each circle of odd size. The new cells lie in the middle of the
/// couplings across the seam: two couplings `2 c` in series replace a coupling `c`, to which they are equivalent after the new
/// unknown is eliminated. (This is exact for five-point operators. Coarse levels also have diagonal couplings across the seam,
/// which are added to the straight couplings beside them. This affects only the preconditioner.)
pub(super) struct SeamlessOperator<'a, O> {
    operator: &'a O,
    fine: Frame,
    even: Frame,
    odd: [bool; 2],
    /// The row before the current one.
    before: Line,
    /// The last row, with its new column.
    last: Line,
    /// The diagonal of the first row, with its new column.
    first: Vec<f32>,
}

impl<'a, O: Operator> SeamlessOperator<'a, O> {
    pub fn new(operator: &'a O) -> Self {
        let fine = operator.frame();
        let odd = odd_circles(fine);
        let even = [fine.rows + usize::from(odd[0]), fine.columns + usize::from(odd[1])];
        let even = Frame::new(even, fine.ends).of_coefficients();
        let line = || Line::new(even.width + 2);
        Self { operator, fine, even, odd, before: line(), last: line(), first: line().diagonal }
    }

    /// Writes row `i` to `into`, including the entries at its ends.
    pub fn line<M: Machine>(&mut self, m: M, i: usize, into: &mut Line) {
        if !self.odd[0] {
            if i < self.fine.rows {
                self.columns(m, i, into);
            } else {
                into.parts().into_iter().for_each(|part| part.fill(0.0));
            }
            return;
        }
        let end = self.fine.rows - 1;
        let mut last = std::mem::take(&mut self.last);
        if i == 0 || i >= end {
            self.columns(m, 0, &mut last);
            self.first.copy_from_slice(&last.diagonal);
            self.columns(m, end, &mut last);
        }
        if i <= end {
            self.columns(m, i, into);
        } else {
            into.parts().into_iter().for_each(|part| part.fill(0.0));
        }
        if i == 0 || i >= end {
            for at in 1..=self.even.columns {
                let south = [last.south[at], last.south_east[at], last.south_west[at]];
                let north = [last.south[at], last.south_west[at + 1], last.south_east[at - 1]];
                let coupling = straight_coupling(south, north, [last.diagonal[at], self.first[at]]);
                let (south, north) = if coupling > 0.0 { (south, north) } else { ([0.0; 3], [0.0; 3]) };
                if i == 0 {
                    into.diagonal[at] += 2.0 * coupling - north.iter().sum::<f32>();
                }
                if i == end {
                    into.diagonal[at] += 2.0 * coupling - south.iter().sum::<f32>();
                    into.south_east[at] = 0.0;
                    into.south_west[at] = 0.0;
                }
                if i > end {
                    into.diagonal[at] = 4.0 * coupling;
                }
                if i >= end {
                    into.south[at] = 2.0 * coupling;
                }
            }
            into.parts().into_iter().for_each(|part| self.even.finish_ends(part));
        }
        self.last = last;
    }

    /// Writes row `i` of the operator to `into`, with the new column if there is one.
    fn columns<M: Machine>(&mut self, m: M, i: usize, into: &mut Line) {
        self.operator.line(m, i, into);
        if !self.odd[1] {
            return;
        }
        match i.checked_sub(1).or(if self.fine.ends[0] == Ends::Joined { Some(self.fine.rows - 1) } else { None }) {
            Some(above) => self.operator.line(m, above, &mut self.before),
            None => self.before.parts().into_iter().for_each(|part| part.fill(0.0)),
        }
        let end = self.fine.columns;
        let east = [into.east[end], self.before.south_west[1], into.south_east[end]];
        let west = [into.east[end], self.before.south_east[end], into.south_west[1]];
        let coupling = straight_coupling(east, west, [into.diagonal[end], into.diagonal[1]]);
        let (east, west) = if coupling > 0.0 { (east, west) } else { ([0.0; 3], [0.0; 3]) };
        into.diagonal[end] += 2.0 * coupling - east.iter().sum::<f32>();
        into.diagonal[1] += 2.0 * coupling - west.iter().sum::<f32>();
        into.diagonal[end + 1] = 4.0 * coupling;
        into.east[end] = 2.0 * coupling;
        into.east[end + 1] = 2.0 * coupling;
        into.south[end + 1] = 0.0;
        into.south_east[end] = 0.0;
        into.south_east[end + 1] = 0.0;
        into.south_west[1] = 0.0;
        into.south_west[end + 1] = 0.0;
        into.parts().into_iter().for_each(|part| self.even.finish_ends(part));
    }
}

/// Returns the straight coupling between two cells that replaces couplings across the seam: their own one, and half of each
/// diagonal one. The other half of a diagonal coupling belongs to another pair. The result is 0 if one of the cells is not an
/// unknown; the diagonal couplings of the other cell then stay in its diagonal coefficient.
fn straight_coupling(one: [f32; 3], other: [f32; 3], diagonals: [f32; 2]) -> f32 {
    if diagonals.iter().any(|&diagonal| diagonal <= 0.0) {
        return 0.0;
    }
    (one[0] + 0.5 * (one[1] + one[2] + other[1] + other[2])).max(0.0)
}

/// Returns, for each axis, true if it is a circle with an odd number of cells.
pub(super) fn odd_circles(frame: Frame) -> [bool; 2] {
    let odd = [frame.rows % 2 == 1, frame.columns % 2 == 1];
    [0, 1].map(|axis| odd[axis] && frame.ends[axis] == Ends::Joined)
}
