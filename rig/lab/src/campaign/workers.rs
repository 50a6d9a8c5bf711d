//! Threads that drive, each a world of its own, and the order in which their runs count.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard};

use anyhow::bail;
use base::progress::{self, Bar};
use base::words;
use drivers::vision::Eye;

use super::aside::Aside;
use super::run_line::RunLine;
use super::runner::{Driven, Runner};
use super::task::Task;
use super::until::STALLED_RUNS;

/// What the threads share.
struct Pool<'a> {
    task: &'a Task<'a>,
    eye: &'a Eye,
    aside: &'a Aside,
    bar: Bar,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    /// The turn that is driven next; the runs of a task have turns 0, 1, 2 ...
    next: usize,
    /// The runs of the first turns without a gap; all of their files are there.
    runs: Vec<RunLine>,
    /// Runs that were done before their turn. Only in their turn it is known whether they count, so that
    /// no others come among the results, however a campaign ends.
    waiting: BTreeMap<usize, Driven>,
    failure: Option<anyhow::Error>,
}

/// Drives a task's runs of one checkpoint until there are enough, and gives them in order.
pub fn drive_all(task: &Task<'_>, eye: &Eye) -> anyhow::Result<Vec<RunLine>> {
    let bar = progress::bar(eye.name(), task.progress(&[]).1);
    let aside = &Aside::new(&task.plan.out, eye.name());
    let pool = Pool { task, eye, aside, bar, state: Mutex::default() };
    std::thread::scope(|scope| {
        for _ in 0..task.jobs {
            scope.spawn(|| pool.work());
        }
    });
    pool.bar.finish_and_clear();
    let State { runs, failure, .. } = pool.state.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    if let Some(failure) = failure {
        return Err(failure);
    }
    if !task.is_done(&runs) {
        bail!("interrupted after {}; the same command goes on from there", words::count(runs.len(), "run"));
    }
    aside.clear()?;
    Ok(runs)
}

impl Pool<'_> {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Takes one run after the other until there are enough.
    fn work(&self) {
        let mut runner = Runner::new(self.task, self.eye, self.aside);
        while let Some((turn, run)) = self.take() {
            let put = runner.drive(run).and_then(|driven| driven.map(|driven| self.put(turn, driven)).transpose());
            match put {
                Ok(Some(())) => {}
                Ok(None) => return,
                Err(error) => {
                    self.state().failure.get_or_insert(error);
                    return;
                }
            }
        }
    }

    /// The next turn, and the number of its run.
    fn take(&self) -> Option<(usize, u32)> {
        let mut state = self.state();
        if state.failure.is_some() || self.task.interrupt.is_raised() || self.task.is_done(&state.runs) {
            return None;
        }
        let turn = state.next;
        let run = self.task.number(turn)?;
        state.next += 1;
        Some((turn, run))
    }

    /// Counts a run in its turn, and those that waited for it.
    fn put(&self, turn: usize, driven: Driven) -> anyhow::Result<()> {
        let mut state = self.state();
        state.waiting.insert(turn, driven);
        while !self.task.is_done(&state.runs) {
            let turn = state.runs.len();
            let Some(driven) = state.waiting.remove(&turn) else { break };
            state.runs.push(driven.keep(self.aside)?);
            let goal = self.task.plan.goal;
            if goal.end().is_none() && goal.until.is_out_of_reach(&state.runs) {
                bail!(
                    "{}: {STALLED_RUNS} runs in a row brought the campaign no further; expected a checkpoint that drives, \
                     and traffic that makes such corner cases",
                    self.eye.name()
                );
            }
        }
        self.bar.set_position(self.task.progress(&state.runs).0);
        Ok(())
    }
}
