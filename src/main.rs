//! The `cplan` program.

use cplan::cli::MemoryMeter;
use peak_alloc::PeakAlloc;
use std::process::ExitCode;

/// Counts what is allocated, for `cplan compare`.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn main() -> ExitCode {
    cplan::cli::run(Some(MemoryMeter {
        current: || ALLOCATOR.current_usage(),
        peak: || ALLOCATOR.peak_usage(),
        restart: || ALLOCATOR.reset_peak_usage(),
    }))
}
