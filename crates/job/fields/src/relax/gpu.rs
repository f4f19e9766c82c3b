//! Relaxation on a GPU. Equations become weights for each cell, and are relaxed stage after stage.

use super::stages::{Stages, relax_in_stages};
use super::stencil::WeightedMean;
use super::sweeps::{hint, refusal, unknowns};
use super::{
    Boundary, Cell, Convergence, Difference, Domain, Equation, Measure, Order, RelaxError, Relaxation, RelaxedField,
    Scheme, Stopping,
};
use cplan_gpu::{Edge, Ending, Gpu, GpuError, GridEquations, Settings, Stencil, Sweep};
use std::sync::OnceLock;

/// Returns the GPU of this process, which is opened on first use.
///
/// # Errors
/// Returns the reason, with a hint, if there is no GPU.
pub(super) fn shared() -> Result<&'static Gpu, String> {
    static GPU: OnceLock<Result<Gpu, String>> = OnceLock::new();
    GPU.get_or_init(|| Gpu::open().map_err(|error| error.to_string())).as_ref().map_err(Clone::clone)
}

/// Does the same as [`super::relax`], on the GPU.
pub(super) fn relax(
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
) -> Result<RelaxedField, RelaxError> {
    if let Some(refusal) = refusal(domain, equation, relaxation) {
        return Err(refusal);
    }
    let sweep = match relaxation.scheme {
        Scheme::Simultaneous { .. } => Sweep::Jacobi,
        Scheme::Successive { order: Order::RedBlack, .. } => Sweep::RedBlack,
        Scheme::Successive { order, .. } => {
            let reason = format!("a GPU relaxes cells red-black or all at once; use the CPU for the order {order}");
            return Err(RelaxError::Refused(reason));
        }
    };
    let settings = Settings {
        sweep,
        factor: relaxation.factor(domain.cells()),
        clamp: relaxation.clamp,
        measure: match stopping.measure {
            Measure::SumOfChange => cplan_gpu::Measure::Sum,
            Measure::SumOfSquares => cplan_gpu::Measure::Squares,
            Measure::DifferenceOfSums => cplan_gpu::Measure::DifferenceOfSums,
            Measure::GreatestChange => cplan_gpu::Measure::Greatest,
            Measure::GreatestRelativeChange => cplan_gpu::Measure::Relative,
        },
        below: stopping.below,
        max_sweeps: u32::try_from(stopping.max_sweeps).unwrap_or(u32::MAX),
    };
    let gpu = shared().map_err(RelaxError::Refused)?;
    let unknowns = unknowns(domain);
    let (values, stages) = (domain.start(), Vec::new());
    let mut field = Field { gpu, domain, equation, relaxation, settings, unknowns, values, stages };
    relax_in_stages(equation, domain, relaxation, &mut field)?;
    Ok(RelaxedField { values: field.values, stages: field.stages })
}

/// The state of a field while it is relaxed.
struct Field<'a> {
    gpu: &'a Gpu,
    domain: &'a Domain,
    equation: &'a Equation,
    relaxation: &'a Relaxation,
    settings: Settings,
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
        // If all cells have the same weights, the GPU needs no list of them.
        let stencil = if (0..self.unknowns.len()).all(|k| weighted.at(k) == [0.25; 4]) {
            Stencil::Mean
        } else {
            let mut weights = vec![[0.0; 4]; self.values.len()];
            for (k, &cell) in self.unknowns.iter().enumerate() {
                weights[cell as usize] = weighted.at(k);
            }
            Stencil::Weights(weights)
        };
        self.stage(stencil)
    }

    fn altered(&mut self, strengths: Vec<f64>) -> Result<(), RelaxError> {
        if self.domain.beta() != 1.0 {
            return Err(RelaxError::Refused("use the CPU for altered preferences on cells that are not square".into()));
        }
        self.stage(Stencil::Altered(strengths))
    }

    fn values(&self) -> &[f64] {
        &self.values
    }
}

impl Field<'_> {
    fn stage(&mut self, stencil: Stencil) -> Result<(), RelaxError> {
        let Self { domain, gpu, .. } = *self;
        let mut unknown = vec![false; self.values.len()];
        self.unknowns.iter().for_each(|&cell| unknown[cell as usize] = true);
        let edges = domain.boundaries().map(|boundary| match boundary {
            Boundary::Periodic => Edge::Circle,
            Boundary::High => Edge::Wall,
            Boundary::Reflecting => Edge::Mirror,
        });
        let values = std::mem::take(&mut self.values);
        let problem = GridEquations::new(domain.cells(), edges, domain.levels().obstacle, values, unknown, stencil);
        let relaxed = problem.and_then(|problem| gpu.relax(&problem, &self.settings)).map_err(|e| self.error(e))?;
        let sweeps = relaxed.sweeps as usize;
        let converged = relaxed.ending == Ending::Converged;
        self.stages.push(Convergence { sweeps, change: relaxed.change, converged });
        self.values = relaxed.values;
        // Restore fixed values in double precision.
        for (value, &kind) in self.values.iter_mut().zip(domain.kinds()).filter(|(_, kind)| **kind != Cell::Free) {
            *value = domain.fixed(kind).unwrap_or(*value);
        }
        Ok(())
    }

    fn error(&self, error: GpuError) -> RelaxError {
        match error {
            GpuError::Diverged { sweeps, cell, value } => {
                let hint = hint(self.domain, self.equation, self.relaxation);
                RelaxError::Diverged { sweeps: sweeps as usize, cell, value, hint }
            }
            error => RelaxError::Refused(error.to_string()),
        }
    }
}
