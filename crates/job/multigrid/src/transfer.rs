//! Transfers between a level and the next coarser one: interpolation and restriction.

use super::band::Band;
use super::frame::Frame;
use super::machine::{LANES, Machine, Pack, packs, packs_mut};
use super::seam::odd_circles;
use super::smooth::Vectors;
use super::stencil::Stencil;

/// Interpolation `P` from a coarse level to the next finer one, and its transpose, the restriction. The weights of a fine cell
/// are stored at the coarse cell to the north or west of it.
#[derive(Debug, Clone)]
pub(super) struct Transfer {
    pub fine: Frame,
    pub coarse: Frame,
    /// Weight of the coarse cell to the west, for the fine cell to the east of a coarse one.
    pub west: Vec<f32>,
    /// Weight of the coarse cell to the east, for the same fine cell.
    pub east: Vec<f32>,
    /// Weight of the coarse cell to the north, for the fine cell to the south of a coarse one.
    pub north: Vec<f32>,
    /// Weight of the coarse cell to the south, for the same fine cell.
    pub south: Vec<f32>,
    /// Weights of the four coarse cells around the fine cell to the south-east of a coarse one: north-west, north-east,
    /// south-west and south-east.
    pub corners: [Vec<f32>; 4],
}

/// Temporary rows for the transfers of all levels.
#[derive(Debug, Clone, Default)]
pub(super) struct Rows {
    natural: Vec<f32>,
    even: Vec<f32>,
    odd: Vec<f32>,
    /// The even and the odd columns of the odd row above.
    above: [Vec<f32>; 2],
    below: [Vec<f32>; 2],
}

impl Rows {
    /// Allocates rows of at most this width, which includes padding.
    pub fn new(width: usize) -> Self {
        let zeros = || vec![0.0; width + 2 * LANES + 2];
        Self { natural: zeros(), even: zeros(), odd: zeros(), above: [zeros(), zeros()], below: [zeros(), zeros()] }
    }
}

/// The part of the transfer from the finest level that acts on even cells.
#[derive(Debug, Clone)]
pub(super) struct Corners {
    pub coarse: Frame,
    weights: [Vec<f32>; 4],
}

impl Corners {
    pub fn of(transfer: Transfer) -> Self {
        Self { coarse: transfer.coarse, weights: transfer.corners }
    }

    /// Computes row `i` of `P^T` times a residual that is zero at odd cells, into `into`.
    #[inline(always)]
    pub fn restrict<M: Machine>(&self, m: M, residual: &Band<f32>, i: usize, into: &mut [f32]) {
        let (row, over, count) = (self.coarse.row(i).start, self.coarse.above(i), self.coarse.width / LANES);
        let [nw, ne, sw, se] = &self.weights;
        let [nw, ne] = [packs(nw, row, count), packs(ne, row - 1, count)];
        let [sw, se] = [packs(sw, over, count), packs(se, over - 1, count)];
        let [below, above] = [residual.start(2 * i + 1), residual.above(2 * i)];
        let [below, before_below] = [below, below - 1].map(|at| packs(&residual.data, at, count));
        let [above, before_above] = [above, above - 1].map(|at| packs(&residual.data, at, count));
        let into = packs_mut(into, row, count);
        for (k, (here, into)) in residual.row(2 * i, count).iter().zip(into).enumerate() {
            let lower = m.pack(&nw[k]) * m.pack(&below[k]) + m.pack(&ne[k]) * m.pack(&before_below[k]);
            let upper = m.pack(&sw[k]) * m.pack(&above[k]) + m.pack(&se[k]) * m.pack(&before_above[k]);
            (m.pack(here) + (lower + upper)).store(into, 0);
        }
    }

    /// Computes row `i` of the sum of `inverse` times the residual and of `P` times a coarse vector whose frame is set.
    #[inline(always)]
    pub fn prolong<M: Machine>(
        &self,
        m: M,
        from: &[f32],
        i: usize,
        inverse: M::Single,
        residual: &[[f32; LANES]],
        onto: &mut [[f32; LANES]],
    ) {
        let (row, under, count) = (self.coarse.row(i / 2).start, self.coarse.below(i / 2), self.coarse.width / LANES);
        let nw = packs(from, row, count);
        if i.is_multiple_of(2) {
            for ((from, residual), to) in nw.iter().zip(residual).zip(onto) {
                (inverse * m.pack(residual) + m.pack(from)).store(to, 0);
            }
            return;
        }
        let [ne, sw, se] = [row + 1, under, under + 1].map(|at| packs(from, at, count));
        let [a, b, c, d] = self.weights.each_ref().map(|part| packs(part, row, count));
        for (k, (residual, to)) in residual.iter().zip(onto).enumerate() {
            let upper = m.pack(&a[k]) * m.pack(&nw[k]) + m.pack(&b[k]) * m.pack(&ne[k]);
            let lower = m.pack(&c[k]) * m.pack(&sw[k]) + m.pack(&d[k]) * m.pack(&se[k]);
            (inverse * m.pack(residual) + (upper + lower)).store(to, 0);
        }
    }
}

impl Transfer {
    pub fn new(fine: Frame, coarse: Frame) -> Self {
        let zeros = || vec![0.0; coarse.len()];
        let corners = [(); 4].map(|()| zeros());
        Self { fine, coarse, west: zeros(), east: zeros(), north: zeros(), south: zeros(), corners }
    }

    /// Sets the frames. To be called after the weights are set.
    pub fn finish(&mut self) {
        for part in [&mut self.west, &mut self.east, &mut self.north, &mut self.south] {
            self.coarse.finish(part);
        }
        for part in &mut self.corners {
            self.coarse.finish(part);
        }
    }

    /// Removes the cells that were added at the seams of odd circles.
    pub fn drop_seams(&mut self) {
        let odd = odd_circles(self.fine);
        let frame = self.coarse;
        let [nw, ne, sw, se] = &mut self.corners;
        if odd[0] {
            for part in [&mut self.north, &mut self.south, &mut *nw, &mut *ne, &mut *sw, &mut *se] {
                part[frame.row(frame.rows - 1)].fill(0.0);
            }
        }
        if odd[1] {
            for part in [&mut self.west, &mut self.east, nw, ne, sw, se] {
                for i in 0..frame.rows {
                    part[frame.row(i)][frame.columns - 1] = 0.0;
                }
            }
        }
    }

    /// Computes the residual of the finer level and applies `P^T` to it. The result goes to `into`.
    pub fn restrict<M: Machine>(&self, m: M, level: &Stencil, upper: &Vectors, rows: &mut Rows, into: &mut [f32]) {
        let (fine, coarse) = (self.fine, self.coarse);
        let Rows { natural, even, odd, above, below } = rows;
        let read = |i: usize, natural: &mut [f32], even: &mut [f32], odd: &mut [f32]| {
            level.residual(m, &upper.right, &upper.solution, i, &mut natural[1..=fine.width]);
            fine.finish_ends(&mut natural[..fine.width + 2]);
            m.run(
                #[inline(always)]
                || split(&natural[1..=fine.width], &mut even[1..], &mut odd[1..]),
            );
            odd[0] = natural[0];
        };
        if fine.is_joined_at_rows() && fine.rows.is_multiple_of(2) {
            let [even, odd] = below;
            read(fine.rows - 1, natural, even, odd);
        } else {
            below.iter_mut().for_each(|part| part.fill(0.0));
        }
        for i in 0..coarse.rows {
            std::mem::swap(above, below);
            read(2 * i, natural, even, odd);
            if 2 * i + 1 < fine.rows {
                let [even, odd] = &mut *below;
                read(2 * i + 1, natural, even, odd);
            } else {
                below.iter_mut().for_each(|part| part.fill(0.0));
            }
            let (range, over) = (coarse.row(i), coarse.above(i));
            let [nw, ne, sw, se] = &self.corners;
            m.run(
                #[inline(always)]
                || {
                    for j in (0..coarse.width).step_by(LANES) {
                        let (at, over) = (range.start + j, over + j);
                        let sum = m.load(even, j + 1)
                            + (m.load(&self.west, at) * m.load(odd, j + 1)
                                + m.load(&self.east, at - 1) * m.load(odd, j))
                            + (m.load(&self.north, at) * m.load(&below[0], j + 1)
                                + m.load(&self.south, over) * m.load(&above[0], j + 1))
                            + (m.load(nw, at) * m.load(&below[1], j + 1) + m.load(ne, at - 1) * m.load(&below[1], j))
                            + (m.load(sw, over) * m.load(&above[1], j + 1)
                                + m.load(se, over - 1) * m.load(&above[1], j));
                        sum.store(into, at);
                    }
                },
            );
        }
    }

    /// Interpolates a coarse vector, whose frame is set, and adds the result to a fine vector.
    pub fn prolong<M: Machine>(&self, m: M, from: &[f32], rows: &mut Rows, onto: &mut [f32]) {
        let Rows { even, odd, below, .. } = rows;
        let [a, b, c, d] = &self.corners;
        for i in 0..self.coarse.rows {
            let at = self.coarse.row(i).start;
            let under = self.coarse.below(i);
            m.run(
                #[inline(always)]
                || {
                    for j in (0..self.coarse.width).step_by(LANES) {
                        let (at, under) = (at + j, under + j);
                        let (nw, ne) = (m.load(from, at), m.load(from, at + 1));
                        let (sw, se) = (m.load(from, under), m.load(from, under + 1));
                        nw.store(even, j);
                        (m.load(&self.west, at) * nw + m.load(&self.east, at) * ne).store(odd, j);
                        (m.load(&self.north, at) * nw + m.load(&self.south, at) * sw).store(&mut below[0], j);
                        let upper = m.load(a, at) * nw + m.load(b, at) * ne;
                        (upper + (m.load(c, at) * sw + m.load(d, at) * se)).store(&mut below[1], j);
                    }
                    join(even, odd, &mut onto[self.fine.row(2 * i)]);
                    if 2 * i + 1 < self.fine.rows {
                        join(&below[0], &below[1], &mut onto[self.fine.row(2 * i + 1)]);
                    }
                },
            );
        }
    }
}

/// Splits a row into its even and odd columns.
#[inline(always)]
fn split(natural: &[f32], even: &mut [f32], odd: &mut [f32]) {
    for ((pair, even), odd) in natural.as_chunks::<2>().0.iter().zip(even).zip(odd) {
        [*even, *odd] = *pair;
    }
}

/// Adds even and odd columns to a row.
#[inline(always)]
fn join(even: &[f32], odd: &[f32], onto: &mut [f32]) {
    for ((pair, even), odd) in onto.as_chunks_mut::<2>().0.iter_mut().zip(even).zip(odd) {
        pair[0] += even;
        pair[1] += odd;
    }
}
