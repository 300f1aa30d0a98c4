//! Parallel work whose results are taken in order.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;

/// Runs `work(0)`..`work(count - 1)` on `jobs` threads and hands the results to `fold` in order, on this thread.
///
/// At most `jobs + waiting` results exist at a time, those being worked on included, however uneven the work: that is why
/// this is no rayon iterator, which would hand each thread a distant range and keep half of the results waiting. Ends
/// early when `fold` fails.
///
/// # Errors
/// The first error of `fold`.
pub(crate) fn in_order<T: Send, E>(
    count: u32,
    jobs: usize,
    waiting: u32,
    work: impl Fn(u32) -> T + Sync,
    mut fold: impl FnMut(u32, T) -> Result<(), E>,
) -> Result<(), E> {
    let jobs = u32::try_from(jobs.max(1)).unwrap_or(u32::MAX).min(count.max(1));
    let gate = Gate::default();
    let (sender, results) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..jobs {
            let (sender, gate, work) = (sender.clone(), &gate, &work);
            scope.spawn(move || {
                // Lets the others end, too, when this thread panics.
                let _open = OpenOnDrop(gate);
                while let Some(index) = gate.take(count, jobs.saturating_add(waiting)) {
                    if sender.send((index, work(index))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let _open = OpenOnDrop(&gate);
        let mut early = BTreeMap::new();
        let mut expected = 0;
        for (index, result) in results {
            early.insert(index, result);
            while let Some(result) = early.remove(&expected) {
                fold(expected, result)?;
                expected += 1;
                gate.folded(expected);
            }
        }
        Ok(())
    })
}

/// Hands out indices in order, no further ahead of the fold than allowed.
#[derive(Default)]
struct Gate {
    state: Mutex<State>,
    moved: Condvar,
}

#[derive(Default)]
struct State {
    next: u32,
    folded: u32,
    stopped: bool,
}

impl Gate {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn take(&self, count: u32, ahead: u32) -> Option<u32> {
        let blocked = |s: &mut State| !s.stopped && s.next < count && s.next - s.folded >= ahead;
        let mut state = self
            .moved
            .wait_while(self.state(), blocked)
            .unwrap_or_else(PoisonError::into_inner);
        if state.stopped || state.next >= count {
            return None;
        }
        state.next += 1;
        Some(state.next - 1)
    }

    fn folded(&self, folded: u32) {
        self.state().folded = folded;
        self.moved.notify_all();
    }
}

/// Stops handing out when a thread ends, for whatever reason: the work is done, the fold failed, or it panicked.
struct OpenOnDrop<'a>(&'a Gate);

impl Drop for OpenOnDrop<'_> {
    fn drop(&mut self) {
        self.0.state().stopped = true;
        self.0.moved.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};
    use std::time::Duration;

    #[test]
    fn results_arrive_in_order_and_not_too_early() {
        for (jobs, waiting) in [(1, 1), (3, 0), (3, 1), (16, 16)] {
            let folded = AtomicU32::new(0);
            let mut seen = Vec::new();
            let work = |i: u32| {
                assert!(i < folded.load(Ordering::SeqCst) + jobs as u32 + waiting);
                // Early indices are slow, so that later ones overtake them.
                thread::sleep(Duration::from_micros(u64::from(400 * (3 - i % 4))));
                i * i
            };
            let fold = |i: u32, square: u32| {
                seen.push((i, square));
                folded.store(i + 1, Ordering::SeqCst);
                Ok::<(), ()>(())
            };
            in_order(40, jobs, waiting, work, fold).unwrap();
            assert_eq!(seen, (0..40).map(|i| (i, i * i)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn an_error_of_the_fold_ends_the_work() {
        let started = AtomicU32::new(0);
        let work = |_| started.fetch_add(1, Ordering::SeqCst);
        let result = in_order(1_000_000, 2, 2, work, |i, _| if i == 5 { Err("full") } else { Ok(()) });
        assert_eq!(result, Err("full"));
        assert!(started.load(Ordering::SeqCst) < 20);
    }

    #[test]
    fn a_panic_is_passed_on_rather_than_waited_for() {
        let run = || in_order(100, 2, 2, |i| assert!(i != 3, "run 3"), |_, ()| Ok::<(), ()>(()));
        assert!(std::panic::catch_unwind(run).is_err());
    }

    #[test]
    fn no_work_is_done_at_once() {
        assert_eq!(in_order(0, 4, 4, |i| i, |_, _| Err("never")), Ok(()));
    }
}
