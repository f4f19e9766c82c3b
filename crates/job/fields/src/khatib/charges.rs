//! The repulsion by all obstacle cells together: two convolutions, computed by the fast Fourier transform.

use super::Limits;
use cplan_interrupt::checkpoint;
use cplan_planners::cspace::Grid;
use std::f64::consts::TAU;

/// The effect of all obstacle cells on every cell, as if they were charges: the sum of `1 / d`, and the sum of the forces
/// `1 / d^2` away from obstacle cells. `d` is the distance of the cells' centres, in cells; for continuous joints, in the shorter
/// direction. If cells are not square, the unit of length is the side of a square with the same area. With [`Limits::High`], a
/// frame of one cell beyond the limits of intervals also counts as obstacle.
///
/// The sum of `1 / d^2` approximates the integral of area over squared distance, so it hardly depends on the size of cells. The
/// result equals the direct sums up to rounding. Takes `O(n log n)` for `n` cells.
#[derive(Debug, Clone)]
pub(super) struct Charges {
    /// Sum of `1 / d` for each cell.
    pub potential: Vec<f64>,
    /// Sum of the forces for each cell.
    pub force: Vec<[f64; 2]>,
}

impl Charges {
    pub fn new(grid: &Grid, limits: Limits) -> Self {
        let axes = grid.topology.ranges;
        let frame = axes.map(|axis| usize::from(!axis.is_circle() && limits == Limits::High));
        let framed = [0, 1].map(|k| grid.cells[k] + 2 * frame[k]);
        let padded = framed.map(|n| (2 * n - 1).next_power_of_two());
        let inside = |i: usize, k: usize| (frame[k]..frame[k] + grid.cells[k]).contains(&i);
        let mut sources = Plane::zero(padded);
        for i in 0..framed[0] {
            for j in 0..framed[1] {
                let is_blocked =
                    !(inside(i, 0) && inside(j, 1)) || grid.blocked[(i - frame[0]) * grid.cells[1] + j - frame[1]];
                sources.values[i * padded[1] + j] = [f64::from(u8::from(is_blocked)), 0.0];
            }
        }
        sources.transform(1.0);
        let step = grid.step();
        let side = (step[0] * step[1]).sqrt();
        // Displacement along an axis at a place of the padded plane, whose second half stands for negative displacements. Halfway
        // around a circle, the forces in both directions cancel.
        let along = |k: usize, i: usize| {
            let n = grid.cells[k] as f64;
            let d = if 2 * i < padded[k] { i as f64 } else { i as f64 - padded[k] as f64 };
            let d = if axes[k].is_circle() { d - n * (d / n).round() } else { d };
            let is_half = axes[k].is_circle() && 2.0 * d.abs() == n;
            (d * step[k] / side, if is_half { 0.0 } else { d * step[k] / side })
        };
        let sums = |term: &dyn Fn(f64, [f64; 2]) -> [f64; 2]| {
            let mut kernel = Plane::zero(padded);
            for i in 0..padded[0] {
                for j in 0..padded[1] {
                    let ((a, u), (b, v)) = (along(0, i), along(1, j));
                    let d = a.hypot(b);
                    if d > 0.0 {
                        kernel.values[i * padded[1] + j] = term(d, [u, v]);
                    }
                }
            }
            kernel.transform(1.0);
            for (x, y) in kernel.values.iter_mut().zip(&sources.values) {
                *x = product(*x, *y);
            }
            kernel.transform(-1.0);
            let scale = 1.0 / (padded[0] * padded[1]) as f64;
            let of = |cell: usize| {
                let at = (cell / grid.cells[1] + frame[0]) * padded[1] + cell % grid.cells[1] + frame[1];
                kernel.values[at].map(|x| x * scale)
            };
            (0..grid.blocked.len()).map(of).collect::<Vec<_>>()
        };
        // Both components of a force form one complex number.
        let force = sums(&|d, away| away.map(|x| x / (d * d * d)));
        let potential = sums(&|d, _| [1.0 / d, 0.0]).into_iter().map(|[sum, _]| sum).collect();
        Self { potential, force }
    }
}

/// A rectangle of complex numbers; both sides are powers of 2.
struct Plane {
    cells: [usize; 2],
    values: Vec<[f64; 2]>,
}

impl Plane {
    fn zero(cells: [usize; 2]) -> Self {
        Self { cells, values: vec![[0.0; 2]; cells[0] * cells[1]] }
    }

    /// Computes the Fourier transform if `sign` is 1, or, if it is -1, the inverse transform multiplied by the number of cells.
    fn transform(&mut self, sign: f64) {
        for _ in 0..2 {
            let columns = self.cells[1];
            for row in self.values.chunks_exact_mut(columns) {
                checkpoint();
                transform(row, sign);
            }
            let [rows, columns] = self.cells;
            let turned = (0..columns).flat_map(|j| (0..rows).map(move |i| i * columns + j));
            self.values = turned.map(|at| self.values[at]).collect();
            self.cells = [columns, rows];
        }
    }
}

/// Computes the fast Fourier transform of Cooley and Tukey in place.
fn transform(row: &mut [[f64; 2]], sign: f64) {
    let n = row.len();
    let bits = n.trailing_zeros();
    if bits == 0 {
        return;
    }
    for i in 0..n {
        let j = i.reverse_bits() >> (usize::BITS - bits);
        if i < j {
            row.swap(i, j);
        }
    }
    let roots: Vec<[f64; 2]> = (0..n / 2)
        .map(|k| {
            let (sin, cos) = (-sign * TAU * k as f64 / n as f64).sin_cos();
            [cos, sin]
        })
        .collect();
    let mut half = 1;
    while half < n {
        for block in row.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for (k, (a, b)) in low.iter_mut().zip(high).enumerate() {
                let turned = product(*b, roots[k * (n / (2 * half))]);
                (*a, *b) = ([a[0] + turned[0], a[1] + turned[1]], [a[0] - turned[0], a[1] - turned[1]]);
            }
        }
        half *= 2;
    }
}

fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}
