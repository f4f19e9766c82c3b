//! The `cplan` program.

use cplan::cli::MemoryMeter;
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use std::alloc::System;
use std::process::ExitCode;

/// Counts what is allocated, for `cplan compare`.
#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

fn main() -> ExitCode {
    cplan::cli::run(Some(MemoryMeter {
        peak: || ALLOCATOR.get_peak_memory(),
        restart: || ALLOCATOR.reset_peak_memory(),
    }))
}
