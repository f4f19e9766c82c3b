//! The next coarser level: interpolation that follows the operator, and the operator seen through it.
//!
//! Coarse cells are the cells in even rows and columns (box multigrid: Dendy 1982). A cell between two coarse cells of a row gets
//! the value that balances the sums of couplings over its column; in a column, likewise with rows and columns exchanged. A cell
//! in an odd row and column then gets the value that solves its own equation. In open space, this is bilinear interpolation.
//! Couplings show where walls are, so on no level is a value interpolated across a wall, however thin.

use super::frame::{Ends, Frame};
use super::machine::{LANES, Machine, Pack};
use super::seam::SeamlessOperator;
use super::stencil::{Line, Operator, Stencil};
use super::transfer::Transfer;

/// A [`Line`], split into its even and odd columns: entry `j` of `even` is column `2 j`, and entry `j` of `odd` is
/// column `2 j + 1`.
struct Halves {
    even: Line,
    odd: Line,
}

impl Halves {
    fn new(len: usize) -> Self {
        Self { even: Line::new(len), odd: Line::new(len) }
    }

    fn clear(&mut self) {
        self.even.parts().into_iter().chain(self.odd.parts()).for_each(|part| part.fill(0.0));
    }

    fn read<M: Machine>(&mut self, m: M, line: &mut Line) {
        m.run(
            #[inline(always)]
            || {
                for ((even, odd), line) in self.even.parts().into_iter().zip(self.odd.parts()).zip(line.parts()) {
                    odd[0] = line[0];
                    let pairs = line[1..].as_chunks::<2>().0;
                    for ((even, odd), pair) in even[1..].iter_mut().zip(&mut odd[1..]).zip(pairs) {
                        [*even, *odd] = *pair;
                    }
                }
            },
        );
    }
}

/// Three consecutive rows of an operator, of which the middle one has an even number.
struct Window<'a, O> {
    from: SeamlessOperator<'a, O>,
    line: Line,
    above: Halves,
    middle: Halves,
    below: Halves,
}

impl<'a, O: Operator> Window<'a, O> {
    /// Creates a window before the first row.
    fn new<M: Machine>(m: M, operator: &'a O, coarse: Frame) -> Self {
        let halves = || Halves::new(coarse.width + 2);
        let from = SeamlessOperator::new(operator);
        let line = Line::new(2 * coarse.width + 4 + LANES);
        let mut window = Self { from, line, above: halves(), middle: halves(), below: halves() };
        window.restart(m, coarse);
        window
    }

    /// Moves back to before the first row.
    fn restart<M: Machine>(&mut self, m: M, coarse: Frame) {
        if coarse.ends[0] == Ends::Joined {
            self.from.line(m, 2 * coarse.rows - 1, &mut self.line);
            self.below.read(m, &mut self.line);
        } else {
            self.below.clear();
        }
    }

    /// Advances to the three rows around row `2 i`.
    fn advance<M: Machine>(&mut self, m: M, i: usize) {
        std::mem::swap(&mut self.above, &mut self.below);
        self.from.line(m, 2 * i, &mut self.line);
        self.middle.read(m, &mut self.line);
        self.from.line(m, 2 * i + 1, &mut self.line);
        self.below.read(m, &mut self.line);
    }
}

/// Returns the transfer from `operator` to the next coarser level, and the operator there.
pub(super) fn coarsen<M: Machine, O: Operator>(m: M, operator: &O) -> (Transfer, Stencil) {
    let fine = operator.frame();
    let coarse = Frame::new([fine.rows.div_ceil(2), fine.columns.div_ceil(2)], fine.ends).of_coefficients();
    let mut transfer = Transfer::new(fine, coarse);
    let mut window = Window::new(m, operator, coarse);
    let mut unknown = vec![0.0; coarse.len()];
    for i in 0..coarse.rows {
        window.advance(m, i);
        line_weights(m, &window, &mut transfer, i);
        let even = &window.middle.even.diagonal[1..];
        let unknown = &mut unknown[coarse.row(i)];
        unknown.iter_mut().zip(even).for_each(|(to, &diagonal)| *to = if diagonal > 0.0 { 1.0 } else { 0.0 });
    }
    coarse.finish(&mut unknown);
    for i in 0..coarse.rows {
        keep_unknowns(m, &mut transfer, &unknown, i);
    }
    transfer.finish();
    let mut stencil = Stencil::new(coarse);
    window.restart(m, coarse);
    for i in 0..coarse.rows {
        window.advance(m, i);
        center_weights(m, &window, &mut transfer, i);
    }
    transfer.finish();
    window.restart(m, coarse);
    let mut between = [(); 4].map(|()| vec![0.0; coarse.width + 2]);
    for i in 0..coarse.rows {
        window.advance(m, i);
        seen_between(m, &window, &transfer, i, &mut between);
        products(m, &window, &transfer, &between, &mut stencil, i);
    }
    stencil.finish();
    transfer.drop_seams();
    transfer.finish();
    (transfer, stencil)
}

/// Computes the weights of the fine cells between two coarse cells, either of row `i`, or of rows `i` and `i + 1`.
fn line_weights<M: Machine, O>(m: M, window: &Window<O>, transfer: &mut Transfer, i: usize) {
    let (c, e) = (&window.middle.even, &window.middle.odd);
    let (s, x) = (&window.below.even, &window.below.odd);
    let (n, nx) = (&window.above.even, &window.above.odd);
    let row = transfer.coarse.row(i);
    m.run(
        #[inline(always)]
        || {
            for j in (0..row.len()).step_by(LANES) {
                let at = row.start + j;
                let inverse =
                    m.inverse(m.load(&e.diagonal, j + 1) - m.load(&e.south, j + 1) - m.load(&nx.south, j + 1));
                let west = m.load(&c.east, j + 1) + m.load(&e.south_west, j + 1) + m.load(&n.south_east, j + 1);
                (west * inverse).store(&mut transfer.west, at);
                let east = m.load(&e.east, j + 1) + m.load(&e.south_east, j + 1) + m.load(&n.south_west, j + 2);
                (east * inverse).store(&mut transfer.east, at);
                let inverse = m.inverse(m.load(&s.diagonal, j + 1) - m.load(&s.east, j + 1) - m.load(&x.east, j));
                let north = m.load(&c.south, j + 1) + m.load(&e.south_west, j + 1) + m.load(&e.south_east, j);
                (north * inverse).store(&mut transfer.north, at);
                let south = m.load(&s.south, j + 1) + m.load(&s.south_east, j + 1) + m.load(&s.south_west, j + 1);
                (south * inverse).store(&mut transfer.south, at);
            }
        },
    );
}

/// Sets the weights from coarse cells that are not unknowns to 0. Otherwise, diagonal couplings that lead past such a cell would
/// count as couplings to it.
fn keep_unknowns<M: Machine>(m: M, transfer: &mut Transfer, unknown: &[f32], i: usize) {
    let (row, below) = (transfer.coarse.row(i), transfer.coarse.below(i));
    m.run(
        #[inline(always)]
        || {
            for j in (0..row.len()).step_by(LANES) {
                let (at, under) = (row.start + j, below + j);
                let t = &mut *transfer;
                for (part, from) in
                    [(&mut t.west, at), (&mut t.east, at + 1), (&mut t.north, at), (&mut t.south, under)]
                {
                    (m.load(part, at) * m.load(unknown, from)).store(part, at);
                }
            }
        },
    );
}

/// Computes the weights of the fine cells that lie in the middle of four coarse cells.
fn center_weights<M: Machine, O>(m: M, window: &Window<O>, transfer: &mut Transfer, i: usize) {
    let (c, e) = (&window.middle.even, &window.middle.odd);
    let (s, x) = (&window.below.even, &window.below.odd);
    let (row, below) = (transfer.coarse.row(i), transfer.coarse.below(i));
    m.run(
        #[inline(always)]
        || {
            for j in (0..row.len()).step_by(LANES) {
                let (at, under) = (row.start + j, below + j);
                let inverse = m.inverse(m.load(&x.diagonal, j + 1));
                let t = &transfer;
                let corners = [
                    m.load(&c.south_east, j + 1)
                        + m.load(&e.south, j + 1) * m.load(&t.west, at)
                        + m.load(&s.east, j + 1) * m.load(&t.north, at),
                    m.load(&c.south_west, j + 2)
                        + m.load(&e.south, j + 1) * m.load(&t.east, at)
                        + m.load(&x.east, j + 1) * m.load(&t.north, at + 1),
                    m.load(&x.south_west, j + 1)
                        + m.load(&x.south, j + 1) * m.load(&t.west, under)
                        + m.load(&s.east, j + 1) * m.load(&t.south, at),
                    m.load(&x.south_east, j + 1)
                        + m.load(&x.south, j + 1) * m.load(&t.east, under)
                        + m.load(&x.east, j + 1) * m.load(&t.south, at + 1),
                ];
                for (part, corner) in transfer.corners.iter_mut().zip(corners) {
                    (corner * inverse).store(part, at);
                }
            }
        },
    );
}

/// Computes the entries of `A P` in the rows of the fine cells between the coarse cells of row `i`, for the columns of the coarse
/// cells to the west, east, south-west and south-east of each.
fn seen_between<M: Machine, O>(m: M, window: &Window<O>, transfer: &Transfer, i: usize, seen: &mut [Vec<f32>; 4]) {
    let (c, e) = (&window.middle.even, &window.middle.odd);
    let (n, nx) = (&window.above.even, &window.above.odd);
    let t = &transfer;
    let (row, above) = (t.coarse.row(i), t.coarse.above(i));
    m.run(
        #[inline(always)]
        || {
            for j in (0..row.len()).step_by(LANES) {
                let (at, over) = (row.start + j, above + j);
                let (d, s, sx) = (m.load(&e.diagonal, j + 1), m.load(&e.south, j + 1), m.load(&nx.south, j + 1));
                let (sw, se) = (m.load(&e.south_west, j + 1), m.load(&e.south_east, j + 1));
                let west = d * m.load(&t.west, at)
                    - m.load(&c.east, j + 1)
                    - s * m.load(&t.corners[0], at)
                    - sx * m.load(&t.corners[2], over)
                    - sw * m.load(&t.north, at)
                    - m.load(&n.south_east, j + 1) * m.load(&t.south, over);
                let east = d * m.load(&t.east, at)
                    - m.load(&e.east, j + 1)
                    - s * m.load(&t.corners[1], at)
                    - sx * m.load(&t.corners[3], over)
                    - se * m.load(&t.north, at + 1)
                    - m.load(&n.south_west, j + 2) * m.load(&t.south, over + 1);
                let south_west = m.all(0.0) - s * m.load(&t.corners[2], at) - sw * m.load(&t.south, at);
                let south_east = m.all(0.0) - s * m.load(&t.corners[3], at) - se * m.load(&t.south, at + 1);
                for (seen, value) in seen.iter_mut().zip([west, east, south_west, south_east]) {
                    value.store(seen, j + 1);
                }
            }
        },
    );
    for seen in seen {
        t.coarse.finish_ends(seen);
    }
}

/// Computes row `i` of `P^T A P`, and the contribution of the same fine rows to row `i + 1`. Cells in the middle of four coarse
/// cells contribute nothing, because with their weights `A P` is zero there.
fn products<M: Machine, O>(
    m: M,
    window: &Window<O>,
    transfer: &Transfer,
    between: &[Vec<f32>; 4],
    into: &mut Stencil,
    i: usize,
) {
    let (c, e) = (&window.middle.even, &window.middle.odd);
    let (s, x) = (&window.below.even, &window.below.odd);
    let (n, nx) = (&window.above.even, &window.above.odd);
    let t = &transfer;
    let (row, above, below) = (t.coarse.row(i), t.coarse.above(i), t.coarse.below(i));
    // Beyond the end of an interval, nothing is added, so any row will do after the last one.
    let following = t.coarse.row((i + 1) % t.coarse.rows).start;
    m.run(
        #[inline(always)]
        || {
            for j in (0..row.len()).step_by(LANES) {
                let (at, over, under, following) = (row.start + j, above + j, below + j, following + j);
                let (west, east_before) = (m.load(&t.west, at), m.load(&t.east, at - 1));
                let (north, south) = (m.load(&t.north, at), m.load(&t.south, at));

                // A P at the coarse cell itself: its own entry, then those towards east, south, south-east and south-west, as
                // couplings.
                let (ce, cs, cse, csw) = (
                    m.load(&c.east, j + 1),
                    m.load(&c.south, j + 1),
                    m.load(&c.south_east, j + 1),
                    m.load(&c.south_west, j + 1),
                );
                let nsw = m.load(&nx.south_west, j + 1);
                let own = m.load(&c.diagonal, j + 1)
                    - ce * west
                    - m.load(&e.east, j) * east_before
                    - cs * north
                    - m.load(&n.south, j + 1) * m.load(&t.south, over)
                    - cse * m.load(&t.corners[0], at)
                    - csw * m.load(&t.corners[1], at - 1)
                    - nsw * m.load(&t.corners[2], over)
                    - m.load(&nx.south_east, j) * m.load(&t.corners[3], over - 1);
                let to_east =
                    ce * m.load(&t.east, at) + cse * m.load(&t.corners[1], at) + nsw * m.load(&t.corners[3], over);
                let to_south = cs * south + cse * m.load(&t.corners[2], at) + csw * m.load(&t.corners[3], at - 1);
                let to_south_east = cse * m.load(&t.corners[3], at);
                let to_south_west = csw * m.load(&t.corners[2], at - 1);

                // At the cell to the south of it: entries for north and south, and for the eastern and western neighbours of
                // those.
                let (se, xe) = (m.load(&s.east, j + 1), m.load(&x.east, j));
                let (sse, ssw, esw) =
                    (m.load(&s.south_east, j + 1), m.load(&s.south_west, j + 1), m.load(&e.south_west, j + 1));
                let s_north = m.load(&s.diagonal, j + 1) * north
                    - cs
                    - se * m.load(&t.corners[0], at)
                    - xe * m.load(&t.corners[1], at - 1)
                    - esw * west
                    - m.load(&e.south_east, j) * east_before;
                let s_south = m.load(&s.diagonal, j + 1) * south
                    - m.load(&s.south, j + 1)
                    - se * m.load(&t.corners[2], at)
                    - xe * m.load(&t.corners[3], at - 1)
                    - sse * m.load(&t.west, under)
                    - ssw * m.load(&t.east, under - 1);
                let s_north_east = se * m.load(&t.corners[1], at) + esw * m.load(&t.east, at);
                let s_south_east = se * m.load(&t.corners[3], at) + sse * m.load(&t.east, under);
                let s_south_west = xe * m.load(&t.corners[2], at - 1) + ssw * m.load(&t.west, under - 1);

                let [e_west, e_east, e_south_west, e_south_east] = between;
                let diagonal = own + west * m.load(e_west, j + 1) + east_before * m.load(e_east, j) + north * s_north;
                (m.load(&into.diagonal, at) + diagonal).store(&mut into.diagonal, at);
                (m.load(&into.diagonal, following) + (south * s_south)).store(&mut into.diagonal, following);
                (m.load(&into.east, at) + (to_east - west * m.load(e_east, j + 1) + north * s_north_east))
                    .store(&mut into.east, at);
                (m.load(&into.east, following) + (south * s_south_east)).store(&mut into.east, following);
                let value = to_south
                    - west * m.load(e_south_west, j + 1)
                    - east_before * m.load(e_south_east, j)
                    - north * s_south;
                value.store(&mut into.south, at);
                (to_south_east - west * m.load(e_south_east, j + 1) + north * s_south_east)
                    .store(&mut into.south_east, at);
                let value = to_south_west - east_before * m.load(e_south_west, j) + north * s_south_west;
                value.store(&mut into.south_west, at);
            }
        },
    );
}
