//! The stages of each equation, whatever relaxes them.

use super::sweeps::{normalized_gradient, strengths};
use super::{Difference, Domain, Equation, RelaxError};

/// What can relax a stage. Each begins with the values that the last one ended with.
pub(super) trait Stages {
    /// The equation without a drift.
    fn harmonic(&mut self) -> Result<(), RelaxError>;

    /// A linear equation, of a drift in each cell.
    fn linear(&mut self, drift: impl Fn(usize) -> [f64; 2], difference: Difference) -> Result<(), RelaxError>;

    /// Altered preferences, of a strength in each cell.
    fn altered(&mut self, strengths: Vec<f64>) -> Result<(), RelaxError>;

    /// The values so far, one a cell at least.
    fn values(&self) -> &[f64];
}

/// All stages of an equation: preferences begin with the harmonic field.
pub(super) fn in_stages(equation: &Equation, domain: &Domain, on: &mut impl Stages) -> Result<(), RelaxError> {
    match equation {
        Equation::Harmonic => on.harmonic(),
        Equation::Oriented { direction, epsilon, difference } => {
            let drift = direction.drift(*epsilon);
            on.linear(|_| drift, *difference)
        }
        Equation::LocallyOriented { drift, difference } => on.linear(|cell| drift[cell], *difference),
        Equation::Preference { epsilon, difference } => {
            on.harmonic()?;
            let direction = normalized_gradient(domain, on.values());
            on.linear(|cell| direction[cell].map(|v| epsilon[cell] * v), *difference)
        }
        Equation::AlteredPreference { epsilon } => {
            on.harmonic()?;
            on.altered(strengths(domain, epsilon))
        }
    }
}
