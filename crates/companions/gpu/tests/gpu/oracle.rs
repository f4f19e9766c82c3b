//! Makes random problems, relaxes them one cell after the other in double precision, and solves them by dense
//! elimination.

use cplan_fields::{Boundary, CellEquations, Measure, Relaxation, Scheme};
use cplan_gpu::GridEquations;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// A test problem with all its data.
#[derive(Debug, Clone)]
pub struct Case {
    pub cells: [usize; 2],
    pub boundaries: [Boundary; 2],
    pub outside: f64,
    pub values: Vec<f64>,
    pub unknown: Vec<bool>,
    pub equations: CellEquations,
}

/// The kind of equation.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    Mean,
    Central,
    Upwind,
    Altered,
}

impl Case {
    pub fn problem(&self) -> GridEquations {
        let Case { cells, boundaries, outside, values, unknown, equations } = self.clone();
        GridEquations::new(cells, boundaries, outside, values, unknown, equations).unwrap()
    }

    /// Returns the four neighbours of a cell. On a short circle, a neighbour may be the cell itself. It is `None`
    /// outside of the grid.
    fn neighbors(&self, cell: usize) -> [Option<usize>; 4] {
        let [rows, columns] = self.cells.map(|n| n as isize);
        let (i, j) = (cell as isize / columns, cell as isize % columns);
        [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)].map(|(a, b)| {
            let is_beyond = [a != a.clamp(0, rows - 1), b != b.clamp(0, columns - 1)];
            for (boundary, is_beyond) in self.boundaries.into_iter().zip(is_beyond) {
                match boundary {
                    Boundary::High if is_beyond => return None,
                    Boundary::Reflecting if is_beyond => return Some(cell),
                    _ => {}
                }
            }
            Some((a.rem_euclid(rows) * columns + b.rem_euclid(columns)) as usize)
        })
    }

    fn implied_value(&self, cell: usize, values: &[f64]) -> f64 {
        let [a, b, c, d] = self.neighbors(cell).map(|place| place.map_or(self.outside, |place| values[place]));
        match &self.equations {
            CellEquations::Mean => (a + b + c + d) / 4.0,
            CellEquations::Weights(w) => w[cell][0] * a + w[cell][1] * b + w[cell][2] * c + w[cell][3] * d,
            CellEquations::Altered(s) => (a + b + c + d) / 4.0 + s[cell] * ((a - b).abs() + (c - d).abs()) / 2.0,
        }
    }

    /// Returns the values after this many sweeps, and the measure of each sweep.
    pub fn relaxed(&self, relaxation: &Relaxation, measure: Measure, sweeps: usize) -> (Vec<f64>, Vec<f64>) {
        let (columns, is_jacobi) = (self.cells[1], matches!(relaxation.scheme, Scheme::Simultaneous { .. }));
        let mut order: Vec<usize> = (0..self.values.len()).filter(|&cell| self.unknown[cell]).collect();
        order.sort_by_key(|cell| (cell / columns + cell % columns) % 2);
        let mut values = self.values.clone();
        let (mut measures, mut before) = (Vec::new(), f64::INFINITY);
        for _ in 0..sweeps {
            let old = values.clone();
            for &cell in &order {
                let asked = self.implied_value(cell, if is_jacobi { &old } else { &values });
                let next = old[cell] + relaxation.factor(self.cells) * (asked - old[cell]);
                values[cell] = relaxation.clamp.map_or(next, |[low, high]| next.clamp(low, high));
            }
            let changes = || order.iter().map(|&cell| (values[cell] - old[cell]).abs());
            let sum: f64 = changes().sum();
            let shares =
                || order.iter().zip(changes()).filter(|(_, c)| *c > 0.0).map(|(&cell, c)| c / values[cell].abs());
            measures.push(match measure {
                Measure::SumOfChange => sum,
                Measure::SumOfSquares => changes().map(|c| c * c).sum(),
                Measure::GreatestChange => changes().fold(0.0, f64::max),
                Measure::GreatestRelativeChange => shares().fold(0.0, f64::max),
                Measure::DifferenceOfSums => (sum - before).abs(),
            });
            before = sum;
        }
        (values, measures)
    }

    /// Returns the solution of a linear equation, or `None` if it is singular.
    pub fn solved(&self) -> Option<Vec<f64>> {
        let n = self.values.len();
        let (mut matrix, mut right) = (DMatrix::identity(n, n), DVector::from_column_slice(&self.values));
        for cell in (0..n).filter(|&cell| self.unknown[cell]) {
            right[cell] = 0.0;
            let weights = if let CellEquations::Weights(weights) = &self.equations { weights[cell] } else { [0.25; 4] };
            for (place, weight) in self.neighbors(cell).into_iter().zip(weights) {
                match place {
                    Some(place) => matrix[(cell, place)] -= weight,
                    None => right[cell] += weight * self.outside,
                }
            }
        }
        Some(matrix.lu().solve(&right)?.iter().copied().collect())
    }
}

fn boundary() -> impl Strategy<Value = Boundary> {
    prop_oneof![Just(Boundary::Periodic), Just(Boundary::High), Just(Boundary::Reflecting)]
}

fn equations(kind: Kind, drifts: &[[f64; 2]]) -> CellEquations {
    let side = |b: f64| if matches!(kind, Kind::Upwind) { 1.0 + b.max(0.0) } else { 1.0 + 0.5 * b };
    let weights = |b: &[f64; 2]| {
        let weights = [side(-b[0]), side(b[0]), side(-b[1]), side(b[1])];
        let sum: f64 = weights.iter().sum();
        weights.map(|weight| weight / sum)
    };
    match kind {
        Kind::Mean => CellEquations::Mean,
        Kind::Central | Kind::Upwind => CellEquations::Weights(drifts.iter().map(weights).collect()),
        Kind::Altered => CellEquations::Altered(drifts.iter().map(|b| 0.25 * b[0]).collect()),
    }
}

/// Generates problems with random walls and goals. The drift of each cell is so weak that central differences are
/// monotone.
pub fn case(kind: Kind, most: usize) -> impl Strategy<Value = Case> {
    let cells = [1..=most, 1..=most];
    (cells, [boundary(), boundary()], 0.0..0.6_f64).prop_flat_map(move |(cells, boundaries, walls)| {
        let count = cells[0] * cells[1];
        let cell = prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64, [-1.9..1.9_f64, -1.9..1.9]), count);
        (cell, -1.0..1.0_f64).prop_map(move |(drawn, outside)| {
            // The first is given, so that there is a solution, unless walls cut it off: then those within have walls.
            let is_given = |(k, cell): (usize, &(f64, f64, [f64; 2]))| k == 0 || cell.0 < walls;
            let unknown: Vec<bool> = drawn.iter().enumerate().map(|cell| !is_given(cell)).collect();
            let drifts: Vec<[f64; 2]> = drawn.iter().map(|cell| cell.2).collect();
            let values = drawn.iter().map(|cell| cell.1).collect();
            Case { cells, boundaries, outside, values, unknown, equations: equations(kind, &drifts) }
        })
    })
}

/// Generates problems of all kinds.
pub fn any_case(most: usize) -> impl Strategy<Value = Case> {
    prop_oneof![case(Kind::Mean, most), linear(most), case(Kind::Altered, most)]
}

/// Generates linear problems.
pub fn linear(most: usize) -> impl Strategy<Value = Case> {
    prop_oneof![case(Kind::Mean, most), case(Kind::Central, most), case(Kind::Upwind, most)]
}

/// Returns the greatest difference of two fields.
pub fn greatest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |most, (a, b)| if (a - b).is_nan() { f64::INFINITY } else { f64::max(most, (a - b).abs()) })
}
