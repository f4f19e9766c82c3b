//! The passes of conjugate gradients over their vectors, in double precision.

use super::around::Around;
use super::machine::{LANES, Machine, Pack, packs, packs_mut};
use super::solve::Workspace;
use super::stencil::FivePoint;

/// Residuals less than this part of the greatest of the start are 0 to the preconditioner: in single precision they would
/// only become subnormal numbers, which are slow, along its way.
const NEGLIGIBLE: f32 = 1e-25;

/// A right-hand side.
#[derive(Debug, Clone, Copy)]
pub(super) enum Right<'a> {
    Given(&'a [f64]),
    /// 1 at one cell, 0 at the others.
    Unit(usize),
}

/// The vectors in the course of a solve. Walls are no unknowns: the direction is 0 there, and what the residual is there
/// is never looked at.
pub(super) struct State<'a, M> {
    m: M,
    operator: &'a FivePoint,
    values: &'a mut [f64],
    pub work: &'a mut Workspace,
    /// The residual is given to the preconditioner times this, which makes the greatest of the start 1.
    scale: f64,
    /// Of the last pack of a row, see [`Frame::tail`](super::frame::Frame::tail).
    tail: [f64; LANES],
}

impl<'a, M: Machine> State<'a, M> {
    /// Reads right-hand side and start, and sets the right-hand side of the preconditioner.
    pub fn new(m: M, operator: &'a FivePoint, right: Right, values: &'a mut [f64], work: &'a mut Workspace) -> Self {
        let frame = operator.frame;
        let columns = frame.columns;
        // The start lies in `direction`, with its frame, until the residual is known.
        let mut from_zero = true;
        for (i, values) in values.chunks_exact_mut(columns).enumerate() {
            let row = frame.row(i);
            let start = &mut work.direction[row.clone()];
            for ((to, value), &free) in start.iter_mut().zip(values).zip(&operator.free[row.clone()]) {
                *value = if free > 0.0 { *value } else { 0.0 };
                from_zero &= *value == 0.0;
                *to = *value;
            }
            start[columns..].fill(0.0);
            match right {
                Right::Given(right) => {
                    let (cells, padding) = work.residual[row].split_at_mut(columns);
                    cells.copy_from_slice(&right[i * columns..(i + 1) * columns]);
                    padding.fill(0.0);
                }
                Right::Unit(cell) => {
                    work.residual[row.clone()].fill(0.0);
                    if cell / columns == i {
                        work.residual[row][cell % columns] = 1.0;
                    }
                }
            }
        }
        let mut state = Self { m, operator, values, work, scale: 1.0, tail: frame.tail() };
        if !from_zero {
            state.subtract_start(right);
        }
        let largest = state.largest_residual();
        if largest > 0.0 {
            state.scale = 1.0 / largest;
        }
        state.give_residual();
        state
    }

    /// Takes what the start, which lies in `direction`, makes up for off the residual; leaves a direction of zeros.
    fn subtract_start(&mut self, right: Right) {
        let (m, operator) = (self.m, self.operator);
        let frame = operator.frame;
        let Workspace { residual, direction, .. } = &mut *self.work;
        frame.finish(direction);
        if let Right::Unit(cell) = right {
            // A start in proportion to the solution is as good as the solution: with `A u = e`, `(A u)` at the cell is 1.
            let ([above, middle, below], j) = (frame.three(direction, cell / frame.columns), cell % frame.columns + 1);
            let source = operator.degree * middle[j] - ((middle[j - 1] + middle[j + 1]) + (above[j] + below[j]));
            if source > 0.0 {
                self.values.iter_mut().for_each(|value| *value /= source);
                direction.iter_mut().for_each(|value| *value /= source);
            }
        }
        m.run(
            #[inline(always)]
            || {
                let (degree, count) = (m.all_double(operator.degree), frame.width / LANES);
                for i in 0..frame.rows {
                    let around = Around::new(frame.three(direction, i), count);
                    let residual = packs_mut(residual, frame.row(i).start, count);
                    for (k, residual) in residual.iter_mut().enumerate() {
                        (m.pack_double(residual) - around.applied(m, degree, k)).store(residual, 0);
                    }
                }
            },
        );
        direction.fill(0.0);
    }

    /// The greatest residual of an unknown.
    fn largest_residual(&self) -> f64 {
        let (m, frame) = (self.m, self.operator.frame);
        m.run(
            #[inline(always)]
            || {
                let (mut largest, count) = (m.all_double(0.0), frame.width / LANES);
                for i in 0..frame.rows {
                    let start = frame.row(i).start;
                    let residual = packs(&self.work.residual, start, count);
                    for (left, free) in residual.iter().zip(packs(&self.operator.free, start, count)) {
                        largest = m.greater(largest, m.abs(m.pack_double(left) * m.double(m.pack(free))));
                    }
                }
                greatest(largest)
            },
        )
    }

    /// Sets the right-hand side of the preconditioner.
    fn give_residual(&mut self) {
        let (m, frame) = (self.m, self.operator.frame);
        let Workspace { stack, residual, .. } = &mut *self.work;
        let right = &mut stack.levels[0].right;
        m.run(
            #[inline(always)]
            || {
                let (scale, count) = (m.all_double(self.scale), frame.width / LANES);
                for i in 0..frame.rows {
                    let start = frame.row(i).start;
                    let free = packs(&self.operator.free, start, count);
                    let (residual, to) = (packs(residual, start, count), packs_mut(right, start, count));
                    for ((left, free), to) in residual.iter().zip(free).zip(to) {
                        let single = m.significant(m.single(m.pack_double(left) * scale), NEGLIGIBLE);
                        (single * m.pack(free)).store(to, 0);
                    }
                    frame.finish_row(right, i);
                }
            },
        );
    }

    /// Residual times what the preconditioner made of it, from the product of the two as they are there.
    pub fn unscaled(&self, product: f64) -> f64 {
        product / (self.scale * self.scale)
    }

    /// Takes the next direction, `beta` times the last added; its energy, `p . A p`.
    pub fn turn(&mut self, beta: f64) -> f64 {
        let (m, frame, degree) = (self.m, self.operator.frame, self.operator.degree);
        let Workspace { stack, direction, .. } = &mut *self.work;
        let finest = &stack.levels[0].solution;
        let tail = &self.tail;
        m.run(
            #[inline(always)]
            || {
                let (inverse, beta) = (m.all_double(1.0 / self.scale), m.all_double(beta));
                let (tail, degree, count) = (m.load_double(tail, 0), m.all_double(degree), frame.width / LANES);
                let mut sum = m.all_double(0.0);
                // The energy of a row as soon as the one below it is there.
                for i in frame.ahead() {
                    if let Some(i) = i.made {
                        let start = frame.row(i).start;
                        let (from, to) = (packs(finest, start, count), packs_mut(direction, start, count));
                        for (from, to) in from.iter().zip(to) {
                            (m.double(m.pack(from)) * inverse + beta * m.pack_double(to)).store(to, 0);
                        }
                        frame.finish_row(direction, i);
                    }
                    if let Some(i) = i.used {
                        let around = Around::new(frame.three(direction, i), count);
                        for k in 0..count - 1 {
                            sum = sum + m.pack_double(&around.middle[k]) * around.applied(m, degree, k);
                        }
                        let last = m.pack_double(&around.middle[count - 1]) * around.applied(m, degree, count - 1);
                        sum = sum + last * tail;
                    }
                }
                total(sum)
            },
        )
    }

    /// Goes `alpha` along the direction, and sets the right-hand side of the preconditioner; the greatest change and the
    /// greatest value.
    pub fn step(&mut self, alpha: f64) -> (f64, f64) {
        let (m, frame, degree) = (self.m, self.operator.frame, self.operator.degree);
        let Workspace { stack, residual, direction } = &mut *self.work;
        let values = &mut *self.values;
        let right = &mut stack.levels[0].right;
        let tail = &self.tail;
        m.run(
            #[inline(always)]
            || {
                let (alpha, scale, degree) = (m.all_double(alpha), m.all_double(self.scale), m.all_double(degree));
                let (tail, count) = (m.load_double(tail, 0), frame.width / LANES);
                let (mut change, mut most) = (m.all_double(0.0), m.all_double(0.0));
                for (i, values) in values.chunks_exact_mut(frame.columns).enumerate() {
                    let start = frame.row(i).start;
                    let around = Around::new(frame.three(direction, i), count);
                    let free = packs(&self.operator.free, start, count);
                    let (residual, to) = (packs_mut(residual, start, count), packs_mut(right, start, count));
                    for k in 0..count {
                        let left = m.pack_double(&residual[k]) - alpha * around.applied(m, degree, k);
                        left.store(&mut residual[k], 0);
                        let single = m.significant(m.single(left * scale), NEGLIGIBLE);
                        (single * m.pack(&free[k])).store(&mut to[k], 0);
                    }
                    let (whole, rest) = values.as_chunks_mut::<LANES>();
                    for (value, direction) in whole.iter_mut().zip(around.middle) {
                        let moved = alpha * m.pack_double(direction);
                        let new = m.pack_double(value) + moved;
                        new.store(value, 0);
                        change = m.greater(change, m.abs(moved));
                        most = m.greater(most, m.abs(new));
                    }
                    if !rest.is_empty() {
                        let mut padded = [0.0; LANES];
                        padded[..rest.len()].copy_from_slice(rest);
                        let moved = alpha * tail * m.pack_double(&around.middle[count - 1]);
                        let new = m.pack_double(&padded) + moved;
                        rest.copy_from_slice(&new.lanes()[..rest.len()]);
                        change = m.greater(change, m.abs(moved));
                        most = m.greater(most, m.abs(new));
                    }
                    frame.finish_row(right, i);
                }
                (greatest(change), greatest(most))
            },
        )
    }
}

/// The sum of the lanes, in their order.
fn total(pack: impl Pack<f64>) -> f64 {
    pack.lanes().iter().sum()
}

/// The greatest lane, and 0.
fn greatest(pack: impl Pack<f64>) -> f64 {
    pack.lanes().into_iter().fold(0.0, f64::max)
}
