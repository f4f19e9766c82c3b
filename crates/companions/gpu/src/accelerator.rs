//! The GPU as a device for the relaxation of fields.

use super::{Ending, Gpu, GpuError, GridEquations};
use cplan_fields::{Accelerator, CellEquations, Convergence, Domain, RelaxError, Relaxation, Stopping};
use std::sync::OnceLock;

/// Returns the GPU of this process, which is opened on first use.
///
/// # Errors
/// Returns the reason, with a hint, if there is no GPU.
pub fn shared() -> Result<&'static dyn Accelerator, String> {
    static GPU: OnceLock<Result<Gpu, String>> = OnceLock::new();
    let gpu = GPU.get_or_init(|| Gpu::open().map_err(|error| error.to_string()));
    gpu.as_ref().map(|gpu| gpu as &dyn Accelerator).map_err(Clone::clone)
}

impl Accelerator for Gpu {
    fn name(&self) -> &str {
        self.adapter()
    }

    fn relax(
        &self,
        domain: &Domain,
        unknown: Vec<bool>,
        values: Vec<f64>,
        equations: CellEquations,
        relaxation: &Relaxation,
        stopping: &Stopping,
    ) -> Result<(Vec<f64>, Convergence), RelaxError> {
        let outside = domain.levels().obstacle;
        let problem = GridEquations::new(domain.cells(), domain.boundaries(), outside, values, unknown, equations)?;
        let relaxed = Gpu::relax(self, &problem, relaxation, stopping)?;
        let converged = relaxed.ending == Ending::Converged;
        Ok((relaxed.values, Convergence { sweeps: relaxed.sweeps, change: relaxed.change, converged }))
    }
}

impl From<GpuError> for RelaxError {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::Diverged { sweeps, cell, value } => {
                Self::Diverged { sweeps: sweeps as usize, cell, value, hint: String::new() }
            }
            error => Self::Refused(error.to_string()),
        }
    }
}
