//! The `cplan` program.

use cplan::cli::MemoryMeter;
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use std::alloc::System;
use std::hint::black_box;
use std::process::ExitCode;

/// Counts what is allocated, for `cplan compare`.
#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// Of what is freed the GNU C library keeps twice the size of the greatest block that was handed back to the system, at most twice 32 MiB;
/// the rest goes back at once, page by page, and costs a fifth of a decision of `explore` to get again.
const KEPT: usize = 31 << 20;

fn main() -> ExitCode {
    // Never touched: it takes no memory.
    drop(black_box(Vec::<u8>::with_capacity(KEPT)));
    cplan::cli::run(Some(MemoryMeter {
        peak: || ALLOCATOR.get_peak_memory(),
        restart: || ALLOCATOR.reset_peak_memory(),
    }))
}
