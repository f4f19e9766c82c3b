//! The device that relaxes a field.

use super::{Domain, Equation, RelaxError, Relaxation, RelaxedField, Stopping, relax};
use serde::{Deserialize, Serialize};

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

impl Device {
    /// Returns the name of the GPU adapter, or `None` for the CPU.
    ///
    /// # Errors
    /// Returns the reason, with a hint: there is no driver, or the program was built without the feature `gpu`.
    pub fn adapter(self) -> Result<Option<&'static str>, String> {
        match self {
            Self::Cpu => Ok(None),
            #[cfg(feature = "gpu")]
            Self::Gpu => super::gpu::shared().map(|gpu| Some(gpu.adapter())),
            #[cfg(not(feature = "gpu"))]
            Self::Gpu => Err(NO_GPU_MESSAGE.into()),
        }
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

#[cfg(not(feature = "gpu"))]
const NO_GPU_MESSAGE: &str = "this program was built without GPU; build it with --features gpu, or relax on the CPU";

/// Does the same as [`relax`], on a device. On a GPU, values are rounded to single precision. A stage that cannot
/// improve in single precision ends before `stopping.max_sweeps`, without convergence.
///
/// # Errors
/// Those of [`relax`]. Also [`RelaxError::Refused`] if there is no GPU, or if the GPU does not support the order of
/// updates or the number of cells.
pub fn relax_on(
    device: Device,
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
) -> Result<RelaxedField, RelaxError> {
    match device {
        Device::Cpu => relax(domain, equation, relaxation, stopping),
        #[cfg(feature = "gpu")]
        Device::Gpu => super::gpu::relax(domain, equation, relaxation, stopping),
        #[cfg(not(feature = "gpu"))]
        Device::Gpu => Err(RelaxError::Refused(NO_GPU_MESSAGE.into())),
    }
}
