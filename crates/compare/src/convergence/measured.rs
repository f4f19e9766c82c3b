//! The measuring.

use super::{Convergence, Course, FactorScan, Point, StrengthScan, WeightScan};
use cplan_fields::{
    Cell, Difference, Direction, Domain, Ending, Equation, Factor, Lines, Order, RelaxError, Relaxation, Scan,
    Stopping, eliminated, relax, trace,
};

/// The setup of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup<'a> {
    /// Title of the domain.
    pub title: String,
    /// The domain of the equations.
    pub domain: &'a Domain,
    /// Names and equations.
    pub equations: Vec<(String, Equation)>,
    /// The direction of the drift in the scans over its strength, in cells.
    pub direction: Direction,
    /// Order of cells in the scans.
    pub order: Order,
    /// When relaxations end.
    pub stopping: Stopping,
}

/// The factor of weighted Jacobi: the usual choice of smoothers in the plane.
const JACOBI_WEIGHT: f64 = 0.8;

/// Returns the traced relaxations.
fn relaxations() -> Vec<Relaxation> {
    let orders = [Order::Lines(Scan::ROWS), Order::Corners(Lines::Rows), Order::RedBlack];
    let at_once = [Relaxation::JACOBI, Relaxation::weighted_jacobi(JACOBI_WEIGHT)];
    let gauss_seidel = orders.map(Relaxation::gauss_seidel);
    let sor = orders.map(|order| Relaxation::sor(Factor::Formula, order));
    at_once.into_iter().chain(gauss_seidel).chain(sor).collect()
}

/// Factors of the scan: by twentieths, and by hundredths near 2.
fn factors() -> Vec<f64> {
    (20..39).map(|k| f64::from(k) / 20.0).chain((95..100).map(|k| 1.0 + f64::from(k) / 100.0)).collect()
}

/// Factors of weighted Jacobi in the scan, by twentieths; lesser ones only take longer.
fn weights() -> impl Iterator<Item = f64> {
    (10..40).map(|k| f64::from(k) / 20.0)
}

/// Strengths of the scan, by fifths.
fn strengths() -> Vec<f64> {
    (0..=30).map(|k| f64::from(k) / 5.0).collect()
}

/// Relaxes each equation by Jacobi, weighted Jacobi, Gauss-Seidel and SOR in each order, and measures the error after
/// each sweep. Then scans the factors of SOR and of weighted Jacobi for each equation, and the strength of the drift by
/// Gauss-Seidel with either discretisation. Reports each part to `progress`. Runs some hundred relaxations, and an
/// elimination for each equation.
///
/// # Errors
/// [`RelaxError::Refused`] if an equation does not fit the domain. Divergence is a result, not an error.
pub fn convergence(setup: &Setup, progress: &mut dyn FnMut(&str)) -> Result<Convergence, RelaxError> {
    let Setup { domain, direction, order, stopping, .. } = setup;
    let mut courses = Vec::new();
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
            courses.push(Course { equation: name.clone(), relaxation, trace });
        }
        progress(&format!("{name}: factors of SOR"));
        let at = |factor: f64| {
            let relaxation = Relaxation::sor(Factor::Given(factor), *order);
            point(factor, domain, equation, &relaxation, stopping)
        };
        factor_scans.push(FactorScan {
            equation: name.clone(),
            formula: at(Factor::Formula.value(domain.cells()))?,
            by_rate: rate.filter(|_| equation.is_monotone()).and_then(best_factor).map(at).transpose()?,
            points: factors().into_iter().map(at).collect::<Result<_, _>>()?,
        });
        progress(&format!("{name}: factors of weighted Jacobi"));
        weight_scans.push(weight_scan(name, domain, equation, stopping)?);
    }
    let scan = |difference: Difference| {
        let at = |epsilon: f64| {
            let equation = Equation::Oriented { direction: *direction, epsilon, difference };
            point(epsilon, domain, &equation, &Relaxation::gauss_seidel(*order), stopping)
        };
        let points = strengths().into_iter().map(at).collect::<Result<_, _>>()?;
        Ok(StrengthScan { difference, points })
    };
    progress("strengths of the drift");
    Ok(Convergence {
        title: setup.title.clone(),
        cells: domain.cells(),
        free: domain.kinds().iter().filter(|&&kind| kind == Cell::Free).count(),
        stopping: *stopping,
        order: *order,
        courses,
        factors: factor_scans,
        weights: weight_scans,
        direction: direction.components(),
        strengths: [Difference::Central, Difference::Upwind].into_iter().map(scan).collect::<Result<_, _>>()?,
    })
}

/// Relaxes with one factor of weighted Jacobi after the other, until one from 1 on does not converge; lesser ones may just be slow.
fn weight_scan(
    name: &str,
    domain: &Domain,
    equation: &Equation,
    stopping: &Stopping,
) -> Result<WeightScan, RelaxError> {
    let mut points: Vec<Point> = Vec::new();
    for factor in weights() {
        let point = point(factor, domain, equation, &Relaxation::weighted_jacobi(factor), stopping)?;
        points.push(point);
        if factor >= 1.0 && point.converged().is_none() {
            break;
        }
    }
    Ok(WeightScan { equation: name.to_owned(), points })
}

/// Returns Young's best factor for the rate of Jacobi.
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
