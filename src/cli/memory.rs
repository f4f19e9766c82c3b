//! Measures the memory that a piece of work takes.

/// A counter of the bytes that the process has allocated. The functions come from the program, because a library cannot
/// choose the allocator.
#[derive(Debug, Clone, Copy)]
pub struct MemoryMeter {
    /// Returns the greatest allocation since the last restart, minus the allocation at that restart, in bytes.
    pub peak: fn() -> usize,
    /// Restarts the count from the current allocation.
    pub restart: fn(),
}

impl MemoryMeter {
    /// Runs `work`, and returns the greatest growth of the allocation, in bytes. This includes other threads.
    pub fn measure<T>(&self, work: impl FnOnce() -> T) -> (T, u64) {
        (self.restart)();
        let result = work();
        (result, (self.peak)() as u64)
    }
}
