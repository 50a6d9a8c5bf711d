//! Threads that drive, each a world of its own, and the order in which their runs count.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard};

use anyhow::bail;
use base::progress::{self, Bar, Interrupt};
use base::words;
use drivers::vision::Eye;

use super::aside::Aside;
use super::plan::Plan;
use super::run_line::RunLine;
use super::runner::{Driven, Runner};
use super::until::{STALLED_RUNS, Until};

/// What the threads share.
struct Pool<'a> {
    plan: &'a Plan,
    eye: &'a Eye,
    aside: &'a Aside,
    interrupt: &'a Interrupt,
    bar: Bar,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    /// The run that is driven next.
    next: u32,
    /// The runs from the first on without a gap; all of their files are there.
    runs: Vec<RunLine>,
    /// Runs that were done before their turn. Only in their turn it is known whether they count, so that
    /// no others come among the results, however a campaign ends.
    waiting: BTreeMap<u32, Driven>,
    failure: Option<anyhow::Error>,
}

/// Drives the runs of one checkpoint until there are enough, and gives them in order.
pub fn drive_all(plan: &Plan, eye: &Eye, jobs: usize, interrupt: &Interrupt) -> anyhow::Result<Vec<RunLine>> {
    let bar = progress::bar(eye.name(), plan.until.progress(&[]).1);
    let aside = &Aside::new(&plan.out, eye.name());
    let pool = Pool { plan, eye, aside, interrupt, bar, state: Mutex::default() };
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| pool.work());
        }
    });
    pool.bar.finish_and_clear();
    let State { runs, failure, .. } = pool.state.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    if let Some(failure) = failure {
        return Err(failure);
    }
    if !plan.until.is_met(&runs) {
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
        let mut runner = Runner::new(self.plan, self.eye, self.aside, self.interrupt);
        while let Some(run) = self.take() {
            let put = runner.drive(run).and_then(|driven| driven.map(|driven| self.put(run, driven)).transpose());
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

    fn take(&self) -> Option<u32> {
        let mut state = self.state();
        if state.failure.is_some() || self.interrupt.is_raised() || self.plan.until.is_met(&state.runs) {
            return None;
        }
        // Only runs can be counted before they are driven.
        if matches!(self.plan.until, Until::Runs(n) if state.next >= n) {
            return None;
        }
        state.next += 1;
        Some(state.next - 1)
    }

    /// Counts a run in its turn, and those that waited for it.
    fn put(&self, run: u32, driven: Driven) -> anyhow::Result<()> {
        let mut state = self.state();
        state.waiting.insert(run, driven);
        while !self.plan.until.is_met(&state.runs) {
            let turn = state.runs.len() as u32;
            let Some(driven) = state.waiting.remove(&turn) else { break };
            state.runs.push(driven.keep(self.aside)?);
            if self.plan.until.is_out_of_reach(&state.runs) {
                bail!(
                    "{}: {STALLED_RUNS} runs in a row brought the campaign no further; expected a checkpoint that drives, \
                     and traffic that makes such corner cases",
                    self.eye.name()
                );
            }
        }
        self.bar.set_position(self.plan.until.progress(&state.runs).0);
        Ok(())
    }
}
