//! Convergence of relaxations: the error against the number of sweeps, for each equation, relaxation and order. Also the number
//! of sweeps against the factor of SOR, and against the strength of a drift.
//!
//! ```text
//! Setup (a domain and equations on it) -> convergence -> Convergence -> table, CSV, JSON
//!                                                                  \-> charts -> page
//! ```
//!
//! Measurements come from [`cplan_fields::trace()`], scans from [`cplan_fields::relax()`]. All outputs are pure functions of the
//! [`Convergence`].

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
    /// Number of cells whose values are unknowns.
    pub free: usize,
    /// Rule by which a relaxation ends.
    pub stopping: Stopping,
    /// Order of cells in the scans.
    pub order: Order,
    /// All relaxations of the first equation, then those of the next one.
    pub runs: Vec<RelaxationRun>,
    /// For each equation, the number of sweeps as a function of the factor of SOR.
    pub factors: Vec<ParameterScan>,
    /// For each equation, the number of sweeps as a function of the factor of weighted Jacobi, in steps of 0.05. The scan ends at
    /// the first factor of at least 1 that does not converge, because no greater one does: for each eigenvalue `m` of Jacobi's
    /// relaxation, a sweep multiplies a part of the error by `1 - w (1 - m)`, whose absolute value is convex in the factor `w`,
    /// and 1 at `w = 0`.
    pub weights: Vec<ParameterScan>,
    /// Direction of the drift in the scans over its strength, in grid coordinates; a vector of length 1.
    pub direction: [f64; 2],
    /// For each discretisation of the drift, the number of sweeps of Gauss-Seidel as a function of the drift's strength,
    /// in `epsilon` per cell.
    pub strengths: Vec<(Difference, ParameterScan)>,
}

/// A relaxation of an equation, from its start to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct RelaxationRun {
    /// The name of the equation.
    pub equation: String,
    /// The relaxation.
    pub relaxation: Relaxation,
    /// Samples and ending of the relaxation.
    pub trace: Trace,
}

/// Numbers of sweeps for several values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterScan {
    /// The name of the equation.
    pub equation: String,
    /// Results for the values of the scan, in ascending order.
    pub points: Vec<Point>,
    /// The result for the factor `4 / (2 + sqrt(4 - c^2))`, which is the best for Laplace's equation in an empty rectangle of
    /// this many cells (for `c`, see [`cplan_fields::Factor::Formula`]). `None` unless the parameter is the factor of SOR.
    pub formula: Option<Point>,
    /// The result for the factor `2 / (1 + sqrt(1 - r^2))`, where `r` is the measured rate of Jacobi relaxation on this domain.
    /// For consistent orders, such as rows and red-black, this is the best factor if all eigenvalues are real (Young 1954).
    ///
    /// `None` if `r` is unknown or not below 1, if the equation is not monotone, or if the parameter is not the factor of SOR.
    pub by_rate: Option<Point>,
}

/// The result of a relaxation for one value of the varied parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The value of the parameter: a factor or a strength.
    pub at: f64,
    /// Number of sweeps until the relaxation ended.
    pub sweeps: usize,
    /// Reason why the relaxation ended.
    pub ending: Ending,
}

impl Point {
    /// Returns the number of sweeps if the relaxation converged.
    pub fn converged(&self) -> Option<usize> {
        (self.ending == Ending::Converged).then_some(self.sweeps)
    }
}

impl ParameterScan {
    fn new(equation: String, points: Vec<Point>) -> Self {
        Self { equation, points, formula: None, by_rate: None }
    }

    /// Returns all points: those of the scan, then `formula` and `by_rate`.
    fn all_points(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().chain(&self.formula).chain(&self.by_rate)
    }

    /// Returns the converged point with the fewest sweeps; of equal ones, that with the least value.
    pub fn best(&self) -> Option<Point> {
        let converged = self.all_points().filter(|point| point.converged().is_some()).copied();
        converged.min_by(|a, b| a.sweeps.cmp(&b.sweeps).then(a.at.total_cmp(&b.at)))
    }

    /// Returns the first point from which on no relaxation of the scan converges. `None` if the last one converges.
    pub fn divergence_start(&self) -> Option<Point> {
        let last = self.points.iter().rposition(|point| point.converged().is_some());
        self.points.get(last.map_or(0, |last| last + 1)).copied()
    }
}
