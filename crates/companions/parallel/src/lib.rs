//! Runs work on several threads, and returns the results in order.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Largest number of finished results per thread that wait for an earlier result.
const MAX_WAITING_PER_THREAD: usize = 64;

/// Runs a piece of work. A panic becomes an error, so that other pieces can continue.
///
/// # Errors
/// The message of the panic. An interruption of the whole run unwinds further.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let message = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        match message {
            Some(message) => format!("internal error: {message}; this is a defect of cplan, please report it"),
            None => resume_unwind(panic),
        }
    })
}

/// Runs `count` pieces of work on `jobs` threads. Passes the results to `each` on the calling thread, in order and as
/// early as possible, until `each` fails. A panic in a piece unwinds to the caller.
///
/// # Errors
/// The error of `each`. Running pieces finish, and no others start.
pub fn run_in_order<T: Send, E>(
    count: usize,
    jobs: usize,
    work: impl Fn(usize) -> T + Sync,
    mut each: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    // WebAssembly has no threads.
    if jobs <= 1 || cfg!(target_family = "wasm") {
        return (0..count).try_for_each(|i| each(work(i)));
    }
    let next = AtomicUsize::new(0);
    let turns =
        TurnState { state: Mutex::new((0, false)), turn_changed: Condvar::new(), most: MAX_WAITING_PER_THREAD * jobs };
    std::thread::scope(|scope| {
        let (sender, results) = channel();
        for _ in 0..jobs.min(count) {
            let sender = sender.clone();
            let (next, turns, work) = (&next, &turns, &work);
            scope.spawn(move || {
                loop {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    if i >= count || !turns.may_begin(i) {
                        break;
                    }
                    match catch_unwind(AssertUnwindSafe(|| work(i))) {
                        // After an error of `each`, nothing receives the results.
                        Ok(result) => drop(sender.send((i, result))),
                        Err(panic) => {
                            turns.end();
                            resume_unwind(panic);
                        }
                    }
                }
            });
        }
        drop(sender);
        let _over = StopGuard(&turns);
        let (mut early, mut due) = (BTreeMap::new(), 0);
        for (i, result) in results {
            early.insert(i, result);
            while let Some(result) = early.remove(&due) {
                each(result)?;
                due += 1;
                turns.reach(due);
            }
        }
        Ok(())
    })
}

/// The state of a run: the index of the next result for `each`, and whether new work may start.
struct TurnState {
    state: Mutex<(usize, bool)>,
    turn_changed: Condvar,
    most: usize,
}

impl TurnState {
    fn state(&self) -> MutexGuard<'_, (usize, bool)> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until piece `i` may start: few enough finished results may wait for an earlier one. Returns false if the
    /// run has ended.
    fn may_begin(&self, i: usize) -> bool {
        let is_early = |(due, is_over): &mut (usize, bool)| !*is_over && i >= *due + self.most;
        !self.turn_changed.wait_while(self.state(), is_early).unwrap_or_else(PoisonError::into_inner).1
    }

    fn reach(&self, due: usize) {
        self.state().0 = due;
        self.turn_changed.notify_all();
    }

    fn end(&self) {
        self.state().1 = true;
        self.turn_changed.notify_all();
    }
}

/// Releases all waiting threads when it is dropped, also after an error or a panic.
struct StopGuard<'a>(&'a TurnState);

impl Drop for StopGuard<'_> {
    fn drop(&mut self) {
        self.0.end();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_whatever_is_done_when() {
        for jobs in [1, 2, 7, 100] {
            let mut seen = Vec::new();
            let work = |i: usize| {
                // The first piece takes longest.
                (0..10_000 * usize::from(i == 0)).for_each(|_| std::thread::yield_now());
                i * i
            };
            let done: Result<(), ()> = run_in_order(50, jobs, work, |result| {
                seen.push(result);
                Ok(())
            });
            assert_eq!((done, seen), (Ok(()), (0..50).map(|i| i * i).collect()), "{jobs} jobs");
        }
    }

    #[test]
    fn a_refusal_ends_the_work() {
        for jobs in [1, 3] {
            let begun = AtomicUsize::new(0);
            let work = |i: usize| {
                begun.fetch_add(1, Ordering::Relaxed);
                i
            };
            let refused = run_in_order(1_000_000, jobs, work, |i| if i == 10 { Err("enough") } else { Ok(()) });
            assert_eq!(refused, Err("enough"));
            assert!(begun.load(Ordering::Relaxed) < 10_000);
        }
    }

    #[test]
    fn panics_are_caught_and_interrupts_are_not() {
        assert_eq!(caught(|| 7), Ok(7));
        let why = caught(|| -> u8 { panic!("corner {}", 3) });
        assert_eq!(why, Err("internal error: corner 3; this is a defect of cplan, please report it".into()));
        let interrupt = cplan_interrupt::Interrupt::new();
        let stopped = interrupt.run(|| {
            caught(|| {
                interrupt.set();
                cplan_interrupt::checkpoint();
            })
        });
        assert_eq!(stopped, Err(cplan_interrupt::Interrupted::Set));
    }

    #[test]
    fn few_results_wait_for_a_slow_one() {
        let begun = AtomicUsize::new(0);
        let work = |i: usize| {
            begun.fetch_add(1, Ordering::SeqCst);
            if i == 0 {
                // All pieces that may start have started. No more will start while the first one runs.
                while begun.load(Ordering::SeqCst) < 3 * MAX_WAITING_PER_THREAD {
                    std::thread::yield_now();
                }
                std::thread::sleep(std::time::Duration::from_millis(20));
                assert_eq!(begun.load(Ordering::SeqCst), 3 * MAX_WAITING_PER_THREAD);
            }
            i
        };
        assert_eq!(run_in_order(1000, 3, work, |_| Ok::<_, ()>(())), Ok(()));
    }

    #[test]
    fn a_panic_ends_the_work() {
        let begun = AtomicUsize::new(0);
        let work = |i: usize| {
            begun.fetch_add(1, Ordering::SeqCst);
            assert_ne!(i, 10, "this one fails");
        };
        let all = catch_unwind(AssertUnwindSafe(|| run_in_order(1_000_000, 3, work, |()| Ok::<_, ()>(()))));
        assert!(all.is_err() && begun.load(Ordering::SeqCst) < 10_000);
    }

    #[test]
    fn a_panic_of_the_receiver_ends_the_work() {
        let begun = AtomicUsize::new(0);
        let work = |_| begun.fetch_add(1, Ordering::SeqCst);
        let all = catch_unwind(AssertUnwindSafe(|| {
            run_in_order(1_000_000, 3, work, |_| -> Result<(), ()> { panic!("none is taken") })
        }));
        assert!(all.is_err() && begun.load(Ordering::SeqCst) < 10_000);
    }
}
