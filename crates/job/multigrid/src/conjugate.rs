//! The passes of conjugate gradients, for the even cells, and of the finest level of the preconditioner.
//!
//! Vectors are stored in single precision. Their products with the operator are computed in double precision, so that rounding
//! errors stay proportional to the residuals.
//!
//! The preconditioner's smoother on the finest level is one Jacobi step on the system of the even cells, which equals one
//! red-black Gauss-Seidel step on the full system. After it the residual of the odd cells is zero, so they are neither restricted
//! nor interpolated.

use super::band::{Band, Color};
use super::cycle::Stack;
use super::machine::{Machine, Pack};
use super::red_black::{RedBlack, Shape};
use super::transfer::Corners;

/// Residuals below this fraction of the initial maximum are set to 0. In single precision, they would become subnormal numbers,
/// which are slow.
const NEGLIGIBLE: f32 = 1e-25;

/// The vectors of a solve. They can be reused for other solves, also with other walls, on a grid of the same shape.
/// They need about 16 bytes per cell, or 36 if the rows form a circle.
#[derive(Debug, Clone)]
pub struct Workspace {
    shape: Shape,
    pub(super) stack: Stack,
    pub(super) residual: Band<f32>,
    /// The preconditioned residual, and its product with the operator.
    pub(super) advice: Band<f32>,
    advice_image: Band<f32>,
    direction: Band<f32>,
    direction_image: Band<f32>,
    /// The sum of all steps since the residual was last computed.
    sum: Band<f32>,
    even: Band<f32>,
    odd: Band<f32>,
    exact_even: Band<f64>,
    exact_odd: Band<f64>,
    right_even: Band<f64>,
    right_odd: Band<f64>,
}

/// The factors of a step. The next direction is the preconditioned residual plus `beta` times the last direction, and
/// the step is `alpha` times that direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub alpha: f64,
    pub beta: f64,
}

/// The greatest magnitudes in one pass over the grid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Greatest {
    pub value: f64,
    /// Greatest magnitude of the last step, or of the residual.
    pub change: f64,
}

impl Workspace {
    pub(super) fn new(red_black: &RedBlack, stack: Stack) -> Self {
        Self {
            shape: red_black.shape,
            stack,
            residual: red_black.band(),
            advice: red_black.band(),
            advice_image: red_black.band(),
            direction: red_black.band(),
            direction_image: red_black.band(),
            sum: red_black.band(),
            even: red_black.narrow_band(),
            odd: red_black.narrow_band(),
            exact_even: red_black.narrow_band(),
            exact_odd: red_black.narrow_band(),
            right_even: red_black.narrow_band(),
            right_odd: red_black.narrow_band(),
        }
    }

    /// Returns true if the workspace fits the shape of this grid.
    pub(super) fn is_for(&self, red_black: &RedBlack) -> bool {
        self.shape == red_black.shape
    }

    /// Clears all steps.
    pub(super) fn clear_steps(&mut self) {
        for band in [&mut self.sum, &mut self.direction, &mut self.direction_image] {
            band.data.fill(0.0);
        }
    }

    /// Takes a step, smooths the residual, starting from zero, and restricts it to the next coarser level. Returns the greatest
    /// change and the greatest sum of changes.
    pub(super) fn descend<M: Machine>(
        &mut self,
        m: M,
        red_black: &RedBlack,
        corners: &Corners,
        step: Option<Step>,
    ) -> Greatest {
        let count = red_black.count();
        let inverse = m.all((1.0 / red_black.degree) as f32);
        let into = &mut self.stack.levels[0].right;
        let (mut change, mut most) = (m.all(0.0), m.all(0.0));
        m.run(
            #[inline(always)]
            || {
                red_black.pipeline(
                    4,
                    #[inline(always)]
                    |stage, i| match stage {
                        0 => {
                            if let Some(Step { alpha, beta }) = step {
                                let (alpha, beta) = (m.all(alpha as f32), m.all(beta as f32));
                                let (advice, image) = (self.advice.row(i, count), self.advice_image.row(i, count));
                                let directions = self.direction.row_mut(i, count).iter_mut();
                                let images = self.direction_image.row_mut(i, count).iter_mut();
                                let (sums, residuals) =
                                    (self.sum.row_mut(i, count).iter_mut(), self.residual.row_mut(i, count));
                                let rows =
                                    advice.iter().zip(image).zip(directions).zip(images).zip(sums).zip(residuals);
                                let (mut change_here, mut most_here) = (change, most);
                                for (((((advice, image), direction), images), sum), residual) in rows {
                                    let next = m.pack(advice) + beta * m.pack(direction);
                                    next.store(direction, 0);
                                    let moved = alpha * next;
                                    let next = m.pack(image) + beta * m.pack(images);
                                    next.store(images, 0);
                                    let left = m.pack(residual) - alpha * next;
                                    m.significant(left, NEGLIGIBLE).store(residual, 0);
                                    let total = m.pack(sum) + moved;
                                    total.store(sum, 0);
                                    change_here = m.greater(change_here, m.abs(moved));
                                    most_here = m.greater(most_here, m.abs(total));
                                }
                                (change, most) = (change_here, most_here);
                                red_black.frame_even(&mut self.residual, i);
                            }
                        }
                        1 => {
                            odd_row(m, red_black, inverse, &self.residual, &mut self.odd, i);
                        }
                        2 => {
                            let around = self.odd.around(i, Color::Odd, count);
                            for (k, to) in self.even.row_mut(i, count).iter_mut().enumerate() {
                                (inverse * around.sum(m, k)).store(to, 0);
                            }
                            red_black.frame_even(&mut self.even, i);
                        }
                        _ => {
                            if i.is_multiple_of(2) {
                                corners.restrict(m, &self.even, i / 2, into);
                            }
                        }
                    },
                );
            },
        );
        let greatest = |pack: M::Single| f64::from(pack.lanes().into_iter().fold(0.0, f32::max));
        Greatest { value: greatest(most), change: greatest(change) }
    }

    /// Interpolates the coarse solution and smooths it, which gives the preconditioned residual. Returns its scalar products with
    /// the residual and with its own image under the operator.
    pub(super) fn ascend<M: Machine>(&mut self, m: M, red_black: &RedBlack, corners: &Corners) -> [f64; 2] {
        let count = red_black.count();
        let inverse = m.all((1.0 / red_black.degree) as f32);
        let (degree, exact_inverse) = (m.all_double(red_black.degree), m.all_double(1.0 / red_black.degree));
        let from = &self.stack.levels[0].solution;
        let [mut product, mut energy] = [m.all_double(0.0); 2];
        m.run(
            #[inline(always)]
            || {
                red_black.pipeline(
                    5,
                    #[inline(always)]
                    |stage, i| match stage {
                        0 => {
                            corners.prolong(
                                m,
                                from,
                                i,
                                inverse,
                                self.residual.row(i, count),
                                self.even.row_mut(i, count),
                            );
                            red_black.frame_even(&mut self.even, i);
                        }
                        1 => {
                            odd_row(m, red_black, inverse, &self.even, &mut self.odd, i);
                        }
                        2 => {
                            let around = self.odd.around(i, Color::Odd, count);
                            let (residual, free) = (self.residual.row(i, count), red_black.even.row(i, count));
                            let to = self.advice.row_mut(i, count);
                            let mut sum = product;
                            for (k, ((residual, free), to)) in residual.iter().zip(free).zip(to).enumerate() {
                                let residual = m.pack(residual);
                                let advice = (residual + around.sum(m, k)) * (inverse * m.pack(free));
                                advice.store(to, 0);
                                sum = sum + m.double(residual) * m.double(advice);
                            }
                            product = sum;
                            red_black.frame_even(&mut self.advice, i);
                        }
                        3 => {
                            let around = self.advice.around(i, Color::Even, count);
                            let to = self.exact_odd.row_mut(i, count);
                            for (k, (free, to)) in red_black.odd.row(i, count).iter().zip(to).enumerate() {
                                (around.exact_sum(m, k) * (m.double(m.pack(free)) * exact_inverse)).store(to, 0);
                            }
                            red_black.settle(&mut self.exact_odd, &self.advice, i);
                        }
                        _ => {
                            let around = self.exact_odd.around(i, Color::Odd, count);
                            let (advice, free) = (self.advice.row(i, count), red_black.even.row(i, count));
                            let to = self.advice_image.row_mut(i, count);
                            let mut sum = energy;
                            for (k, ((advice, free), to)) in advice.iter().zip(free).zip(to).enumerate() {
                                let advice = m.double(m.pack(advice));
                                let image = (degree * advice - around.sum(m, k)) * m.double(m.pack(free));
                                m.single(image).store(to, 0);
                                sum = sum + advice * image;
                            }
                            energy = sum;
                        }
                    },
                );
            },
        );
        [product, energy].map(|sums| sums.lanes().iter().sum())
    }

    /// Adds `unit` times the sum of the steps to the even cells of `values`, and computes the odd cells from them. If
    /// `scale` is given, also computes the residual times `scale`. Returns the greatest magnitudes of the values and of
    /// the scaled residual.
    pub(super) fn correct<M: Machine>(
        &mut self,
        m: M,
        red_black: &RedBlack,
        right: &[f64],
        values: &mut [f64],
        unit: f64,
        scale: Option<f64>,
    ) -> Greatest {
        let (columns, count) = (red_black.shape.columns, red_black.count());
        let (degree, inverse) = (m.all_double(red_black.degree), m.all_double(1.0 / red_black.degree));
        let stages = if scale.is_some() { 4 } else { 3 };
        let scale = m.all_double(scale.unwrap_or(1.0));
        let [mut most, mut left] = [m.all_double(0.0); 2];
        let unit = m.all_double(unit);
        m.run(
            #[inline(always)]
            || {
                red_black.pipeline(
                    stages,
                    #[inline(always)]
                    |stage, i| match stage {
                        0 => self.add_steps(m, red_black, right, values, unit, i),
                        1 => self.compute_odd(m, red_black, inverse, i),
                        2 => {
                            most = self.greatest_value(m, count, most, i);
                            let [even, odd] =
                                [&self.exact_even, &self.exact_odd].map(|band| &band.data[band.start(i)..]);
                            merge(even, odd, i, &mut values[i * columns..(i + 1) * columns]);
                        }
                        _ => left = self.scaled_residual(m, red_black, [degree, scale], left, i),
                    },
                );
            },
        );
        let greatest = |pack: M::Double| pack.lanes().into_iter().fold(0.0, f64::max);
        Greatest { value: greatest(most), change: greatest(left) }
    }

    /// Reads a row of the right-hand side and of the values. Adds `unit` times the sum of the steps to the row's even
    /// cells.
    #[inline(always)]
    fn add_steps<M: Machine>(
        &mut self,
        m: M,
        red_black: &RedBlack,
        right: &[f64],
        values: &[f64],
        unit: M::Double,
        i: usize,
    ) {
        let (columns, count) = (red_black.shape.columns, red_black.count());
        let range = i * columns..(i + 1) * columns;
        let [even, odd] = [&mut self.right_even, &mut self.right_odd].map(|band| band.cells_mut(i));
        part(&right[range.clone()], i, even, odd);
        part(&values[range], i, self.exact_even.cells_mut(i), self.exact_odd.cells_mut(i));
        let (sum, free) = (self.sum.row(i, count), red_black.even.row(i, count));
        for ((sum, free), to) in sum.iter().zip(free).zip(self.exact_even.row_mut(i, count)) {
            let value = m.pack_double(to) + unit * m.double(m.pack(sum));
            let value = value * m.double(m.pack(free));
            value.store(to, 0);
        }
        red_black.frame_even(&mut self.exact_even, i);
    }

    /// Computes the odd cells of a row from the even ones around them.
    #[inline(always)]
    fn compute_odd<M: Machine>(&mut self, m: M, red_black: &RedBlack, inverse: M::Double, i: usize) {
        let count = red_black.count();
        let around = self.exact_even.around(i, Color::Even, count);
        let (right, free) = (self.right_odd.row(i, count), red_black.odd.row(i, count));
        let to = self.exact_odd.row_mut(i, count);
        for (k, ((right, free), to)) in right.iter().zip(free).zip(to).enumerate() {
            let sum = m.pack_double(right) + around.sum(m, k);
            let value = sum * (m.double(m.pack(free)) * inverse);
            value.store(to, 0);
        }
        red_black.settle(&mut self.exact_odd, &self.exact_even, i);
    }

    /// Returns in each lane the greatest magnitude of `most` and of the cells of a row.
    #[inline(always)]
    fn greatest_value<M: Machine>(&self, m: M, count: usize, mut most: M::Double, i: usize) -> M::Double {
        for (a, b) in self.exact_even.row(i, count).iter().zip(self.exact_odd.row(i, count)) {
            let [a, b] = [a, b].map(|pack| m.abs_double(m.pack_double(pack)));
            most = m.greater_double(most, m.greater_double(a, b));
        }
        most
    }

    /// Computes the scaled residual of a row's even cells. Returns in each lane the greatest magnitude of this residual and of
    /// `left`.
    #[inline(always)]
    fn scaled_residual<M: Machine>(
        &mut self,
        m: M,
        red_black: &RedBlack,
        [degree, scale]: [M::Double; 2],
        mut left: M::Double,
        i: usize,
    ) -> M::Double {
        let count = red_black.count();
        let around = self.exact_odd.around(i, Color::Odd, count);
        let (even, right) = (self.exact_even.row(i, count), self.right_even.row(i, count));
        let free = red_black.even.row(i, count);
        let rows = even.iter().zip(right).zip(free).zip(self.residual.row_mut(i, count));
        for (k, (((even, right), free), to)) in rows.enumerate() {
            let here = m.pack_double(right) - degree * m.pack_double(even);
            let residual = (here + around.sum(m, k)) * (m.double(m.pack(free)) * scale);
            m.significant(m.single(residual), NEGLIGIBLE).store(to, 0);
            left = m.greater_double(left, m.abs_double(residual));
        }
        red_black.frame_even(&mut self.residual, i);
        left
    }
}

/// Computes the smoother's values of the odd cells of row `i`.
#[inline(always)]
fn odd_row<M: Machine>(
    m: M,
    red_black: &RedBlack,
    inverse: M::Single,
    even: &Band<f32>,
    odd: &mut Band<f32>,
    i: usize,
) {
    let count = red_black.count();
    let around = even.around(i, Color::Even, count);
    for (k, (free, to)) in red_black.odd.row(i, count).iter().zip(odd.row_mut(i, count)).enumerate() {
        (around.sum(m, k) * (inverse * m.pack(free))).store(to, 0);
    }
    red_black.settle(odd, even, i);
}

/// Splits row `i` by colour.
#[inline(always)]
fn part(row: &[f64], i: usize, even: &mut [f64], odd: &mut [f64]) {
    let (even, odd) = if i.is_multiple_of(2) { (even, odd) } else { (odd, even) };
    let (pairs, rest) = row.as_chunks::<2>();
    for ((pair, even), odd) in pairs.iter().zip(&mut *even).zip(odd) {
        [*even, *odd] = *pair;
    }
    if let Some(&last) = rest.first() {
        even[pairs.len()] = last;
    }
}

/// Merges the colours of a row.
#[inline(always)]
fn merge(even: &[f64], odd: &[f64], i: usize, row: &mut [f64]) {
    let (even, odd) = if i.is_multiple_of(2) { (even, odd) } else { (odd, even) };
    let (pairs, rest) = row.as_chunks_mut::<2>();
    for ((pair, even), odd) in pairs.iter_mut().zip(even).zip(odd) {
        *pair = [*even, *odd];
    }
    if let Some(last) = rest.first_mut() {
        *last = even[pairs.len()];
    }
}
