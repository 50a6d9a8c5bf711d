//! What one process is to drive.

use base::progress::Interrupt;

use super::plan::Plan;
use super::run_line::RunLine;
use crate::share::Share;

/// Runs that are to be driven, and how.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// What the runs are.
    pub plan: &'a Plan,
    /// Which of them.
    pub share: Share,
    /// Graphics adapters, besides this machine's, whose recordings are taken as they are.
    pub adapters: &'a [String],
    /// Worlds simulated at the same time.
    pub jobs: usize,
    /// Ends the work early; the same task goes on from there.
    pub interrupt: &'a Interrupt,
}

impl Task<'_> {
    /// The number of its first run, its second one, and so on, counted from 0; `None` after the last one.
    pub fn number(&self, turn: usize) -> Option<u32> {
        let number = u32::try_from(turn).ok().and_then(|turn| self.share.number(turn));
        number.filter(|number| self.plan.goal.end().is_none_or(|end| *number < end))
    }

    /// Whether its first runs are all that it has to drive. What one shard reaches, all of them have reached by then.
    pub fn is_done(&self, runs: &[RunLine]) -> bool {
        self.plan.goal.until.is_met(runs) || self.number(runs.len()).is_none()
    }

    /// How much of how much is done.
    pub fn progress(&self, runs: &[RunLine]) -> (u64, u64) {
        match self.plan.goal.end() {
            Some(end) if self.share != Share::WHOLE => (runs.len() as u64, self.share.count(end).into()),
            _ => self.plan.goal.until.progress(runs),
        }
    }
}
