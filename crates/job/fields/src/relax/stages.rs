//! The stages in which each equation is relaxed, on any device.

use super::sweeps::{normalized_gradient, strengths};
use super::{Difference, Domain, Equation, RelaxError, Relaxation};

/// A device that relaxes the stages of an equation. Each stage starts with the final values of the previous one.
pub(super) trait Stages {
    /// Relaxes the equation without a drift.
    fn harmonic(&mut self) -> Result<(), RelaxError>;

    /// Relaxes a linear equation with a drift in each cell.
    fn linear(&mut self, drift: impl Fn(usize) -> [f64; 2], difference: Difference) -> Result<(), RelaxError>;

    /// Relaxes altered preferences with a strength in each cell.
    fn altered(&mut self, strengths: Vec<f64>) -> Result<(), RelaxError>;

    /// Returns the current values, at least one per cell.
    fn values(&self) -> &[f64];
}

/// Runs all stages of an equation: preferences start with the harmonic field.
///
/// If over-relaxation by a factor `w` adds a preference without `w`, it is over-relaxation of the equation with `epsilon / w`:
/// `p + w (h - p) + epsilon d = p + w (h + epsilon / w d - p)`.
pub(super) fn relax_in_stages(
    equation: &Equation,
    domain: &Domain,
    relaxation: &Relaxation,
    on: &mut impl Stages,
) -> Result<(), RelaxError> {
    let share = relaxation.preference_share(domain.cells());
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
            on.linear(|cell| direction[cell].map(|v| share * epsilon[cell] * v), *difference)
        }
        Equation::AlteredPreference { epsilon } => {
            on.harmonic()?;
            on.altered(strengths(domain, share, epsilon))
        }
    }
}
