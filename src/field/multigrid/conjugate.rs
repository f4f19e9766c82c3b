//! The passes of conjugate gradients over their vectors, in double precision.

use super::around::Around;
use super::frame::Frame;
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
    /// 1 for the lanes of the last pack of a row that are cells, 0 for padding.
    tail: [f64; LANES],
}

impl<'a, M: Machine> State<'a, M> {
    /// Reads right-hand side and start, and sets the right-hand side of the preconditioner.
    pub fn new(m: M, operator: &'a FivePoint, right: Right, values: &'a mut [f64], work: &'a mut Workspace) -> Self {
        let frame = operator.frame;
        let columns = frame.columns;
        // The start lies in `direction`, with its frame, until the residual is known.
        for (i, values) in values.chunks_exact_mut(columns).enumerate() {
            let row = frame.row(i);
            let start = &mut work.direction[row.clone()];
            for ((to, value), &free) in start.iter_mut().zip(values).zip(&operator.free[row.clone()]) {
                *value = if free > 0.0 { *value } else { 0.0 };
                *to = *value;
            }
            start[columns..].fill(0.0);
            match right {
                Right::Given(right) => {
                    work.residual[row][..columns].copy_from_slice(&right[i * columns..(i + 1) * columns]);
                }
                Right::Unit(cell) => {
                    work.residual[row.clone()].fill(0.0);
                    if cell / columns == i {
                        work.residual[row][cell % columns] = 1.0;
                    }
                }
            }
        }
        frame.finish(&mut work.direction);
        if let Right::Unit(cell) = right {
            // A start in proportion to the solution is as good as the solution: with `A u = e`, `(A u)` at the cell is 1.
            let ([above, middle, below], j) = (frame.three(&work.direction, cell / columns), cell % columns + 1);
            let source = operator.degree * middle[j] - ((middle[j - 1] + middle[j + 1]) + (above[j] + below[j]));
            if source > 0.0 {
                values.iter_mut().for_each(|value| *value /= source);
                work.direction.iter_mut().for_each(|value| *value /= source);
            }
        }
        let largest = m.run(
            #[inline(always)]
            || {
                let mut largest = m.all_double(0.0);
                let degree = m.all_double(operator.degree);
                let count = frame.width / LANES;
                for i in 0..frame.rows {
                    let start = frame.row(i).start;
                    let around = Around::new(frame.three(&work.direction, i), count);
                    let free = packs(&operator.free, start, count);
                    let residual = packs_mut(&mut work.residual, start, count);
                    for k in 0..count {
                        let left = m.pack_double(&residual[k]) - around.applied(m, degree, k);
                        let left = left * m.double(m.pack(&free[k]));
                        left.store(&mut residual[k], 0);
                        largest = m.greater(largest, m.abs(left));
                    }
                }
                greatest(largest)
            },
        );
        work.direction.fill(0.0);
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        let mut tail = [0.0; LANES];
        tail[..columns - (frame.width - LANES)].fill(1.0);
        let mut state = Self { m, operator, values, work, scale, tail };
        state.step(0.0);
        state
    }

    /// Residual times what the preconditioner made of it.
    pub fn preconditioned_product(&self) -> f64 {
        let m = self.m;
        let Frame { rows, width, .. } = self.operator.frame;
        let finest = &self.work.stack.levels[0];
        let sum = m.run(
            #[inline(always)]
            || {
                let tail = m.load_double(&self.tail, 0);
                let mut sum = m.all_double(0.0);
                for i in 0..rows {
                    let start = self.operator.frame.row(i).start;
                    let end = start + width - LANES;
                    for at in (start..end).step_by(LANES) {
                        sum = sum + m.double(m.load(&finest.right, at)) * m.double(m.load(&finest.solution, at));
                    }
                    sum = sum + m.double(m.load(&finest.right, end)) * m.double(m.load(&finest.solution, end)) * tail;
                }
                total(sum)
            },
        );
        sum / (self.scale * self.scale)
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
