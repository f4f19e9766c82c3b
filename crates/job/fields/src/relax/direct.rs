//! Computes fields by elimination, for comparison with relaxations.

use super::stencil::{Stencil as _, WeightedMean};
use super::{Domain, Equation, Neighbor};
use cplan_interrupt::checkpoint;

/// Largest residual of an accepted solution, as a fraction of the greatest value. With central differences and a strong drift,
/// elimination may lose all digits.
const MAX_RESIDUAL: f64 = 1e-9;

/// Largest number of entries of the band: 256 MB of memory.
const MAX_BAND_NUMBERS: usize = 1 << 25;

/// Solves a linear equation by banded Gaussian elimination. Returns `None`:
/// - for preferences, whose drift depends on a field,
/// - if elimination without pivoting fails, as for strong drifts with central differences,
/// - if the band would need more than 256 MB of memory,
/// - if the equation is for another domain.
///
/// It shares only the weights of neighbours with the sweeps. Rows are numbered alternately from both ends, so that a circle needs
/// at most twice the bandwidth. Takes `O(cells * columns^2)` time and `O(cells * columns)` memory.
pub fn eliminated(domain: &Domain, equation: &Equation) -> Option<Vec<f64>> {
    if equation.refusal(domain).is_some() {
        return None;
    }
    let (drift, difference) = equation.drift()?;
    let unknowns = unknowns_from_both_ends(domain);
    let weights = WeightedMean::new(domain, &unknowns, drift, difference);
    let mut place = vec![None; domain.kinds().len()];
    for (k, &cell) in unknowns.iter().enumerate() {
        place[cell as usize] = Some(k);
    }
    let mut band = Band::new(reach(domain, &unknowns, &place), unknowns.len())?;
    for (k, &cell) in unknowns.iter().enumerate() {
        band.add(k, k, 1.0);
        for (neighbor, weight) in domain.neighbors(cell as usize).into_iter().zip(weights.at(k)) {
            let level = match neighbor {
                Neighbor::Mirror => continue,
                Neighbor::Limit => domain.levels().obstacle,
                Neighbor::Cell(next) => match place[next] {
                    Some(column) => {
                        band.add(k, column, -weight);
                        continue;
                    }
                    None => domain.fixed(domain.kinds()[next]).unwrap_or(domain.levels().free),
                },
            };
            band.right[k] += weight * level;
        }
    }
    let solution = band.solve()?;
    let mut values = domain.start();
    for (&cell, value) in unknowns.iter().zip(solution) {
        values[cell as usize] = value;
    }
    satisfies_equations(domain, &unknowns, &weights, &values).then_some(values)
}

/// Returns the unknown cells row by row. Rows come alternately from both ends.
fn unknowns_from_both_ends(domain: &Domain) -> Vec<u32> {
    let [rows, columns] = domain.cells();
    let row = |k: usize| if k.is_multiple_of(2) { k / 2 } else { rows - 1 - k / 2 };
    let cells = (0..rows).map(row).flat_map(|i| i * columns..(i + 1) * columns);
    cells.filter(|&cell| domain.is_unknown(cell)).map(|cell| cell as u32).collect()
}

/// Returns the greatest difference between the positions of two neighbours in the order of the unknowns.
fn reach(domain: &Domain, unknowns: &[u32], place: &[Option<usize>]) -> usize {
    let of = |(k, &cell): (usize, &u32)| {
        let places = domain.neighbors(cell as usize).into_iter().filter_map(|neighbor| match neighbor {
            Neighbor::Cell(next) => place[next],
            Neighbor::Limit | Neighbor::Mirror => None,
        });
        places.map(|other| k.abs_diff(other)).max().unwrap_or(0)
    };
    unknowns.iter().enumerate().map(of).max().unwrap_or(0)
}

/// Returns true if each value agrees with the value that its neighbours imply.
fn satisfies_equations(domain: &Domain, unknowns: &[u32], weights: &WeightedMean, values: &[f64]) -> bool {
    let greatest = values.iter().fold(0.0, |greatest: f64, value| greatest.max(value.abs()));
    greatest.is_finite()
        && unknowns.iter().enumerate().all(|(k, &cell)| {
            let own = values[cell as usize];
            let around = domain.neighbors(cell as usize).map(|neighbor| match neighbor {
                Neighbor::Cell(next) => values[next],
                Neighbor::Limit => domain.levels().obstacle,
                Neighbor::Mirror => own,
            });
            // NaN never agrees.
            (weights.target(k, own, around) - own).abs() <= MAX_RESIDUAL * greatest
        })
}

/// A banded system of equations. Equation `k` contains only the unknowns from `k - reach` to `k + reach`.
struct Band {
    reach: usize,
    /// Factors: `2 * reach + 1` for each equation, with the factor of its own unknown in the middle.
    factors: Vec<f64>,
    right: Vec<f64>,
}

impl Band {
    /// Allocates a band, or returns `None` if it is too large.
    fn new(reach: usize, equations: usize) -> Option<Self> {
        let size = equations.checked_mul(2 * reach + 1).filter(|&size| size <= MAX_BAND_NUMBERS)?;
        Some(Self { reach, factors: vec![0.0; size], right: vec![0.0; equations] })
    }

    fn index(&self, equation: usize, unknown: usize) -> usize {
        equation * (2 * self.reach + 1) + self.reach + unknown - equation
    }

    fn add(&mut self, equation: usize, unknown: usize, factor: f64) {
        let index = self.index(equation, unknown);
        self.factors[index] += factor;
    }

    /// Solves for the unknowns, or returns `None` if a pivot vanishes.
    fn solve(mut self) -> Option<Vec<f64>> {
        let n = self.right.len();
        for pivot in 0..n {
            checkpoint();
            let last = (pivot + self.reach).min(n - 1);
            let at = self.index(pivot, pivot);
            let length = last - pivot;
            if self.factors[at] == 0.0 {
                return None;
            }
            for equation in pivot + 1..=last {
                let here = self.index(equation, pivot);
                let (above, below) = self.factors.split_at_mut(here);
                if below[0] == 0.0 {
                    continue;
                }
                let share = below[0] / above[at];
                let source = &above[at + 1..=at + length];
                below[1..=length].iter_mut().zip(source).for_each(|(factor, source)| *factor -= share * source);
                self.right[equation] -= share * self.right[pivot];
            }
        }
        for equation in (0..n).rev() {
            let at = self.index(equation, equation);
            let length = self.reach.min(n - 1 - equation);
            let later = self.factors[at + 1..=at + length].iter().zip(&self.right[equation + 1..]);
            let known: f64 = later.map(|(factor, value)| factor * value).sum();
            self.right[equation] = (self.right[equation] - known) / self.factors[at];
        }
        Some(self.right)
    }
}
