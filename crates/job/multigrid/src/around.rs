//! The neighbours of a row's cells, as packs.

use super::machine::{LANES, Machine, packs};
use super::stencil::Stencil;

/// Packs of cells that are adjacent in memory.
type Packs<'a> = &'a [[f32; LANES]];

/// The packs of a row and of the eight neighbours of its cells, each neighbour with its coupling.
pub(super) struct NineCells<'a> {
    pub middle: Packs<'a>,
    /// Pairs of couplings and values, in the order: east, west, south, north, south-east, north-west, south-west,
    /// north-east.
    terms: [(Packs<'a>, Packs<'a>); 8],
}

impl<'a> NineCells<'a> {
    #[inline(always)]
    pub fn new(stencil: &'a Stencil, values: &'a [f32], i: usize) -> Self {
        let frame = stencil.frame;
        let count = frame.width / LANES;
        let [above, middle, below] = frame.three(values, i);
        let (at, over) = (frame.row(i).start, frame.above(i));
        let Stencil { east, south, south_east, south_west, .. } = stencil;
        let term = |part: &'a [f32], at: usize, of: &'a [f32], j: usize| (packs(part, at, count), packs(of, j, count));
        let terms = [
            term(east, at, middle, 2),
            term(east, at - 1, middle, 0),
            term(south, at, below, 1),
            term(south, over, above, 1),
            term(south_east, at, below, 2),
            term(south_east, over - 1, above, 0),
            term(south_west, at, below, 0),
            term(south_west, over + 1, above, 2),
        ];
        Self { middle: packs(middle, 1, count), terms }
    }

    /// Returns, for the cells of pack `k`, the sum over the eight neighbours of coupling times value.
    #[inline(always)]
    pub fn sum<M: Machine>(&self, m: M, k: usize) -> M::Single {
        let [a, b, c, d, e, f, g, h] = &self.terms;
        let term = |term: &(Packs, Packs)| m.pack(&term.0[k]) * m.pack(&term.1[k]);
        ((term(a) + term(b)) + (term(c) + term(d))) + ((term(e) + term(f)) + (term(g) + term(h)))
    }
}
