//! Convergence of relaxations: error against sweeps for each equation, relaxation and order; sweeps against the factor
//! of SOR and against the strength of a drift.
//!
//! ```text
//! Setup (a domain and equations on it) -> convergence -> Convergence -> table, CSV, JSON
//!                                                                  \-> charts (SVG) -> page
//! ```
//!
//! Measurements come from [`cplan_fields::trace()`], scans from [`cplan_fields::relax()`]. All outputs are pure
//! functions of the [`Convergence`].

mod charts;
mod files;
mod lines;
mod measured;

pub use measured::{Setup, convergence};

use cplan_fields::{Difference, Ending, Order, Relaxation, Stopping, Trace};

/// Convergence of relaxations on one domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Convergence {
    /// Title of the domain.
    pub title: String,
    /// Rows and columns.
    pub cells: [usize; 2],
    /// Cells whose values are sought.
    pub free: usize,
    /// When relaxations end.
    pub stopping: Stopping,
    /// Order of cells in the scans.
    pub order: Order,
    /// Relaxation by relaxation, by equation.
    pub courses: Vec<Course>,
    /// Sweeps against the factor of SOR, an equation each.
    pub factors: Vec<FactorScan>,
    /// Sweeps against the factor of weighted Jacobi, an equation each.
    pub weights: Vec<WeightScan>,
    /// The direction of the drift in the scans over its strength, in cells; a vector of length 1.
    pub direction: [f64; 2],
    /// Sweeps of Gauss-Seidel against the strength of the drift, a discretisation each.
    pub strengths: Vec<StrengthScan>,
}

/// A relaxation of an equation, from its start to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// The name of the equation.
    pub equation: String,
    /// The relaxation.
    pub relaxation: Relaxation,
    /// Its measurements.
    pub trace: Trace,
}

/// Sweeps against the factor of SOR.
#[derive(Debug, Clone, PartialEq)]
pub struct FactorScan {
    /// The name of the equation.
    pub equation: String,
    /// The result at `4 / (2 + sqrt(4 - c^2))`, the best factor for Laplace's equation in an empty rectangle of this
    /// many cells.
    pub formula: Point,
    /// The result at `2 / (1 + sqrt(1 - r^2))`, where `r` is the measured rate of Jacobi relaxation on this domain. For
    /// consistent orders, such as rows and red-black, this is the best factor if all eigenvalues are real (Young 1954).
    /// `None` if `r` is unknown or not below 1, or the equation is not monotone.
    pub by_rate: Option<Point>,
    /// Factors of the scan, rising.
    pub points: Vec<Point>,
}

/// Sweeps against the factor of weighted Jacobi, by twentieths up to the first factor from 1 on that does not converge. No greater
/// factor converges: of each eigenvalue `m` of Jacobi's relaxation a sweep makes `1 - w (1 - m)`, whose size is convex in `w` and 1 at 0.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightScan {
    /// The name of the equation.
    pub equation: String,
    /// Factors of the scan, rising.
    pub points: Vec<Point>,
}

/// Sweeps against the strength of the drift, `epsilon` per cell.
#[derive(Debug, Clone, PartialEq)]
pub struct StrengthScan {
    /// Discretisation of the drift.
    pub difference: Difference,
    /// Strengths, rising.
    pub points: Vec<Point>,
}

/// A relaxation with one value of the varied parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The factor, or the strength.
    pub at: f64,
    /// Sweeps until it ended.
    pub sweeps: usize,
    /// Reason why it ended.
    pub ending: Ending,
}

impl Point {
    /// Sweeps that it took to converge, if it did.
    #[must_use]
    pub fn converged(&self) -> Option<usize> {
        (self.ending == Ending::Converged).then_some(self.sweeps)
    }
}

impl FactorScan {
    /// Returns the point of the scan, marked ones included, with the fewest sweeps; of several, the one with the least
    /// factor. Returns `None` if no relaxation converged.
    #[must_use]
    pub fn best(&self) -> Option<Point> {
        fewest(self.points.iter().chain([&self.formula]).chain(&self.by_rate))
    }
}

impl WeightScan {
    /// Returns the point with the fewest sweeps, and of several the one with the least factor, if any converged.
    #[must_use]
    pub fn best(&self) -> Option<Point> {
        fewest(self.points.iter())
    }

    /// Returns the least factor from which on no relaxation of the scan converged, unless the last one did.
    #[must_use]
    pub fn lost_from(&self) -> Option<Point> {
        lost_from(&self.points)
    }
}

/// Returns the first point after all converged ones.
fn lost_from(points: &[Point]) -> Option<Point> {
    let after = points.iter().rposition(|point| point.converged().is_some()).map_or(0, |last| last + 1);
    points.get(after).copied()
}

/// Returns the converged point with the fewest sweeps; of several, the first on the axis.
fn fewest<'a>(points: impl Iterator<Item = &'a Point>) -> Option<Point> {
    let converged = points.filter(|point| point.converged().is_some()).copied();
    converged.min_by(|a, b| a.sweeps.cmp(&b.sweeps).then(a.at.total_cmp(&b.at)))
}

impl StrengthScan {
    /// Returns the least strength from which no relaxation of the scan converged, or `None` if the last one did.
    #[must_use]
    pub fn lost_from(&self) -> Option<Point> {
        lost_from(&self.points)
    }
}
