//! The `cplan` program.

use cplan::cli::MemoryMeter;
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use std::alloc::System;
use std::hint::black_box;
use std::process::ExitCode;

/// Counts allocated memory, for `cplan compare`.
#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// Size of a block that is allocated and freed at the start, in bytes. Afterwards, the GNU C library keeps up to twice
/// as much freed memory, instead of returning it to the system page by page. Without this, getting the memory again
/// would take a fifth of the time of each decision of `explore`. A block of more than 32 MiB has no such effect.
const KEPT_MEMORY_BYTES: usize = 31 << 20;

fn main() -> ExitCode {
    // Nothing is written to the block, so it takes no memory.
    drop(black_box(Vec::<u8>::with_capacity(KEPT_MEMORY_BYTES)));
    cplan::cli::run(Some(MemoryMeter {
        peak: || ALLOCATOR.get_peak_memory(),
        restart: || ALLOCATOR.reset_peak_memory(),
    }))
}
