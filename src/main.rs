//! The `cplan` program.

use cplan::cli::MemoryMeter;
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use std::alloc::System;
use std::hint::black_box;
use std::process::ExitCode;

/// Counts allocated memory, for `cplan compare`.
#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// Size of a block that is allocated and freed at the start, so that the GNU C library keeps more freed memory. It
/// keeps twice the size of the largest block returned to the system, at most twice 32 MiB. It returns the rest at once,
/// page by page, and getting it again costs a fifth of a decision of `explore`.
const KEPT_MEMORY_BYTES: usize = 31 << 20;

fn main() -> ExitCode {
    // The block is never touched, so it takes no memory.
    drop(black_box(Vec::<u8>::with_capacity(KEPT_MEMORY_BYTES)));
    cplan::cli::run(Some(MemoryMeter {
        peak: || ALLOCATOR.get_peak_memory(),
        restart: || ALLOCATOR.reset_peak_memory(),
    }))
}
