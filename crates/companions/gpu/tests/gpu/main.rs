//! Tests of GPU results against plain relaxations and dense elimination that share no code with them.
//!
//! Each test needs a driver of Vulkan, Metal or Direct3D 12, possibly in software: `.ci/gpu` installs one if needed.

mod adapter;
mod multigrid;
mod oracle;
mod relax;

use cplan_gpu::Gpu;
use std::sync::OnceLock;

/// Returns the GPU that all tests share.
fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| Gpu::open().expect("a driver: .ci/gpu fetches one"))
}
