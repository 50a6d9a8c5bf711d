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

/// What the threads share: who has nothing left to do for a checkpoint goes on with the next one, while others end their runs.
struct Pool<'a> {
    task: &'a Task<'a>,
    lanes: Vec<Lane<'a>>,
    bar: Bar,
    failure: Mutex<Option<anyhow::Error>>,
}

/// The runs of one checkpoint.
struct Lane<'a> {
    eye: &'a Eye,
    aside: Aside,
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
}

/// Drives a task's runs of each checkpoint until there are enough, and gives them in order.
pub fn drive_all(task: &Task<'_>, eyes: &[Eye]) -> anyhow::Result<Vec<Vec<RunLine>>> {
    let lane = |eye| Lane { eye, aside: Aside::new(&task.plan.out, Eye::name(eye)), state: Mutex::default() };
    let bar = progress::bar("campaign", task.progress(&[]).1 * eyes.len() as u64);
    let pool = Pool { task, lanes: eyes.iter().map(lane).collect(), bar, failure: Mutex::default() };
    std::thread::scope(|scope| {
        for _ in 0..task.jobs {
            scope.spawn(|| pool.work());
        }
    });
    pool.bar.finish_and_clear();
    match owned(pool.failure) {
        Some(failure) => Err(failure),
        None => pool.lanes.into_iter().map(|lane| lane.runs(task)).collect(),
    }
}

impl Pool<'_> {
    /// Drives until there are enough runs of all checkpoints.
    fn work(&self) {
        let each = self.lanes.iter().try_for_each(|lane| self.work_on(lane));
        if let Err(error) = each {
            locked(&self.failure).get_or_insert(error);
        }
    }

    /// Takes one run of a checkpoint after the other until there are enough.
    fn work_on(&self, lane: &Lane<'_>) -> anyhow::Result<()> {
        let mut runner = Runner::new(self.task, lane.eye, &lane.aside);
        while let Some((turn, run)) = self.take(lane) {
            let Some(driven) = runner.drive(run)? else { return Ok(()) };
            lane.put(self.task, turn, driven)?;
            self.show(lane);
        }
        Ok(())
    }

    /// The next turn, and the number of its run.
    fn take(&self, lane: &Lane<'_>) -> Option<(usize, u32)> {
        let mut state = locked(&lane.state);
        if locked(&self.failure).is_some() || self.task.interrupt.is_raised() || self.task.is_done(&state.runs) {
            return None;
        }
        let turn = state.next;
        let run = self.task.number(turn)?;
        state.next += 1;
        Some((turn, run))
    }

    fn show(&self, lane: &Lane<'_>) {
        let done = self.lanes.iter().map(|lane| self.task.progress(&locked(&lane.state).runs).0);
        self.bar.set_message(lane.eye.name().to_owned());
        self.bar.set_position(done.sum());
    }
}

impl Lane<'_> {
    /// Counts a run in its turn, and those that waited for it.
    fn put(&self, task: &Task<'_>, turn: usize, driven: Driven) -> anyhow::Result<()> {
        let mut state = locked(&self.state);
        state.waiting.insert(turn, driven);
        while !task.is_done(&state.runs) {
            let turn = state.runs.len();
            let Some(driven) = state.waiting.remove(&turn) else { break };
            state.runs.push(driven.keep(&self.aside)?);
            let goal = task.plan.goal;
            if goal.end().is_none() && goal.until.is_out_of_reach(&state.runs) {
                bail!(
                    "{}: {STALLED_RUNS} runs in a row brought the campaign no further; expected a checkpoint that drives, \
                     and traffic that makes such corner cases",
                    self.eye.name()
                );
            }
        }
        Ok(())
    }

    /// All runs that count.
    fn runs(self, task: &Task<'_>) -> anyhow::Result<Vec<RunLine>> {
        let runs = owned(self.state).runs;
        if !task.is_done(&runs) {
            bail!("interrupted after {}; the same command goes on from there", words::count(runs.len(), "run"));
        }
        self.aside.clear()?;
        Ok(runs)
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

fn owned<T>(mutex: Mutex<T>) -> T {
    mutex.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner())
}
