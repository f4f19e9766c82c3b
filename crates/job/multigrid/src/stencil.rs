//! Symmetric nine-point operators, and the rows of them that coarsening reads.

use super::frame::{Ends, Frame};
use super::machine::{LANES, Machine, Pack};

/// The operator `(A u)_p = d_p u_p - sum of c_pq u_q` over the eight neighbours `q` of a cell `p`. Each coupling `c` is stored
/// once, at the first of its two cells. It is 0 unless both cells are unknowns.
#[derive(Debug, Clone)]
pub(super) struct Stencil {
    pub frame: Frame,
    pub diagonal: Vec<f32>,
    /// The reciprocal of the diagonal; 0 for cells that are not unknowns.
    pub inverse: Vec<f32>,
    pub east: Vec<f32>,
    pub south: Vec<f32>,
    pub south_east: Vec<f32>,
    pub south_west: Vec<f32>,
}

impl Stencil {
    /// Creates zero coefficients. Nothing couples across the ends of an interval.
    pub fn new(frame: Frame) -> Self {
        let zeros = || vec![0.0; frame.len()];
        Self {
            frame,
            diagonal: zeros(),
            inverse: zeros(),
            east: zeros(),
            south: zeros(),
            south_east: zeros(),
            south_west: zeros(),
        }
    }

    /// Computes the coefficients that follow from the couplings. To be called after these are set.
    pub fn finish(&mut self) {
        for part in [&mut self.diagonal, &mut self.east, &mut self.south, &mut self.south_east, &mut self.south_west] {
            self.frame.finish(part);
        }
        for (inverse, &diagonal) in self.inverse.iter_mut().zip(&self.diagonal) {
            *inverse = if diagonal > 0.0 { 1.0 / diagonal } else { 0.0 };
        }
        self.frame.finish(&mut self.inverse);
    }
}

/// One row of couplings, with one extra cell before the row and one after it.
#[derive(Debug, Clone, Default)]
pub(super) struct Line {
    pub diagonal: Vec<f32>,
    pub east: Vec<f32>,
    pub south: Vec<f32>,
    pub south_east: Vec<f32>,
    pub south_west: Vec<f32>,
}

impl Line {
    pub fn new(len: usize) -> Self {
        let zeros = || vec![0.0; len];
        Self { diagonal: zeros(), east: zeros(), south: zeros(), south_east: zeros(), south_west: zeros() }
    }

    pub fn parts(&mut self) -> [&mut Vec<f32>; 5] {
        [&mut self.diagonal, &mut self.east, &mut self.south, &mut self.south_east, &mut self.south_west]
    }
}

/// An operator that can be coarsened.
pub(super) trait Operator {
    fn frame(&self) -> Frame;
    /// Writes row `i` to `into`, including the entries at its ends.
    fn line<M: Machine>(&self, m: M, i: usize, into: &mut Line);
}

impl Operator for Stencil {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn line<M: Machine>(&self, _: M, i: usize, into: &mut Line) {
        let range = self.frame.framed(i);
        let from = [&self.diagonal, &self.east, &self.south, &self.south_east, &self.south_west];
        for (into, from) in into.parts().into_iter().zip(from) {
            into[..range.len()].copy_from_slice(&from[range.clone()]);
        }
    }
}

/// The five-point operator of the free cells: degree 4 (less at reflecting ends) plus `shift`.
#[derive(Debug, Clone)]
pub(super) struct FivePoint {
    pub frame: Frame,
    /// Diagonal coefficient, `4 + shift`, of cells that are not at reflecting ends.
    pub degree: f64,
    /// For each cell, 1 if it is free and 0 otherwise.
    pub free: Vec<f32>,
}

impl FivePoint {
    /// Returns true if `A` is singular, which means that it maps constants to zero.
    pub fn is_singular(&self) -> bool {
        let closed = self.frame.ends.iter().all(|&ends| ends != Ends::High);
        let all = || {
            (0..self.frame.rows)
                .all(|i| self.free[self.frame.row(i)][..self.frame.columns].iter().all(|&free| free > 0.0))
        };
        self.degree == 4.0 && closed && all()
    }
}

impl Operator for FivePoint {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn line<M: Machine>(&self, m: M, i: usize, into: &mut Line) {
        let Frame { rows, columns, width, ends, .. } = self.frame;
        let [_, middle, below] = self.frame.three(&self.free, i);
        let degree = m.all(self.degree as f32);
        m.run(
            #[inline(always)]
            || {
                for j in (0..width).step_by(LANES) {
                    let free = m.load(middle, j + 1);
                    (free * degree).store(&mut into.diagonal, j + 1);
                    (free * m.load(middle, j + 2)).store(&mut into.east, j + 1);
                    (free * m.load(below, j + 1)).store(&mut into.south, j + 1);
                }
            },
        );
        let mut back = |at: usize| into.diagonal[at] -= middle[at];
        if ends[0] == Ends::Reflecting {
            for _ in 0..usize::from(i == 0) + usize::from(i + 1 == rows) {
                (1..=columns).for_each(&mut back);
            }
        }
        if ends[1] == Ends::Reflecting {
            back(1);
            back(columns);
        }
        let frame = self.frame.of_coefficients();
        for part in into.parts() {
            frame.finish_ends(&mut part[..width + 2]);
        }
    }
}
