//! Measures the memory of a piece of work, if the program can.

/// A counter of the bytes that the process has allocated. It is part of the program's allocator, which a library cannot
/// choose.
#[derive(Debug, Clone, Copy)]
pub struct MemoryMeter {
    /// Returns the peak of allocated bytes since the last restart, minus the bytes allocated then.
    pub peak: fn() -> usize,
    /// Restarts the count at the present allocation.
    pub restart: fn(),
}

impl MemoryMeter {
    /// Does the work, and returns its peak of additional allocated bytes. Allocations of other threads during that time
    /// count, too.
    pub fn measure<T>(&self, work: impl FnOnce() -> T) -> (T, u64) {
        (self.restart)();
        let result = work();
        (result, (self.peak)() as u64)
    }
}
