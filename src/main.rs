//! The `cplan` program.

use cplan::cli::MemoryMeter;
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use std::alloc::System;
use std::hint::black_box;
use std::process::ExitCode;

/// Counts allocated memory, for `cplan compare`.
#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// Size of a block that is allocated and freed at the start, in bytes. It makes the GNU C library keep up to twice as
/// much freed memory, instead of returning it to the system page by page. Otherwise, a fifth of the time of each
/// decision of `explore` would be spent on getting memory again. A block of more than 32 MiB has no such effect.
const KEPT_MEMORY_BYTES: usize = 31 << 20;

fn main() -> ExitCode {
    // The block takes no memory, because nothing is written to it.
    drop(black_box(Vec::<u8>::with_capacity(KEPT_MEMORY_BYTES)));
    cplan::cli::run(Some(MemoryMeter {
        peak: || ALLOCATOR.get_peak_memory(),
        restart: || ALLOCATOR.reset_peak_memory(),
    }))
}
