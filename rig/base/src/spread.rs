//! Work that is spread over threads; what it gives does not depend on how.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread;

/// Calls `work` once for each index below `count` on `jobs` threads, each with a state of its own.
/// After the first error no further index is started; that error is returned.
pub fn on_threads<S>(
    jobs: usize,
    count: usize,
    state: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize) -> anyhow::Result<()> + Sync,
) -> anyhow::Result<()> {
    let next = AtomicUsize::new(0);
    let failed = Mutex::new(None);
    let run = || {
        let mut state = state();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return;
            }
            if let Err(error) = work(&mut state, index) {
                next.store(count, Ordering::Relaxed);
                failed.lock().unwrap_or_else(|e| e.into_inner()).get_or_insert(error);
                return;
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, count.max(1)) {
            scope.spawn(run);
        }
    });
    failed.into_inner().unwrap_or_else(|e| e.into_inner()).map_or(Ok(()), Err)
}

/// Calls `work` once for each index below `count` on `jobs` threads, and `take` with what it gives, in the order
/// of the indices and as early as that allows. After the first error of `take` no further index is started.
pub fn in_order<T: Send>(
    jobs: usize,
    count: usize,
    work: impl Fn(usize) -> T + Sync,
    mut take: impl FnMut(usize, T) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let next = AtomicUsize::new(0);
    let (sender, done) = channel();
    let run = |sender: Sender<(usize, T)>| {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count || sender.send((index, work(index))).is_err() {
                return;
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, count.max(1)) {
            let (run, sender) = (&run, sender.clone());
            scope.spawn(move || run(sender));
        }
        drop(sender);
        let (mut waiting, mut turn) = (BTreeMap::new(), 0);
        for (index, value) in done {
            waiting.insert(index, value);
            while let Some(value) = waiting.remove(&turn) {
                if let Err(error) = take(turn, value) {
                    next.store(count, Ordering::Relaxed);
                    return Err(error);
                }
                turn += 1;
            }
        }
        Ok(())
    })
}

/// What `work` gives for each index below `count`, in their order, found on `jobs` threads.
pub fn collect_in_order<T: Send>(jobs: usize, count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut all = Vec::with_capacity(count);
    let take = |_, value| {
        all.push(value);
        Ok(())
    };
    // Taking never fails, hence nothing does.
    let _ = in_order(jobs, count, work, take);
    all
}

/// The number of threads to use: what was asked for, or one a core.
pub fn jobs(asked: Option<u16>) -> usize {
    asked.map_or_else(|| thread::available_parallelism().map_or(1, usize::from), usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_done_beside_each_other_comes_in_its_order() {
        let mut taken = Vec::new();
        let take = |i, square: usize| {
            assert_eq!(square, i * i);
            taken.push(i);
            Ok(())
        };
        in_order(3, 50, |i| i * i, take).expect("no error");
        assert_eq!(taken, (0..50).collect::<Vec<_>>());
        let stop = |i, ()| if i == 4 { anyhow::bail!("four") } else { Ok(()) };
        assert_eq!(in_order(2, 1000, |_| (), stop).expect_err("fails").to_string(), "four");
    }

    #[test]
    fn every_index_comes_once_and_an_error_ends_it() {
        let seen = Mutex::new(Vec::new());
        let note = |_: &mut (), i: usize| {
            seen.lock().expect("no panic").push(i);
            Ok(())
        };
        on_threads(3, 20, || (), note).expect("no error");
        let mut all = seen.into_inner().expect("no panic");
        all.sort_unstable();
        assert_eq!(all, (0..20).collect::<Vec<_>>());
        let failing = |_: &mut (), i: usize| if i == 5 { anyhow::bail!("five") } else { Ok(()) };
        assert_eq!(on_threads(2, 1000, || (), failing).expect_err("fails").to_string(), "five");
    }
}
