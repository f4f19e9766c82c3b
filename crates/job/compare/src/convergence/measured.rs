//! Measures the convergence of relaxations.

use super::{Convergence, ParameterScan, Point, RelaxationRun};
use cplan_fields::{
    Cell, Difference, Direction, Domain, Ending, Equation, Factor, Lines, Order, RelaxError, Relaxation, Scan,
    Stopping, eliminated, relax, trace,
};

/// Domain, equations and settings of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup<'a> {
    /// Title of the domain.
    pub title: String,
    /// The domain of the equations.
    pub domain: &'a Domain,
    /// The equations, with their names.
    pub equations: Vec<(String, Equation)>,
    /// Direction of the drift, in grid coordinates, for the scans over its strength.
    pub direction: Direction,
    /// Order of cells in the scans.
    pub order: Order,
    /// Rule by which a relaxation ends.
    pub stopping: Stopping,
}

/// Factor of weighted Jacobi. 0.8 is usual for smoothers in two dimensions.
const JACOBI_WEIGHT: f64 = 0.8;

/// Returns the relaxations whose error is measured after each sweep.
fn relaxations() -> Vec<Relaxation> {
    let orders = [Order::Lines(Scan::ROWS), Order::Corners(Lines::Rows), Order::RedBlack];
    let at_once = [Relaxation::JACOBI, Relaxation::weighted_jacobi(JACOBI_WEIGHT)];
    let gauss_seidel = orders.map(Relaxation::gauss_seidel);
    let sor = orders.map(|order| sor(Factor::Formula, order));
    at_once.into_iter().chain(gauss_seidel).chain(sor).collect()
}

/// Returns over-relaxation as the planner uses it.
fn sor(factor: Factor, order: Order) -> Relaxation {
    Relaxation::sor(factor, order).guarded()
}

/// Returns the factors of SOR in the scan: from 1 in steps of 0.05, near 2 in steps of 0.01.
fn factors() -> Vec<f64> {
    (20..39).map(|k| f64::from(k) / 20.0).chain((95..100).map(|k| 1.0 + f64::from(k) / 100.0)).collect()
}

/// Iterates over the factors of weighted Jacobi in the scan, in steps of 0.05. The scan begins at 0.5, because smaller factors
/// are only slower.
fn weights() -> impl Iterator<Item = f64> {
    (10..40).map(|k| f64::from(k) / 20.0)
}

/// Returns the strengths of the drift in the scan: from 0 to 6, in steps of 0.2.
fn strengths() -> Vec<f64> {
    (0..=30).map(|k| f64::from(k) / 5.0).collect()
}

/// Relaxes each equation by Jacobi, weighted Jacobi, Gauss-Seidel and SOR in each order, and measures the error after each sweep.
/// Then scans the factors of SOR and of weighted Jacobi for each equation, and, by Gauss-Seidel with either discretisation, the
/// strength of the drift. Runs some hundred relaxations, and one elimination for the exact solution of each equation.
///
/// # Errors
/// [`RelaxError::Refused`] if an equation does not fit the domain. Divergence is a result, not an error.
pub fn convergence(setup: &Setup, progress: &mut dyn FnMut(&str)) -> Result<Convergence, RelaxError> {
    let Setup { domain, direction, order, stopping, .. } = setup;
    let mut runs = Vec::new();
    let (mut factor_scans, mut weight_scans) = (Vec::new(), Vec::new());
    for (name, equation) in &setup.equations {
        progress(&format!("{name}: relaxations"));
        let exact = eliminated(domain, equation);
        let mut rate = None;
        for relaxation in relaxations() {
            let trace = trace(domain, equation, &relaxation, stopping, domain.start(), exact.as_deref())?;
            if relaxation == Relaxation::JACOBI {
                rate = trace.rate();
            }
            runs.push(RelaxationRun { equation: name.clone(), relaxation, trace });
        }
        progress(&format!("{name}: factors of SOR"));
        let at = |factor: f64| {
            let relaxation = sor(Factor::Given(factor), *order);
            point(factor, domain, equation, &relaxation, stopping)
        };
        factor_scans.push(ParameterScan {
            formula: Some(at(Factor::Formula.value(domain.cells()))?),
            by_rate: rate.filter(|_| equation.is_monotone()).and_then(best_factor).map(at).transpose()?,
            ..ParameterScan::new(name.clone(), factors().into_iter().map(at).collect::<Result<_, _>>()?)
        });
        progress(&format!("{name}: factors of weighted Jacobi"));
        weight_scans.push(weight_scan(name, domain, equation, stopping)?);
    }
    let scan = |difference: Difference| {
        let at = |epsilon: f64| {
            let equation = Equation::Oriented { direction: *direction, epsilon, difference };
            point(epsilon, domain, &equation, &Relaxation::gauss_seidel(*order), stopping)
        };
        let name = format!("oriented, {}", if difference == Difference::Central { "central" } else { "upwind" });
        let points = strengths().into_iter().map(at).collect::<Result<_, _>>()?;
        Ok((difference, ParameterScan::new(name, points)))
    };
    progress("strengths of the drift");
    Ok(Convergence {
        title: setup.title.clone(),
        cells: domain.cells(),
        free: domain.kinds().iter().filter(|&&kind| kind == Cell::Free).count(),
        stopping: *stopping,
        order: *order,
        runs,
        factors: factor_scans,
        weights: weight_scans,
        direction: direction.components(),
        strengths: [Difference::Central, Difference::Upwind].into_iter().map(scan).collect::<Result<_, _>>()?,
    })
}

/// Relaxes with increasing factors of weighted Jacobi, up to the first factor of at least 1 that does not converge. Below 1, a
/// relaxation that does not converge may only be slow.
fn weight_scan(
    name: &str,
    domain: &Domain,
    equation: &Equation,
    stopping: &Stopping,
) -> Result<ParameterScan, RelaxError> {
    let mut points: Vec<Point> = Vec::new();
    for factor in weights() {
        let point = point(factor, domain, equation, &Relaxation::weighted_jacobi(factor), stopping)?;
        points.push(point);
        if factor >= 1.0 && point.converged().is_none() {
            break;
        }
    }
    Ok(ParameterScan::new(name.to_owned(), points))
}

/// Returns the best factor of SOR by Young's formula for Jacobi's rate of convergence. `None` unless the rate is below 1.
fn best_factor(rate: f64) -> Option<f64> {
    (rate < 1.0).then(|| 2.0 / (1.0 + (1.0 - rate * rate).sqrt()))
}

fn point(
    at: f64,
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
) -> Result<Point, RelaxError> {
    Ok(match relax(domain, equation, relaxation, stopping) {
        Ok(field) => {
            let ending = if field.converged() { Ending::Converged } else { Ending::Unconverged };
            Point { at, sweeps: field.sweeps(), ending }
        }
        Err(RelaxError::Diverged { sweeps, .. }) => Point { at, sweeps, ending: Ending::Diverged },
        Err(refused) => return Err(refused),
    })
}
