//! What a relaxation runs on.

use super::{Domain, Equation, RelaxError, Relaxation, Relaxed, Stopping, relax};
use serde::{Deserialize, Serialize};

/// Where sweeps are done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Device {
    /// In double precision on the CPU.
    #[default]
    Cpu,
    /// In single precision on a GPU: values below 10^-38 are 0. Cells go all at once or [red-black](super::Order::RedBlack).
    Gpu,
}

impl Device {
    /// The name of the adapter, if it is one.
    ///
    /// # Errors
    /// Why there is none, with the cure: no driver, or a program that was built without the feature `gpu`.
    pub fn adapter(self) -> Result<Option<&'static str>, String> {
        match self {
            Self::Cpu => Ok(None),
            #[cfg(feature = "gpu")]
            Self::Gpu => super::gpu::shared().map(|gpu| Some(gpu.adapter())),
            #[cfg(not(feature = "gpu"))]
            Self::Gpu => Err(WITHOUT_GPU.into()),
        }
    }

    /// Whether all is computed on the CPU in doubles: what is said nothing of.
    #[must_use]
    pub fn is_cpu(&self) -> bool {
        *self == Self::Cpu
    }

    /// What tells values apart there.
    #[must_use]
    pub fn precision(self) -> &'static str {
        if self.is_cpu() { "doubles" } else { "single precision" }
    }
}

#[cfg(not(feature = "gpu"))]
const WITHOUT_GPU: &str = "this program was built without GPU; build it with --features gpu, or relax on the CPU";

/// As [`relax`], on a device. On a GPU fields differ from the CPU's by rounding to single precision; a stage that can come no further in it
/// ends unconverged before `stopping.max_sweeps`.
///
/// # Errors
/// As [`relax`]; [`RelaxError::Refused`] where there is no GPU, or it cannot do what is asked for: other orders, too many cells.
pub fn relax_on(
    device: Device,
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
) -> Result<Relaxed, RelaxError> {
    match device {
        Device::Cpu => relax(domain, equation, relaxation, stopping),
        #[cfg(feature = "gpu")]
        Device::Gpu => super::gpu::relax(domain, equation, relaxation, stopping),
        #[cfg(not(feature = "gpu"))]
        Device::Gpu => Err(RelaxError::Refused(WITHOUT_GPU.into())),
    }
}
