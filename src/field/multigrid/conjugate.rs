//! The passes of conjugate gradients over their vectors, in double precision.

use super::frame::Frame;
use super::machine::{LANES, Machine, Pack};
use super::solve::Workspace;
use super::stencil::FivePoint;

/// Residuals less than this part of the greatest of the start are 0 to the preconditioner: in single precision they would
/// only become subnormal numbers, which are slow, along its way.
const NEGLIGIBLE: f32 = 1e-25;

/// The vectors in the course of a solve. Walls are no unknowns: the direction is 0 there, and what the residual is there
/// is never looked at.
pub(super) struct State<'a, M> {
    m: M,
    operator: &'a FivePoint,
    pub work: &'a mut Workspace,
    /// The residual is given to the preconditioner times this, which makes the greatest of the start 1.
    scale: f64,
    /// 1 for the lanes of the last pack of a row that are cells, 0 for padding.
    tail: [f64; LANES],
}

impl<'a, M: Machine> State<'a, M> {
    /// Reads right-hand side and start, and sets the right-hand side of the preconditioner.
    pub fn new(m: M, operator: &'a FivePoint, right: &[f64], values: &[f64], work: &'a mut Workspace) -> Self {
        let frame = operator.frame;
        let columns = frame.columns;
        for (i, (right, values)) in right.chunks_exact(columns).zip(values.chunks_exact(columns)).enumerate() {
            let row = frame.row(i);
            let free = &operator.free[row.clone()];
            let only_free = |to: &mut [f64], from: &[f64]| {
                for ((to, &from), &free) in to.iter_mut().zip(from).zip(free) {
                    *to = if free > 0.0 { from } else { 0.0 };
                }
            };
            only_free(&mut work.values[row.clone()], values);
            only_free(&mut work.residual[row.clone()], right);
            work.direction[row].fill(0.0);
        }
        frame.finish(&mut work.values);
        let largest = m.run(
            #[inline(always)]
            || {
                let mut largest = m.all_double(0.0);
                for i in 0..frame.rows {
                    let row = frame.row(i);
                    let three = frame.three(&work.values, i);
                    for j in (0..row.len()).step_by(LANES) {
                        let at = row.start + j;
                        let free = m.double(m.load(&operator.free, at));
                        let residual =
                            (m.load_double(&work.residual, at) - applied(m, operator.degree, three, j)) * free;
                        residual.store(&mut work.residual, at);
                        largest = m.greater(largest, m.abs(residual));
                    }
                }
                greatest(largest)
            },
        );
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        let mut tail = [0.0; LANES];
        tail[..columns - (frame.width - LANES)].fill(1.0);
        let mut state = Self { m, operator, work, scale, tail };
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
        let (m, frame, degree, last) =
            (self.m, self.operator.frame, self.operator.degree, self.operator.frame.width - LANES);
        let Workspace { stack, direction, .. } = &mut *self.work;
        let finest = &stack.levels[0].solution;
        let tail = &self.tail;
        m.run(
            #[inline(always)]
            || {
                let (inverse, beta) = (m.all_double(1.0 / self.scale), m.all_double(beta));
                let tail = m.load_double(tail, 0);
                let mut sum = m.all_double(0.0);
                // The energy of a row as soon as the one below it is there.
                for i in frame.ahead() {
                    if let Some(i) = i.made {
                        for at in frame.row(i).step_by(LANES) {
                            let old = m.load_double(direction, at);
                            (m.double(m.load(finest, at)) * inverse + beta * old).store(direction, at);
                        }
                        frame.finish_row(direction, i);
                    }
                    if let Some(i) = i.used {
                        let three = frame.three(direction, i);
                        for j in (0..last).step_by(LANES) {
                            sum = sum + m.load_double(three[1], j + 1) * applied(m, degree, three, j);
                        }
                        sum = sum + m.load_double(three[1], last + 1) * applied(m, degree, three, last) * tail;
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
        let Workspace { stack, values, residual, direction } = &mut *self.work;
        let right = &mut stack.levels[0].right;
        m.run(
            #[inline(always)]
            || {
                let (alpha, scale) = (m.all_double(alpha), m.all_double(self.scale));
                let (mut change, mut most) = (m.all_double(0.0), m.all_double(0.0));
                for i in 0..frame.rows {
                    let row = frame.row(i);
                    let three = frame.three(direction, i);
                    for j in (0..row.len()).step_by(LANES) {
                        let at = row.start + j;
                        let moved = alpha * m.load_double(three[1], j + 1);
                        let value = m.load_double(values, at) + moved;
                        value.store(values, at);
                        change = m.greater(change, m.abs(moved));
                        most = m.greater(most, m.abs(value));
                        let left = m.load_double(residual, at) - alpha * applied(m, degree, three, j);
                        left.store(residual, at);
                        let single = m.significant(m.single(left * scale), NEGLIGIBLE);
                        (single * m.load(&self.operator.free, at)).store(right, at);
                    }
                    frame.finish_row(right, i);
                }
                (greatest(change), greatest(most))
            },
        )
    }
}

/// `degree u - sum of neighbours`.
#[inline(always)]
fn applied<M: Machine>(m: M, degree: f64, [above, middle, below]: [&[f64]; 3], j: usize) -> M::Double {
    let sides = m.load_double(middle, j) + m.load_double(middle, j + 2);
    let around = sides + (m.load_double(above, j + 1) + m.load_double(below, j + 1));
    m.all_double(degree) * m.load_double(middle, j + 1) - around
}

/// The sum of the lanes, in their order.
fn total(pack: impl Pack<f64>) -> f64 {
    pack.lanes().iter().sum()
}

/// The greatest lane, and 0.
fn greatest(pack: impl Pack<f64>) -> f64 {
    pack.lanes().into_iter().fold(0.0, f64::max)
}
