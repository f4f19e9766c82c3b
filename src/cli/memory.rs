//! Measures how much memory a piece of work takes.

/// A counter of the bytes that the process has allocated. The functions come from the program, because a library cannot
/// choose the allocator that counts.
#[derive(Debug, Clone, Copy)]
pub struct MemoryMeter {
    /// Returns by how many bytes the greatest allocation since the last restart exceeds the allocation at that restart.
    pub peak: fn() -> usize,
    /// Restarts the count from the present allocation.
    pub restart: fn(),
}

impl MemoryMeter {
    /// Runs `work`, and returns by how many bytes the allocation grew at most. This includes allocations of other
    /// threads during that time.
    pub fn measure<T>(&self, work: impl FnOnce() -> T) -> (T, u64) {
        (self.restart)();
        let result = work();
        (result, (self.peak)() as u64)
    }
}
