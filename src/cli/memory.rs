//! Measures how much memory a piece of work takes.

/// A counter of the bytes that the process has allocated. The program's allocator provides it; a library cannot choose
/// an allocator.
#[derive(Debug, Clone, Copy)]
pub struct MemoryMeter {
    /// Returns by how many bytes the largest allocation since the last restart exceeded the allocation at that restart.
    pub peak: fn() -> usize,
    /// Restarts the count, beginning with the present allocation.
    pub restart: fn(),
}

impl MemoryMeter {
    /// Runs `work`, and returns the largest number of bytes that were allocated in addition. Includes allocations of
    /// other threads during that time.
    pub fn measure<T>(&self, work: impl FnOnce() -> T) -> (T, u64) {
        (self.restart)();
        let result = work();
        (result, (self.peak)() as u64)
    }
}
