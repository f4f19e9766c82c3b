//! Relaxation on a device that a companion crate provides. Equations become weights for each cell, and are relaxed stage by
//! stage.

use super::stages::{Stages, relax_in_stages};
use super::stencil::WeightedMean;
use super::sweeps::{hint, refusal, unknowns};
use super::{Convergence, Difference, Domain, Equation, RelaxError, Relaxation, RelaxedField, Stopping};

/// A device that relaxes fields, in single precision.
pub trait Accelerator: Sync {
    /// Returns the name of the device.
    fn name(&self) -> &str;

    /// Relaxes one stage from the given values, one per cell, until the stopping rule ends it. `unknown` is true for cells with
    /// an equation. Beyond [`Boundary::High`](super::Boundary::High), values are those of obstacles.
    ///
    /// # Errors
    /// Equations and orders of updates that the device does not support, and values that grow without bound, without a hint.
    fn relax(
        &self,
        domain: &Domain,
        unknown: Vec<bool>,
        values: Vec<f64>,
        equations: CellEquations,
        relaxation: &Relaxation,
        stopping: &Stopping,
    ) -> Result<(Vec<f64>, Convergence), RelaxError>;
}

/// The equations of the cells of a grid. Neighbours are in the order previous row, next row, previous column, next
/// column.
#[derive(Debug, Clone, PartialEq)]
pub enum CellEquations {
    /// The value is the mean of the four neighbours.
    Mean,
    /// The value is a weighted mean of the neighbours. The four weights of each cell add up to 1. With negative
    /// weights, relaxation may diverge.
    Weights(Vec<[f64; 4]>),
    /// The value is the mean of the neighbours plus a multiple of `(|difference of rows| + |difference of columns|) / 2`, with a
    /// factor for each cell.
    Altered(Vec<f64>),
}

/// Does the same as [`super::relax`], on a device.
pub(super) fn relax(
    device: &dyn Accelerator,
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
) -> Result<RelaxedField, RelaxError> {
    if let Some(refusal) = refusal(domain, equation, relaxation) {
        return Err(refusal);
    }
    let (unknowns, values, stages) = (unknowns(domain), domain.start(), Vec::new());
    let mut field = Field { device, domain, relaxation, stopping, unknowns, values, stages };
    relax_in_stages(equation, domain, relaxation, &mut field).map_err(|error| match error {
        RelaxError::Diverged { sweeps, cell, value, .. } => {
            RelaxError::Diverged { sweeps, cell, value, hint: hint(domain, equation, relaxation) }
        }
        refused @ RelaxError::Refused(_) => refused,
    })?;
    Ok(RelaxedField { values: field.values, stages: field.stages })
}

/// The state of a field while it is relaxed.
struct Field<'a> {
    device: &'a dyn Accelerator,
    domain: &'a Domain,
    relaxation: &'a Relaxation,
    stopping: &'a Stopping,
    unknowns: Vec<u32>,
    values: Vec<f64>,
    stages: Vec<Convergence>,
}

impl Stages for Field<'_> {
    fn harmonic(&mut self) -> Result<(), RelaxError> {
        self.linear(|_| [0.0; 2], Difference::Central)
    }

    fn linear(&mut self, drift: impl Fn(usize) -> [f64; 2], difference: Difference) -> Result<(), RelaxError> {
        let weighted = WeightedMean::new(self.domain, &self.unknowns, drift, difference);
        // If all cells have the same weights, the device needs no list of weights.
        if (0..self.unknowns.len()).all(|k| weighted.at(k) == [0.25; 4]) {
            return self.stage(CellEquations::Mean);
        }
        let mut weights = vec![[0.0; 4]; self.values.len()];
        for (k, &cell) in self.unknowns.iter().enumerate() {
            weights[cell as usize] = weighted.at(k);
        }
        self.stage(CellEquations::Weights(weights))
    }

    fn altered(&mut self, strengths: Vec<f64>) -> Result<(), RelaxError> {
        if self.domain.beta() != 1.0 {
            return Err(RelaxError::Refused("use the CPU for altered preferences on cells that are not square".into()));
        }
        self.stage(CellEquations::Altered(strengths))
    }

    fn values(&self) -> &[f64] {
        &self.values
    }
}

impl Field<'_> {
    fn stage(&mut self, equations: CellEquations) -> Result<(), RelaxError> {
        let mut unknown = vec![false; self.values.len()];
        self.unknowns.iter().for_each(|&cell| unknown[cell as usize] = true);
        let start = std::mem::take(&mut self.values);
        let (values, stage) =
            self.device.relax(self.domain, unknown, start, equations, self.relaxation, self.stopping)?;
        self.stages.push(stage);
        // Fixed values are restored to double precision.
        let fixed = |(value, &kind)| self.domain.fixed(kind).unwrap_or(value);
        self.values = values.into_iter().zip(self.domain.kinds()).map(fixed).collect();
        Ok(())
    }
}
