//! The device that relaxes a field.

use super::accelerated::{self, Accelerator};
use super::{Domain, Equation, RelaxError, Relaxation, RelaxedField, Stopping, relax};
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// A device on which a field is relaxed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Device {
    /// The CPU, in double precision.
    #[default]
    Cpu,
    /// A GPU, in single precision: values below 10^-38 become 0. The order of updates must be all cells at once, or
    /// [red-black](super::Order::RedBlack).
    Gpu,
}

/// Opens the GPU on first use. `Err` has the reason, with a hint, if there is none.
pub type OpenGpu = fn() -> Result<&'static dyn Accelerator, String>;

static OPEN_GPU: OnceLock<OpenGpu> = OnceLock::new();

impl Device {
    /// Provides the GPU of this process. Only the first call has an effect.
    pub fn bring_gpu(open: OpenGpu) {
        let _ = OPEN_GPU.set(open);
    }

    /// Returns the device, or `None` for the CPU.
    fn accelerator(self) -> Result<Option<&'static dyn Accelerator>, String> {
        match (self, OPEN_GPU.get()) {
            (Self::Cpu, _) => Ok(None),
            (Self::Gpu, Some(open)) => open().map(Some),
            (Self::Gpu, None) => Err(NO_GPU_MESSAGE.into()),
        }
    }

    /// Returns the name of the GPU adapter, or `None` for the CPU.
    ///
    /// # Errors
    /// No driver, or a program without the feature `gpu`, with a hint.
    pub fn adapter(self) -> Result<Option<&'static str>, String> {
        self.accelerator().map(|accelerator| accelerator.map(Accelerator::name))
    }

    /// Returns true for the CPU. Results do not mention this default.
    pub fn is_cpu(&self) -> bool {
        *self == Self::Cpu
    }

    /// Returns the name of the device's precision.
    pub fn precision(self) -> &'static str {
        if self.is_cpu() { "doubles" } else { "single precision" }
    }
}

const NO_GPU_MESSAGE: &str = "this program was built without GPU; build it with --features gpu, or relax on the CPU";

/// Does the same as [`relax`] on a device. On a GPU, values are rounded to single precision; a stage that cannot improve in it
/// ends before `stopping.max_sweeps`, without convergence.
///
/// # Errors
/// Those of [`relax`]. Also [`RelaxError::Refused`] if there is no GPU, or if the GPU does not support the order of updates or
/// the number of cells.
pub fn relax_on(
    device: Device,
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
) -> Result<RelaxedField, RelaxError> {
    match device.accelerator().map_err(RelaxError::Refused)? {
        None => relax(domain, equation, relaxation, stopping),
        Some(accelerator) => accelerated::relax(accelerator, domain, equation, relaxation, stopping),
    }
}
