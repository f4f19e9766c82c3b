//! Interruption of long computations by a flag or a deadline.
//!
//! Planning is a deep call of pure functions, and may take long. Call it in [`Interrupt::run`] to be able to stop it.
//! Long loops call [`checkpoint`]. If the interrupt is set, this unwinds the stack back to the call of
//! [`Interrupt::run`]. An interrupted computation returns [`Interrupted`] and nothing else, so a partial result cannot
//! be mistaken for a complete one.
//!
//! ```
//! use cplan_interrupt::{Interrupt, Interrupted, checkpoint};
//!
//! let interrupt = Interrupt::new();
//! assert_eq!(interrupt.run(|| (1..=3).inspect(|_| checkpoint()).sum::<i32>()), Ok(6));
//! interrupt.set();
//! assert_eq!(interrupt.run(|| (1..=3).inspect(|_| checkpoint()).sum::<i32>()), Err(Interrupted::Set));
//! ```
//!
//! A loop that may take more than a few milliseconds needs a checkpoint. Because of unwinding, no function needs to
//! return that it was interrupted. A checkpoint costs a few nanoseconds and has no effect outside of
//! [`Interrupt::run`], so callers that never interrupt need not know about checkpoints.
//!
//! WebAssembly without a system (`wasm32-unknown-unknown`) has neither a clock nor unwinding. There, a `Host` supplies
//! the time, and stops work by ending the whole instance of the program. WASI has a clock, but no unwinding either: there,
//! checkpoints call callbacks, but work that has begun runs to its end.
#![forbid(unsafe_code)]

#[cfg(any(all(target_family = "wasm", target_os = "unknown"), test))]
mod clock;

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub use clock::{Host, Instant};
/// A point in time. It is that of the standard library, except on WebAssembly without a system, where the host supplies
/// the time.
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub use std::time::Instant;

use std::cell::RefCell;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// Reasons why work was interrupted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Interrupted {
    /// [`Interrupt::set`] was called.
    #[error("interrupted")]
    Set,
    /// The deadline of [`Interrupt::with_deadline`] passed.
    #[error("interrupted: the time is up")]
    TimeUp,
}

/// A handle with which any thread can stop work. Clones are handles to the same interrupt.
#[derive(Debug, Clone, Default)]
pub struct Interrupt {
    flag: Arc<AtomicBool>,
    deadline: Option<Instant>,
    question: Option<Arc<StopCallback>>,
}

/// True if a checkpoint can stop work.
const CAN_STOP: bool = !cfg!(target_os = "wasi");

/// A callback that returns true if work must stop.
type StopCheck = Box<dyn Fn() -> bool + Send + Sync>;

/// A callback, and the times at which it is called.
struct StopCallback {
    every: Duration,
    begun: Instant,
    /// Time of the next call, in nanoseconds from the start.
    next: AtomicU64,
    stops: AssertUnwindSafe<StopCheck>,
}

impl fmt::Debug for StopCallback {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Question").field("every", &self.every).finish_non_exhaustive()
    }
}

impl StopCallback {
    /// Returns true if the callback is due. If several threads ask, only one of them gets true.
    fn is_due(&self) -> bool {
        let (now, next) = (self.begun.elapsed().as_nanos() as u64, self.next.load(Ordering::Relaxed));
        let after = now + self.every.as_nanos() as u64;
        now >= next && self.next.compare_exchange(next, after, Ordering::Relaxed, Ordering::Relaxed).is_ok()
    }
}

/// The payload with which [`checkpoint`] unwinds. It has the depth of the interrupt, so that only the
/// [`Interrupt::run`] of that interrupt catches it.
struct Unwinding {
    depth: usize,
    why: Interrupted,
}

thread_local! {
    /// The interrupts in whose [`Interrupt::run`] this thread works, the outermost first.
    static ACTIVE: RefCell<Vec<Interrupt>> = const { RefCell::new(Vec::new()) };
}

impl Interrupt {
    /// Creates an interrupt that is not set and has no deadline.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns this handle with a deadline. Clones that were made before have no deadline.
    #[must_use]
    pub fn with_deadline(self, deadline: Instant) -> Self {
        Self { deadline: Some(deadline), ..self }
    }

    /// Returns this handle with a callback that returns true to stop the work. Checkpoints call it at this interval, on
    /// the thread of the work. It is for hosts that report signals only to that thread. The callback may itself call
    /// [`Interrupt::run`].
    #[must_use]
    pub fn with_callback(self, every: Duration, stops: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        let next = AtomicU64::new(every.as_nanos() as u64);
        let question = StopCallback { every, begun: Instant::now(), next, stops: AssertUnwindSafe(Box::new(stops)) };
        Self { question: Some(Arc::new(question)), ..self }
    }

    /// Stops all work that runs under this interrupt, now and later, whichever handle it was started with.
    pub fn set(&self) {
        self.flag.store(true, Ordering::Relaxed);
    }

    /// Returns the reason to stop: the interrupt is set, or the deadline has passed. `None` if neither is true.
    pub fn stop_reason(&self) -> Option<Interrupted> {
        if self.flag.load(Ordering::Relaxed) {
            return Some(Interrupted::Set);
        }
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline).then_some(Interrupted::TimeUp)
    }

    /// Runs `work` on this thread until it finishes or the interrupt is set. If the interrupt is set before, `work`
    /// does not start. Calls may be nested; of several interrupts that are set, the outermost one stops the work.
    ///
    /// Work stops at its next [`checkpoint`]; without checkpoints it finishes. Values that `work` owns are dropped. The
    /// caller must repair values that `work` borrows and changes.
    ///
    /// # Errors
    /// [`Interrupted`] if the work was stopped.
    ///
    /// # Panics
    /// If `work` panics. Requires `panic = "unwind"`, which is Cargo's default.
    pub fn run<T>(&self, work: impl FnOnce() -> T) -> Result<T, Interrupted> {
        if let Some(why) = self.stop_reason() {
            return Err(why);
        }
        let depth = ACTIVE.with_borrow_mut(|active| {
            active.push(self.clone());
            active.len()
        });
        let done = catch_unwind(AssertUnwindSafe(work));
        ACTIVE.with_borrow_mut(|active| active.truncate(depth - 1));
        done.map_err(|payload| match payload.downcast::<Unwinding>() {
            Ok(unwinding) if unwinding.depth == depth => unwinding.why,
            Ok(outer) => resume_unwind(outer),
            Err(panic) => resume_unwind(panic),
        })
    }
}

/// Stops the thread's work if an interrupt is set; otherwise returns. Takes a few nanoseconds, or some tens with a
/// deadline or a callback. Has no effect outside of [`Interrupt::run`].
#[inline]
pub fn checkpoint() {
    let (set, asked) = ACTIVE.with_borrow(|active| {
        let why = |(depth, interrupt): (usize, &Interrupt)| Some(Unwinding { depth, why: interrupt.stop_reason()? });
        let is_due = |interrupt: &&Interrupt| interrupt.question.as_ref().is_some_and(|question| question.is_due());
        ((1..).zip(active).filter(|_| CAN_STOP).find_map(why), active.iter().find(is_due).cloned())
    });
    if let Some(unwinding) = set {
        unwind(unwinding);
    }
    if let Some(interrupt) =
        asked.filter(|interrupt| interrupt.question.as_ref().is_some_and(|question| (question.stops.0)()))
    {
        interrupt.set();
        checkpoint();
    }
}

/// Unwinds to the [`Interrupt::run`] whose interrupt is set.
fn unwind(unwinding: Unwinding) -> ! {
    #[cfg(all(target_family = "wasm", target_os = "unknown"))]
    Host::end();
    // Unwinding without a panic prints no message and calls no hook.
    resume_unwind(Box::new(unwinding))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn counted_to(n: usize, also: impl Fn(usize)) -> usize {
        (0..n)
            .inspect(|&i| {
                also(i);
                checkpoint();
            })
            .count()
    }

    #[test]
    fn work_stops_at_the_next_checkpoint() {
        let interrupt = Interrupt::new();
        let reached = std::cell::Cell::new(0);
        let result = interrupt.run(|| {
            counted_to(100, |i| {
                reached.set(i);
                if i == 7 {
                    interrupt.set();
                }
            })
        });
        assert_eq!((result, reached.get()), (Err(Interrupted::Set), 7));
        assert_eq!(counted_to(3, |_| ()), 3, "outside the run it has no effect");
    }

    #[test]
    fn a_deadline_that_has_passed_stops_work_and_one_to_come_does_not() {
        let now = Instant::now();
        assert_eq!(Interrupt::new().with_deadline(now).run(|| counted_to(3, |_| ())), Err(Interrupted::TimeUp));
        let later = Interrupt::new().with_deadline(now + Duration::from_secs(1000));
        assert_eq!(later.run(|| counted_to(3, |_| ())), Ok(3));
    }

    #[test]
    fn nested_runs_end_where_their_own_interrupt_is_set() {
        let (outer, inner) = (Interrupt::new(), Interrupt::new());
        inner.set();
        let result = outer.run(|| (inner.run(|| counted_to(3, |_| ())), counted_to(3, |_| ())));
        assert_eq!(result, Ok((Err(Interrupted::Set), 3)));
        let inner = Interrupt::new();
        let result = outer.run(|| inner.run(|| counted_to(3, |_| outer.set())));
        assert_eq!(result, Err(Interrupted::Set), "the outer one ends both");
    }

    #[test]
    fn callbacks_can_stop_the_work() {
        let asked = Arc::new(AtomicU64::new(0));
        let count = asked.clone();
        let interrupt = Interrupt::new().with_callback(Duration::from_millis(1), move || {
            assert_eq!(Interrupt::new().run(|| counted_to(3, |_| ())), Ok(3));
            count.fetch_add(1, Ordering::Relaxed) == 4
        });
        let endless = || {
            loop {
                checkpoint();
            }
        };
        assert_eq!(interrupt.run(endless), Err::<(), _>(Interrupted::Set));
        assert_eq!(asked.load(Ordering::Relaxed), 5);
        let patient = Interrupt::new().with_callback(Duration::from_secs(1000), || true);
        assert_eq!(patient.run(|| counted_to(3, |_| ())), Ok(3));
    }

    #[test]
    fn panics_pass_through() {
        let interrupt = Interrupt::new();
        let panic = catch_unwind(|| interrupt.run(|| resume_unwind(Box::new("a panic")))).unwrap_err();
        assert_eq!(*panic.downcast::<&str>().unwrap(), "a panic");
        interrupt.set();
        assert_eq!(counted_to(3, |_| ()), 3, "the thread works under no interrupt any more");
    }

    #[test]
    fn another_thread_can_set_the_interrupt() {
        let interrupt = Interrupt::new();
        let handle = interrupt.clone();
        let setter = std::thread::spawn(move || handle.set());
        let result = interrupt.run(|| {
            loop {
                checkpoint();
                std::thread::yield_now();
            }
        });
        setter.join().unwrap();
        assert_eq!(result, Err::<(), _>(Interrupted::Set));
    }
}
