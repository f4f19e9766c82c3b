//! Work on several threads, whose results come in order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::sync_channel;

/// Results that wait for their turn at the most, for each thread.
const WAITING: usize = 64;

/// Does `count` pieces of work on `jobs` threads, and hands the results to `each` on this thread, in order, each as soon as all before it
/// are there; until one is refused. Panics of the work are panics here.
///
/// # Errors
/// What `each` refuses with; work that has begun ends, no other begins.
pub fn in_order<T: Send, E>(
    count: usize,
    jobs: usize,
    work: impl Fn(usize) -> T + Sync,
    mut each: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    if jobs <= 1 {
        return (0..count).try_for_each(|i| each(work(i)));
    }
    let (next, is_over) = (AtomicUsize::new(0), AtomicBool::new(false));
    std::thread::scope(|scope| {
        let (sender, results) = sync_channel(WAITING * jobs);
        for _ in 0..jobs.min(count) {
            let sender = sender.clone();
            let (next, is_over, work) = (&next, &is_over, &work);
            scope.spawn(move || {
                while !is_over.load(Ordering::Relaxed) {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    // Nobody takes results any more once one was refused.
                    if i >= count || sender.send((i, work(i))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let (mut early, mut due) = (BTreeMap::new(), 0);
        for (i, result) in results {
            early.insert(i, result);
            while let Some(result) = early.remove(&due) {
                if let Err(refused) = each(result) {
                    is_over.store(true, Ordering::Relaxed);
                    return Err(refused);
                }
                due += 1;
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_whatever_is_done_when() {
        for jobs in [1, 2, 7, 100] {
            let mut seen = Vec::new();
            let work = |i: usize| {
                // The first takes longest.
                (0..10_000 * usize::from(i == 0)).for_each(|_| std::thread::yield_now());
                i * i
            };
            let done: Result<(), ()> = in_order(50, jobs, work, |result| {
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
            let refused = in_order(1_000_000, jobs, work, |i| if i == 10 { Err("enough") } else { Ok(()) });
            assert_eq!(refused, Err("enough"));
            assert!(begun.load(Ordering::Relaxed) < 10_000);
        }
    }
}
