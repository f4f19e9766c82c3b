//! Direct solutions by dense LU decomposition. This code shares nothing with the library, except the types that state
//! the problem.

use cplan::field::{Boundary, Cell, Difference, Domain, Equation, Levels};
use nalgebra::{DMatrix, DVector};

/// Parses a domain: `#` is an obstacle and `G` a goal. Rows of text are rows of the domain.
pub fn drawn(text: &str, boundaries: [Boundary; 2], levels: Levels) -> Domain {
    let rows: Vec<&str> = text.split_whitespace().collect();
    let kinds = rows.iter().flat_map(|row| {
        row.chars().map(|c| match c {
            '#' => Cell::Obstacle,
            'G' => Cell::Goal,
            _ => Cell::Free,
        })
    });
    Domain::new([rows.len(), rows[0].len()], kinds.collect(), boundaries, levels)
}

/// Returns the greatest difference of two fields; infinity if a value is not a number.
pub fn greatest_difference(a: &[f64], b: &[f64]) -> f64 {
    let off = |(a, b): (&f64, &f64)| if (a - b).is_nan() { f64::INFINITY } else { (a - b).abs() };
    a.iter().zip(b).map(off).fold(0.0, f64::max)
}

/// The neighbour of a cell in one direction along an axis.
#[derive(Clone, Copy, PartialEq)]
enum NeighborCell {
    Cell(usize),
    Obstacle,
    Same,
}

/// Returns the neighbour of `cell` along `axis`, forwards or backwards.
fn neighbor(domain: &Domain, cell: usize, axis: usize, step: i64) -> NeighborCell {
    let [rows, columns] = domain.cells().map(|n| n as i64);
    let mut at = [cell as i64 / columns, cell as i64 % columns];
    at[axis] += step;
    let n = [rows, columns][axis];
    if !(0..n).contains(&at[axis]) {
        match domain.boundaries()[axis] {
            Boundary::Periodic => at[axis] = at[axis].rem_euclid(n),
            Boundary::High => return NeighborCell::Obstacle,
            Boundary::Reflecting => return NeighborCell::Same,
        }
    }
    NeighborCell::Cell((at[0] * columns + at[1]) as usize)
}

/// Returns the value of a neighbour of a cell. `values` has the values of all cells.
fn value(domain: &Domain, values: &[f64], cell: usize, axis: usize, step: i64) -> f64 {
    match neighbor(domain, cell, axis, step) {
        NeighborCell::Cell(next) => values[next],
        NeighborCell::Obstacle => domain.levels().obstacle,
        NeighborCell::Same => values[cell],
    }
}

fn fixed(domain: &Domain, cell: usize) -> Option<f64> {
    match domain.kinds()[cell] {
        Cell::Free => None,
        Cell::Obstacle => Some(domain.levels().obstacle),
        Cell::Goal => Some(domain.levels().goal),
    }
}

/// Solves `lap p + <b, grad p> = 0`, where `b` is the drift of each cell. A cell has the side 1 along axis 0, and `1 /
/// beta` along axis 1.
fn solve(domain: &Domain, drift: impl Fn(usize) -> [f64; 2], difference: Difference) -> Vec<f64> {
    let n = domain.kinds().len();
    let mut matrix = DMatrix::zeros(n, n);
    let mut right = DVector::zeros(n);
    for cell in 0..n {
        if let Some(value) = fixed(domain, cell) {
            matrix[(cell, cell)] = 1.0;
            right[cell] = value;
            continue;
        }
        // Adds `factor` times the value of a neighbour to the cell's equation.
        let mut add = |to: NeighborCell, factor: f64| match to {
            NeighborCell::Cell(next) => matrix[(cell, next)] += factor,
            NeighborCell::Obstacle => right[cell] -= factor * domain.levels().obstacle,
            NeighborCell::Same => matrix[(cell, cell)] += factor,
        };
        for axis in [0, 1] {
            let (before, here, after) =
                (neighbor(domain, cell, axis, -1), NeighborCell::Cell(cell), neighbor(domain, cell, axis, 1));
            let side = [1.0, 1.0 / domain.beta()][axis];
            for (place, factor) in [(before, 1.0), (here, -2.0), (after, 1.0)] {
                add(place, factor / (side * side));
            }
            let b = drift(cell)[axis] / side;
            let (from, to, width) = match difference {
                Difference::Central => (before, after, 2.0),
                Difference::Upwind if b > 0.0 => (here, after, 1.0),
                Difference::Upwind => (before, here, 1.0),
            };
            add(to, b / width);
            add(from, -b / width);
        }
    }
    matrix.lu().solve(&right).expect("the equations determine the field").as_slice().to_vec()
}

/// Returns the normalised gradient of the published field, in which obstacles have the high value.
fn uphill(domain: &Domain, values: &[f64], cell: usize) -> [f64; 2] {
    let sign = if domain.levels().obstacle > domain.levels().goal { 0.5 } else { -0.5 };
    let slope =
        [0, 1].map(|axis| sign * (value(domain, values, cell, axis, 1) - value(domain, values, cell, axis, -1)));
    let slope = [slope[0], slope[1] * domain.beta()];
    let length = slope[0].hypot(slope[1]);
    if length == 0.0 { slope } else { slope.map(|x| x / length) }
}

/// Returns the left side of the altered preferences' equation at a cell. As in the literature, obstacles have the high
/// value.
pub fn altered(domain: &Domain, published: &[f64], epsilon: &[f64], cell: usize) -> f64 {
    let [west, east] = [-1, 1].map(|step| value(domain, published, cell, 1, step));
    let [south, north] = [-1, 1].map(|step| value(domain, published, cell, 0, step));
    // Per unit of length: second differences are divided by squares of sides, and slopes by sides.
    let weight = domain.beta() * domain.beta();
    let sum = 2.0 + 2.0 * weight;
    let h = (north + south + weight * (west + east)) / sum;
    let d = domain.beta() * (east - west).abs() / 2.0 + (north - south).abs() / 2.0;
    h + epsilon[cell] / sum * d
}

/// Returns the field that solves an equation, by elimination where the equation allows it.
pub fn solution(domain: &Domain, equation: &Equation) -> Vec<f64> {
    match equation {
        Equation::Harmonic => solve(domain, |_| [0.0; 2], Difference::Central),
        Equation::Oriented { direction, epsilon, difference } => {
            let [a, b] = direction.components();
            solve(domain, |_| [epsilon * a, epsilon * b], *difference)
        }
        Equation::LocallyOriented { drift, difference } => solve(domain, |cell| drift[cell], *difference),
        Equation::Preference { epsilon, difference } => {
            let harmonic = solution(domain, &Equation::Harmonic);
            let v = |cell: usize| uphill(domain, &harmonic, cell);
            solve(domain, |cell| v(cell).map(|v| epsilon[cell] * v), *difference)
        }
        Equation::AlteredPreference { epsilon } => {
            // For other levels, solves with the published ones, by the slow method that updates all cells at once.
            let Levels { obstacle, goal, free } = domain.levels();
            let published = Levels::PUBLISHED;
            let same = Domain::new(domain.cells(), domain.kinds().to_vec(), domain.boundaries(), published)
                .with_beta(domain.beta());
            let mut values: Vec<f64> = same.start();
            for _ in 0..20_000 {
                let next = (0..values.len())
                    .map(|cell| fixed(&same, cell).unwrap_or_else(|| altered(&same, &values, epsilon, cell)));
                values = next.collect();
            }
            assert_eq!(free, 0.0);
            values.into_iter().map(|p| goal + (obstacle - goal) * p).collect()
        }
    }
}
