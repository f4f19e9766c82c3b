//! A plain relaxation with every choice that the source of Tables 17 to 19 leaves open. It shares no code with the library.

use cplan::field::{Cell, Domain};
use std::f64::consts::PI;
use std::fmt;

/// Treatment of values above 1, which over-relaxation produces. The source does not state it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beyond {
    /// The value stays.
    Kept,
    /// The value becomes 1. A value below 0 becomes 0 in the same way.
    Clamped,
    /// The value becomes this number below 1, perhaps so that free cells are not mistaken for obstacles.
    Reset(f64),
}

/// The quantity that must fall below the tolerance. `change` is the change of a cell in a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// The sum of `|change|`.
    SumOfChanges,
    /// `|sum of change|`: the change of the sum of all values.
    ChangeOfSum,
    /// Difference between the sum of `|change|` and that of the previous sweep: the rule in the text.
    DifferenceOfSums,
    /// The sum of `change^2`.
    SumOfSquares,
    /// The greatest `|change|`.
    GreatestChange,
}

/// An interpretation of the source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// True if values are stored as `f32`.
    pub single: bool,
    /// Treatment of values above 1.
    pub beyond: Beyond,
    /// The rule by which the relaxation ends.
    pub rule: Rule,
    /// The relaxation ends when the rule's quantity is below this.
    pub tolerance: f64,
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rule = match self.rule {
            Rule::SumOfChanges => "sum of |change|",
            Rule::ChangeOfSum => "|sum of change|",
            Rule::DifferenceOfSums => "difference of sums",
            Rule::SumOfSquares => "sum of change^2",
            Rule::GreatestChange => "greatest |change|",
        };
        write!(f, "{}, {rule} < {:e}", if self.single { "floats" } else { "doubles" }, self.tolerance)?;
        match self.beyond {
            Beyond::Kept => Ok(()),
            Beyond::Clamped => write!(f, ", clamped to 0..1"),
            Beyond::Reset(value) => write!(f, ", above 1 becomes {value}"),
        }
    }
}

/// A field during its relaxation, on `n x n` cells. The outermost cells are walls.
#[derive(Clone)]
pub struct Plain<'a> {
    n: usize,
    domain: &'a Domain,
    values: Vec<f64>,
}

/// Largest number of sweeps of a relaxation: of Gauss-Seidel, and of over-relaxation.
const MOST: [usize; 2] = [30_000, 1_500];

impl<'a> Plain<'a> {
    /// Creates the initial field: obstacles are 1, goals and free cells 0.
    pub fn new(domain: &'a Domain) -> Self {
        let values = domain.kinds().iter().map(|&kind| if kind == Cell::Obstacle { 1.0 } else { 0.0 });
        Self { n: domain.cells()[0], domain, values: values.collect() }
    }

    /// Relaxes until the rule is satisfied, and returns the number of sweeps. `None` if that takes too many. `of` is one of the
    /// four relaxations of the tables. `drift` returns the term to add to a cell's value, given the cell and its neighbours'
    /// values in the order `-x, +x, -y, +y`.
    pub fn relax(&mut self, of: usize, choice: &Choice, drift: impl Fn(usize, [f64; 4]) -> f64) -> Option<usize> {
        let n = self.n;
        let over = of >= 2;
        let factor = if over { best_factor(n) } else { 1.0 };
        let mut before = f64::INFINITY;
        for sweep in 0..MOST[usize::from(over)] {
            // Sweeps begin at each corner in turn, or always at the first one.
            let corner = if of.is_multiple_of(2) { 0 } else { sweep % 4 };
            let [mut sum, mut signed, mut squares, mut greatest] = [0.0_f64; 4];
            for a in 1..n - 1 {
                for b in 1..n - 1 {
                    let x = if corner >= 2 { n - 1 - a } else { a };
                    let y = if corner % 2 == 1 { n - 1 - b } else { b };
                    let cell = x * n + y;
                    if self.domain.kinds()[cell] != Cell::Free {
                        continue;
                    }
                    let v = &self.values;
                    let around = [v[cell - n], v[cell + n], v[cell - 1], v[cell + 1]];
                    let old = v[cell];
                    let mean = 0.25 * ((around[0] + around[1]) + (around[2] + around[3]));
                    let mut new = if over { old + factor * (mean - old) } else { mean } + drift(cell, around);
                    match choice.beyond {
                        Beyond::Kept => {}
                        Beyond::Clamped => new = new.clamp(0.0, 1.0),
                        Beyond::Reset(value) => new = if new > 1.0 { value } else { new },
                    }
                    if choice.single {
                        new = f64::from(new as f32);
                    }
                    self.values[cell] = new;
                    let change = new - old;
                    sum += change.abs();
                    signed += change;
                    squares += change * change;
                    greatest = greatest.max(change.abs());
                }
            }
            let measure = match choice.rule {
                Rule::SumOfChanges => sum,
                Rule::ChangeOfSum => signed.abs(),
                Rule::DifferenceOfSums => (sum - before).abs(),
                Rule::SumOfSquares => squares,
                Rule::GreatestChange => greatest,
            };
            before = sum;
            if measure < choice.tolerance {
                return Some(sweep + 1);
            }
        }
        None
    }

    /// Returns the direction in which each cell's value rises, by central differences.
    pub fn directions(&self) -> Vec<[f64; 2]> {
        let (n, v) = (self.n, &self.values);
        let at = |cell: usize| {
            if self.domain.kinds()[cell] != Cell::Free {
                return [0.0; 2];
            }
            let [x, y] = [v[cell + n] - v[cell - n], v[cell + 1] - v[cell - 1]];
            let length = x.hypot(y);
            if length > 0.0 { [x / length, y / length] } else { [0.0; 2] }
        };
        (0..n * n).map(at).collect()
    }
}

/// Returns the factor of over-relaxation by the formula of the source's text, for `n` rows and columns.
fn best_factor(n: usize) -> f64 {
    let c = 2.0 * (PI / n as f64).cos();
    4.0 / (2.0 + (4.0 - c * c).sqrt())
}
