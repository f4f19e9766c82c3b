//! The next coarser level: interpolation that follows the operator, and the operator seen through it.
//!
//! Coarse cells are the cells in even rows and columns (box multigrid: Dendy 1982). The cells between two of them in a
//! row get the values that balance the couplings of their column as a whole; the same with rows and columns exchanged;
//! the cells in odd rows and columns then get the values that solve their own equation. In the open that is bilinear
//! interpolation; nothing is interpolated across a wall, however thin, on any level, since couplings say where walls are.

use super::frame::{Ends, Frame, LANES, Pack};
use super::seam::Seamless;
use super::stencil::{Line, Operator, Stencil};
use super::transfer::Transfer;

/// The columns of a [`Line`] apart: number `j` of `even` and of `odd` are the columns `2 j` and `2 j + 1`.
struct Halves {
    even: Line,
    odd: Line,
}

impl Halves {
    fn new(len: usize) -> Self {
        Self { even: Line::new(len), odd: Line::new(len) }
    }

    fn read(&mut self, line: &mut Line) {
        for ((even, odd), line) in self.even.parts().into_iter().zip(self.odd.parts()).zip(line.parts()) {
            odd[0] = line[0];
            let pairs = line[1..].as_chunks::<2>().0;
            for ((even, odd), pair) in even[1..].iter_mut().zip(&mut odd[1..]).zip(pairs) {
                [*even, *odd] = *pair;
            }
        }
    }
}

/// Three consecutive rows of an operator, the middle one even, as [`Halves`].
struct Window<'a, O> {
    from: Seamless<'a, O>,
    line: Line,
    above: Halves,
    middle: Halves,
    below: Halves,
}

impl<'a, O: Operator> Window<'a, O> {
    /// Before the first row.
    fn new(operator: &'a O, coarse: Frame) -> Self {
        let halves = || Halves::new(coarse.width + 2);
        let from = Seamless::new(operator);
        let line = Line::new(2 * coarse.width + 4 + LANES);
        let mut window = Self { from, line, above: halves(), middle: halves(), below: halves() };
        if coarse.ends[0] == Ends::Joined {
            window.from.line(2 * coarse.rows - 1, &mut window.line);
            window.below.read(&mut window.line);
        }
        window
    }

    /// To the rows around row `2 i`.
    fn advance(&mut self, i: usize) {
        std::mem::swap(&mut self.above, &mut self.below);
        self.from.line(2 * i, &mut self.line);
        self.middle.read(&mut self.line);
        self.from.line(2 * i + 1, &mut self.line);
        self.below.read(&mut self.line);
    }
}

/// Coarsens `operator`.
pub(super) fn coarsen<O: Operator>(operator: &O) -> (Transfer, Stencil) {
    let fine = operator.frame();
    let coarse = Frame::new([fine.rows.div_ceil(2), fine.columns.div_ceil(2)], fine.ends).of_coefficients();
    let mut transfer = Transfer::new(fine, coarse);
    let mut window = Window::new(operator, coarse);
    let mut unknown = vec![0.0; coarse.len()];
    for i in 0..coarse.rows {
        window.advance(i);
        line_weights(&window, &mut transfer, i);
        let even = &window.middle.even.diagonal[1..];
        let unknown = &mut unknown[coarse.row(i)];
        unknown.iter_mut().zip(even).for_each(|(to, &diagonal)| *to = if diagonal > 0.0 { 1.0 } else { 0.0 });
    }
    coarse.finish(&mut unknown);
    for i in 0..coarse.rows {
        keep_unknowns(&mut transfer, &unknown, i);
    }
    transfer.finish();
    let mut stencil = Stencil::new(coarse);
    let mut window = Window::new(operator, coarse);
    for i in 0..coarse.rows {
        window.advance(i);
        center_weights(&window, &mut transfer, i);
    }
    transfer.finish();
    let mut window = Window::new(operator, coarse);
    let mut between = [(); 4].map(|()| vec![0.0; coarse.width + 2]);
    for i in 0..coarse.rows {
        window.advance(i);
        seen_between(&window, &transfer, i, &mut between);
        products(&window, &transfer, &between, &mut stencil, i);
    }
    stencil.finish();
    transfer.drop_seams();
    transfer.finish();
    (transfer, stencil)
}

/// Weights of the cells between two coarse cells of row `i`, or of rows `i` and `i + 1`.
fn line_weights<O>(window: &Window<O>, transfer: &mut Transfer, i: usize) {
    let (c, e) = (&window.middle.even, &window.middle.odd);
    let (s, x) = (&window.below.even, &window.below.odd);
    let (n, nx) = (&window.above.even, &window.above.odd);
    let row = transfer.coarse.row(i);
    for j in (0..row.len()).step_by(LANES) {
        let (here, next) = (|part: &Vec<f32>| Pack::load(part, j + 1), |part: &Vec<f32>| Pack::load(part, j + 2));
        let before = |part: &Vec<f32>| Pack::load(part, j);
        let at = row.start + j;
        let inverse = (here(&e.diagonal) - here(&e.south) - here(&nx.south)).inverse();
        let west = here(&c.east) + here(&e.south_west) + here(&n.south_east);
        (west * inverse).store(&mut transfer.west, at);
        let east = here(&e.east) + here(&e.south_east) + next(&n.south_west);
        (east * inverse).store(&mut transfer.east, at);
        let inverse = (here(&s.diagonal) - here(&s.east) - before(&x.east)).inverse();
        let north = here(&c.south) + here(&e.south_west) + before(&e.south_east);
        (north * inverse).store(&mut transfer.north, at);
        let south = here(&s.south) + here(&s.south_east) + here(&s.south_west);
        (south * inverse).store(&mut transfer.south, at);
    }
}

/// Nothing is interpolated from a coarse cell that is no unknown. (Diagonal couplings past it would count for it.)
fn keep_unknowns(transfer: &mut Transfer, unknown: &[f32], i: usize) {
    let (row, below) = (transfer.coarse.row(i), transfer.coarse.below(i));
    for j in (0..row.len()).step_by(LANES) {
        let (at, under) = (row.start + j, below + j);
        let keep =
            |part: &mut Vec<f32>, from: usize| (Pack::load(part, at) * Pack::load(unknown, from)).store(part, at);
        keep(&mut transfer.west, at);
        keep(&mut transfer.east, at + 1);
        keep(&mut transfer.north, at);
        keep(&mut transfer.south, under);
    }
}

/// Weights of the cells in the middle of four coarse cells.
fn center_weights<O>(window: &Window<O>, transfer: &mut Transfer, i: usize) {
    let (c, e) = (&window.middle.even, &window.middle.odd);
    let (s, x) = (&window.below.even, &window.below.odd);
    let (row, below) = (transfer.coarse.row(i), transfer.coarse.below(i));
    for j in (0..row.len()).step_by(LANES) {
        let (here, next) = (|part: &Vec<f32>| Pack::load(part, j + 1), |part: &Vec<f32>| Pack::load(part, j + 2));
        let (at, under) = (row.start + j, below + j);
        let weight = |part: &Vec<f32>, at: usize| Pack::load(part, at);
        let inverse = here(&x.diagonal).inverse();
        let t = &transfer;
        let corners = [
            here(&c.south_east) + here(&e.south) * weight(&t.west, at) + here(&s.east) * weight(&t.north, at),
            next(&c.south_west) + here(&e.south) * weight(&t.east, at) + here(&x.east) * weight(&t.north, at + 1),
            here(&x.south_west) + here(&x.south) * weight(&t.west, under) + here(&s.east) * weight(&t.south, at),
            here(&x.south_east) + here(&x.south) * weight(&t.east, under) + here(&x.east) * weight(&t.south, at + 1),
        ];
        for (part, corner) in transfer.corners.iter_mut().zip(corners) {
            (corner * inverse).store(part, at);
        }
    }
}

/// `A P` at the cells between the coarse cells of row `i`: towards the coarse cells at their west, east, south-west and
/// south-east.
fn seen_between<O>(window: &Window<O>, transfer: &Transfer, i: usize, seen: &mut [Vec<f32>; 4]) {
    let (c, e) = (&window.middle.even, &window.middle.odd);
    let (n, nx) = (&window.above.even, &window.above.odd);
    let t = &transfer;
    let (row, above) = (t.coarse.row(i), t.coarse.above(i));
    for j in (0..row.len()).step_by(LANES) {
        let (here, next) = (|part: &Vec<f32>| Pack::load(part, j + 1), |part: &Vec<f32>| Pack::load(part, j + 2));
        let (at, over) = (row.start + j, above + j);
        let weight = |part: &Vec<f32>, at: usize| Pack::load(part, at);
        let corner = |k: usize, at: usize| Pack::load(&t.corners[k], at);
        let (d, s, sx) = (here(&e.diagonal), here(&e.south), here(&nx.south));
        let (sw, se) = (here(&e.south_west), here(&e.south_east));
        let west = d * weight(&t.west, at)
            - here(&c.east)
            - s * corner(0, at)
            - sx * corner(2, over)
            - sw * weight(&t.north, at)
            - here(&n.south_east) * weight(&t.south, over);
        let east = d * weight(&t.east, at)
            - here(&e.east)
            - s * corner(1, at)
            - sx * corner(3, over)
            - se * weight(&t.north, at + 1)
            - next(&n.south_west) * weight(&t.south, over + 1);
        let south_west = Pack::ZERO - s * corner(2, at) - sw * weight(&t.south, at);
        let south_east = Pack::ZERO - s * corner(3, at) - se * weight(&t.south, at + 1);
        for (seen, value) in seen.iter_mut().zip([west, east, south_west, south_east]) {
            value.store(seen, j + 1);
        }
    }
    for seen in seen {
        t.coarse.finish_ends(seen);
    }
}

/// Row `i` of `P^T A P`, and what it adds to the next. The cells in the middle of four coarse cells add nothing: `A P` is
/// zero there, which is how their weights were chosen.
fn products<O>(window: &Window<O>, transfer: &Transfer, between: &[Vec<f32>; 4], into: &mut Stencil, i: usize) {
    let (c, e) = (&window.middle.even, &window.middle.odd);
    let (s, x) = (&window.below.even, &window.below.odd);
    let (n, nx) = (&window.above.even, &window.above.odd);
    let t = &transfer;
    let (row, above, below) = (t.coarse.row(i), t.coarse.above(i), t.coarse.below(i));
    // Beyond an interval nothing is added, so that any row does for the last.
    let following = t.coarse.row((i + 1) % t.coarse.rows).start;
    for j in (0..row.len()).step_by(LANES) {
        let (here, before) = (|part: &Vec<f32>| Pack::load(part, j + 1), |part: &Vec<f32>| Pack::load(part, j));
        let (at, over, under, following) = (row.start + j, above + j, below + j, following + j);
        let weight = |part: &Vec<f32>, at: usize| Pack::load(part, at);
        let corner = |k: usize, at: usize| Pack::load(&t.corners[k], at);
        let (west, east_before) = (weight(&t.west, at), weight(&t.east, at - 1));
        let (north, south) = (weight(&t.north, at), weight(&t.south, at));

        // A P at the coarse cell itself: its own, then towards east, south, south-east, south-west, as couplings.
        let (ce, cs, cse, csw) = (here(&c.east), here(&c.south), here(&c.south_east), here(&c.south_west));
        let nsw = here(&nx.south_west);
        let own = here(&c.diagonal)
            - ce * west
            - before(&e.east) * east_before
            - cs * north
            - here(&n.south) * weight(&t.south, over)
            - cse * corner(0, at)
            - csw * corner(1, at - 1)
            - nsw * corner(2, over)
            - before(&nx.south_east) * corner(3, over - 1);
        let to_east = ce * weight(&t.east, at) + cse * corner(1, at) + nsw * corner(3, over);
        let to_south = cs * south + cse * corner(2, at) + csw * corner(3, at - 1);
        let to_south_east = cse * corner(3, at);
        let to_south_west = csw * corner(2, at - 1);

        // At the cell south of it: north, south, and the eastern and western neighbours of those.
        let (se, xe) = (here(&s.east), before(&x.east));
        let (sse, ssw, esw) = (here(&s.south_east), here(&s.south_west), here(&e.south_west));
        let s_north = here(&s.diagonal) * north
            - cs
            - se * corner(0, at)
            - xe * corner(1, at - 1)
            - esw * west
            - before(&e.south_east) * east_before;
        let s_south = here(&s.diagonal) * south
            - here(&s.south)
            - se * corner(2, at)
            - xe * corner(3, at - 1)
            - sse * weight(&t.west, under)
            - ssw * weight(&t.east, under - 1);
        let s_north_east = se * corner(1, at) + esw * weight(&t.east, at);
        let s_south_east = se * corner(3, at) + sse * weight(&t.east, under);
        let s_south_west = xe * corner(2, at - 1) + ssw * weight(&t.west, under - 1);

        let [e_west, e_east, e_south_west, e_south_east] = between;
        let add = |part: &mut Vec<f32>, at: usize, value: Pack| (Pack::load(part, at) + value).store(part, at);
        let diagonal = own + west * here(e_west) + east_before * before(e_east) + north * s_north;
        add(&mut into.diagonal, at, diagonal);
        add(&mut into.diagonal, following, south * s_south);
        add(&mut into.east, at, to_east - west * here(e_east) + north * s_north_east);
        add(&mut into.east, following, south * s_south_east);
        let value = to_south - west * here(e_south_west) - east_before * before(e_south_east) - north * s_south;
        value.store(&mut into.south, at);
        (to_south_east - west * here(e_south_east) + north * s_south_east).store(&mut into.south_east, at);
        let value = to_south_west - east_before * before(e_south_west) + north * s_south_west;
        value.store(&mut into.south_west, at);
    }
}
