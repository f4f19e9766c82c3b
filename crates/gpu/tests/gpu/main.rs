//! What the GPU computes, against plain relaxations and dense elimination that share no code with it.
//!
//! Each needs a driver of Vulkan, Metal or Direct3D 12, in software if need be: `.ci/gpu` fetches one where there is none.

mod adapter;
mod multigrid;
mod oracle;
mod relax;

use cplan_gpu::Gpu;
use std::sync::OnceLock;

/// One for all tests.
fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| Gpu::open().expect("a driver: .ci/gpu fetches one"))
}
