//! The order of updates and the relaxation factor.

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::fmt;

/// A relaxation. In each sweep, the value of every free cell moves towards the value that its neighbours imply.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Relaxation {
    /// Order of the updates, and the relaxation factor.
    pub scheme: Scheme,
    /// Range to which new values are clamped; `None` for no limits. Initially, over-relaxation leaves the range of the fixed
    /// values.
    pub clamp: Option<[f64; 2]>,
    /// Precision in which new values are stored.
    pub precision: Precision,
    /// True if over-relaxation must not leave the range of the fixed values; see [`Relaxation::guarded`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub guarded: bool,
    /// True if over-relaxation multiplies preferences by its factor, too; see [`Relaxation::relaxing_preferences`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub relaxes_preferences: bool,
}

/// Precision in which values are stored between updates. Updates are computed in doubles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// Double precision.
    #[default]
    Double,
    /// Single precision, as in programs that store a `float`. A change of less than half a unit in the last place has no effect,
    /// so relaxations come to rest earlier.
    Single,
}

/// Order of the updates, and the relaxation factor. A cell's new value is `old + factor * (implied - old)`, where
/// `implied` is the value that its neighbours imply.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// All cells are updated at once from the values of the previous sweep (Jacobi; weighted if the factor is not 1).
    Simultaneous {
        /// Relaxation factor: 1 for Jacobi's method, between 0 and 1 for weighted Jacobi.
        factor: f64,
    },
    /// Cells are updated one after the other, each from the newest values.
    Successive {
        /// Relaxation factor: 1 for Gauss-Seidel; other factors give successive over-relaxation (SOR).
        factor: Factor,
        /// The order of cells.
        order: Order,
    },
}

/// Relaxation factor of a successive relaxation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Factor {
    /// This factor.
    Given(f64),
    /// `4 / (2 + sqrt(4 - c^2))` with `c = cos(pi / m) + cos(pi / n)` for `m x n` cells. This is the best factor for Laplace's
    /// equation in an empty rectangle of `m` by `n` steps (Young 1954). If limits are one cell beyond the first and the last
    /// cell, there is one more step along each axis, so the factor is slightly less than the best. This matters only if there are
    /// few cells.
    Formula,
}

impl Factor {
    /// Returns the factor for a domain of this many cells.
    pub fn value(self, cells: [usize; 2]) -> f64 {
        match self {
            Self::Given(factor) => factor,
            Self::Formula => {
                // A domain of one cell has c = -2, and needs no over-relaxation.
                let c = cells.map(|n| (PI / n as f64).cos()).iter().sum::<f64>().max(0.0);
                4.0 / (2.0 + (4.0 - c * c).max(0.0).sqrt())
            }
        }
    }
}

/// The order in which cells are updated. Every cell is updated once per sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// Line by line, the same in every sweep.
    Lines(Scan),
    /// Line by line, in each sweep from another corner: `(0, 0)`, then the end of the first line, the beginning of the last line,
    /// and the end of the last line. Deicu 2012 calls this order "simultaneous", and also counts single sweeps.
    Corners(Lines),
    /// First all cells whose two indices have an even sum, then the others. On circles of odd length, neighbours across the seam
    /// have the same colour, and one is updated after the other.
    RedBlack,
    /// Four classes of cells, one after the other: row and column even, only the row even, only the column even, both odd. No two
    /// cells of a class share a side or a corner.
    FourColors,
}

/// The direction of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Lines {
    /// Each line has one value of the first joint.
    #[default]
    Rows,
    /// Each line has one value of the second joint.
    Columns,
}

/// An order of all cells, line by line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scan {
    /// Direction of the lines; the cells of a line follow one another.
    pub lines: Lines,
    /// True for each axis along which the index decreases.
    pub falling: [bool; 2],
}

impl Scan {
    /// Row by row, with rising indices.
    pub const ROWS: Self = Self { lines: Lines::Rows, falling: [false; 2] };
}

impl Relaxation {
    /// Jacobi's relaxation: all cells take the implied values at once.
    pub const JACOBI: Self = Self::weighted_jacobi(1.0);

    /// Returns weighted Jacobi relaxation.
    pub const fn weighted_jacobi(factor: f64) -> Self {
        Self::of(Scheme::Simultaneous { factor })
    }

    /// Returns Gauss-Seidel relaxation with this order.
    pub const fn gauss_seidel(order: Order) -> Self {
        Self::sor(Factor::Given(1.0), order)
    }

    /// Returns successive over-relaxation with this factor and order.
    pub const fn sor(factor: Factor, order: Order) -> Self {
        Self::of(Scheme::Successive { factor, order })
    }

    const fn of(scheme: Scheme) -> Self {
        Self { scheme, clamp: None, precision: Precision::Double, guarded: false, relaxes_preferences: false }
    }

    /// Clamps new values to a range.
    #[must_use]
    pub const fn clamped(self, range: [f64; 2]) -> Self {
        Self { clamp: Some(range), ..self }
    }

    /// Stores new values in another precision.
    #[must_use]
    pub const fn with_precision(self, precision: Precision) -> Self {
        Self { precision, ..self }
    }

    /// Adapts the relaxation, on the CPU, to values that span many orders of magnitude.
    ///
    /// Over-relaxation carries the rounding errors of large values to cells with smaller values, where signs change and relative
    /// changes never settle. Therefore:
    ///
    /// - A cell that would leave the range between the obstacles' and the goals' value takes the value that its neighbours imply,
    ///   without the factor. With monotone equations, no value then leaves the range of the fixed values. Relaxations with a
    ///   factor of 2 or more never converge, and have no guard, so that they visibly diverge.
    /// - With [`Measure::GreatestRelativeChange`](super::Measure), the factor becomes 1 when no value changes by more than
    ///   `1e-13` of the difference between the obstacles' and the goals' value. The rest is relaxed by Gauss-Seidel sweeps, which
    ///   keep relative errors small.
    #[must_use]
    pub const fn guarded(self) -> Self {
        Self { guarded: true, ..self }
    }

    /// Multiplies preferences by the factor of over-relaxation, like the mean of the neighbours.
    ///
    /// By default, over-relaxation by a factor `w` adds the term of preferences without `w`, as Deicu 2012 prints it (tables 10,
    /// 11, 14 and 15): `p + w (h - p) + epsilon d / 8` for [`Preference`](super::Equation::Preference), where `h` is the mean of
    /// the four neighbours. Its limit satisfies the equation with `epsilon / w`. With the factor, the limit satisfies the
    /// equation with `epsilon`, as with Gauss-Seidel, but altered preferences often do not converge.
    #[must_use]
    pub const fn relaxing_preferences(self) -> Self {
        Self { relaxes_preferences: true, ..self }
    }

    /// Returns the share of `epsilon` with which the limit satisfies the equation of preferences, on a domain of this many cells.
    pub fn preference_share(&self, cells: [usize; 2]) -> f64 {
        let is_successive = matches!(self.scheme, Scheme::Successive { .. });
        if is_successive && !self.relaxes_preferences { 1.0 / self.factor(cells).max(1.0) } else { 1.0 }
    }

    /// Returns the factor on a domain of this many cells.
    pub fn factor(&self, cells: [usize; 2]) -> f64 {
        match self.scheme {
            Scheme::Simultaneous { factor } => factor,
            Scheme::Successive { factor, .. } => factor.value(cells),
        }
    }
}

impl Relaxation {
    /// Returns the reason why the relaxation is invalid on a grid. `None` if it is valid.
    pub fn refusal(&self, cells: [usize; 2]) -> Option<String> {
        let factor = self.factor(cells);
        if !(factor.is_finite() && factor > 0.0) {
            return Some(format!("the relaxation factor is {factor}, but must be positive"));
        }
        let [low, high] = self.clamp.filter(|[low, high]| low > high || low.is_nan() || high.is_nan())?;
        Some(format!("the range {low}..{high} for values is empty"))
    }
}

impl fmt::Display for Relaxation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.scheme {
            Scheme::Simultaneous { factor: 1.0 } => write!(f, "jacobi")?,
            Scheme::Simultaneous { factor } => write!(f, "weighted-jacobi, factor {factor}")?,
            Scheme::Successive { factor: Factor::Given(1.0), order } => write!(f, "gauss-seidel, {order}")?,
            Scheme::Successive { factor: Factor::Given(factor), order } => write!(f, "sor, {order}, factor {factor}")?,
            Scheme::Successive { factor: Factor::Formula, order } => write!(f, "sor, {order}")?,
        }
        if self.relaxes_preferences {
            f.write_str(", also of preferences")?;
        }
        if let Some([low, high]) = self.clamp {
            write!(f, ", clamped to {low}..{high}")?;
        }
        f.write_str(if self.precision == Precision::Single { ", single precision" } else { "" })
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lines(Scan { lines: Lines::Rows, .. }) => "rows",
            Self::Lines(Scan { lines: Lines::Columns, .. }) => "columns",
            Self::Corners(_) => "corners",
            Self::RedBlack => "red-black",
            Self::FourColors => "four-color",
        })
    }
}

impl Order {
    /// Returns the order of the `unknowns` (ascending indices of cells) in each sweep, as positions in that list. After its last
    /// entry, the result repeats.
    pub(super) fn passes(self, cells: [usize; 2], unknowns: &[u32]) -> Vec<Vec<u32>> {
        let sorted = |key: &dyn Fn([usize; 2]) -> [usize; 2]| {
            let mut positions: Vec<u32> = (0..unknowns.len() as u32).collect();
            let at = |k: u32| {
                [0, 1].map(|axis| {
                    let cell = unknowns[k as usize] as usize;
                    if axis == 0 { cell / cells[1] } else { cell % cells[1] }
                })
            };
            // The sort is stable, so cells with the same key keep their order.
            positions.sort_by_key(|&k| key(at(k)));
            positions
        };
        let scan = |Scan { lines, falling }: Scan| {
            sorted(&|at| {
                let [i, j] = [0, 1].map(|axis| if falling[axis] { cells[axis] - at[axis] } else { at[axis] });
                if lines == Lines::Rows { [i, j] } else { [j, i] }
            })
        };
        match self {
            // Sorting would take as long as several sweeps, which is more than a field needs after a small change.
            Self::Lines(Scan::ROWS) => vec![(0..unknowns.len() as u32).collect()],
            Self::Lines(lines) => vec![scan(lines)],
            Self::Corners(lines) => {
                let [across, along] = if lines == Lines::Rows { [0, 1] } else { [1, 0] };
                let corners = [[false, false], [false, true], [true, false], [true, true]];
                let from = corners.map(|[last_line, end]| {
                    let mut falling = [false; 2];
                    (falling[across], falling[along]) = (last_line, end);
                    scan(Scan { lines, falling })
                });
                from.into()
            }
            Self::RedBlack => vec![sorted(&|[i, j]| [(i + j) % 2, 0])],
            Self::FourColors => vec![sorted(&|[i, j]| [i % 2, j % 2])],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the cells of a 2 x 3 domain in the order of each sweep.
    fn passes_of(order: Order) -> Vec<Vec<u32>> {
        order.passes([2, 3], &[0, 1, 2, 3, 4, 5])
    }

    #[test]
    fn sweep_orders_match_their_names() {
        assert_eq!(passes_of(Order::Lines(Scan::ROWS)), [[0, 1, 2, 3, 4, 5]]);
        assert_eq!(passes_of(Order::Lines(Scan { lines: Lines::Rows, falling: [true, false] })), [[3, 4, 5, 0, 1, 2]]);
        assert_eq!(passes_of(Order::Lines(Scan { lines: Lines::Columns, falling: [false; 2] })), [[0, 3, 1, 4, 2, 5]]);
        assert_eq!(
            passes_of(Order::Corners(Lines::Rows)),
            [[0, 1, 2, 3, 4, 5], [2, 1, 0, 5, 4, 3], [3, 4, 5, 0, 1, 2], [5, 4, 3, 2, 1, 0]]
        );
        assert_eq!(
            passes_of(Order::Corners(Lines::Columns)),
            [[0, 3, 1, 4, 2, 5], [3, 0, 4, 1, 5, 2], [2, 5, 1, 4, 0, 3], [5, 2, 4, 1, 3, 0]]
        );
        assert_eq!(passes_of(Order::RedBlack), [[0, 2, 4, 1, 3, 5]]);
        assert_eq!(passes_of(Order::FourColors), [[0, 2, 1, 3, 5, 4]]);
    }

    #[test]
    fn sweeps_skip_fixed_cells() {
        assert_eq!(Order::Corners(Lines::Rows).passes([2, 3], &[1, 5])[3], [1, 0]);
        assert_eq!(Order::RedBlack.passes([2, 3], &[1, 2]), [[1, 0]]);
    }

    #[test]
    fn the_formula_gives_the_best_factor_of_a_square() {
        // With m = n: 2 / (1 + sin(pi / n)).
        for n in [3, 10, 100] {
            let best = 2.0 / (1.0 + (PI / n as f64).sin());
            assert!((Factor::Formula.value([n, n]) - best).abs() < 1e-12);
        }
        assert_eq!(Factor::Formula.value([1, 1]), 1.0);
    }
}
