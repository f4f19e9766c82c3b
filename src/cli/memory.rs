//! How much memory a piece of work takes, where the program can tell.

/// What counts the bytes that the process has allocated: the program's allocator, which a library cannot choose.
#[derive(Debug, Clone, Copy)]
pub struct MemoryMeter {
    /// Bytes that were allocated at the same time, beyond those at the last restart, at the most.
    pub peak: fn() -> usize,
    /// Begins to count at what is allocated now.
    pub restart: fn(),
}

impl MemoryMeter {
    /// Does the work, and tells how many bytes more than before it had allocated at the same time, at the most. Whatever
    /// other threads allocate meanwhile counts, too.
    pub fn measure<T>(&self, work: impl FnOnce() -> T) -> (T, u64) {
        (self.restart)();
        let result = work();
        (result, (self.peak)() as u64)
    }
}
