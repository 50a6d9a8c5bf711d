//! What runs came to, and how far a protocol has come with them.

use std::path::Path;

use base::failure::Usage;
use base::library;
use kernel::World;
use kernel::arbiter::Outcome;
use kernel::time::Tick;
use replay::{Annotation, Label, Log, Provenance, Recording};

use super::Protocol;

/// What a run came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ended {
    /// Distance, millimetres.
    pub odometer_mm: u64,
    /// Simulated time, ticks.
    pub ticks: Tick,
    /// It is a corner case.
    pub is_case: bool,
    /// It came to an end of its own, and was not stopped from outside.
    pub is_over: bool,
    /// It counts as driven.
    pub counts: bool,
}

impl Ended {
    /// A run that has ended, of which this was said; as [`Log::decided_at`] and [`Log::counts`] have it.
    pub fn of_world(world: &World, annotation: Option<&Annotation>) -> Self {
        let said = annotation.map(|annotation| annotation.label);
        let arbiter = world.arbiter();
        let is_case = arbiter.intervention.is_some() || arbiter.outcome == Some(Outcome::Missed);
        Self {
            odometer_mm: world.odometer_mm(),
            ticks: world.tick(),
            is_case: is_case && said.is_none_or(Label::is_case),
            is_over: arbiter.outcome.is_some(),
            counts: said.is_none_or(Label::counts),
        }
    }

    /// A recorded run; drives for familiarisation do not count.
    pub fn of_log(log: &Log) -> Self {
        Self {
            odometer_mm: log.odometer_mm(),
            ticks: log.last_tick(),
            is_case: log.decided_at().is_some(),
            is_over: log.summary.as_ref().is_some_and(|summary| summary.outcome.is_some()),
            counts: log.counts() && !crate::is_familiarisation(&log.manifest.provenance),
        }
    }

    /// Kilometres of several runs.
    pub fn sum_km<'a>(runs: impl Iterator<Item = &'a Self>) -> f64 {
        runs.map(|ended| ended.odometer_mm).sum::<u64>() as f64 / 1e6
    }
}

/// The runs so far, each with its trial.
#[derive(Clone, Debug, Default)]
pub struct Progress(Vec<(usize, Ended)>);

/// The runs under a name.
#[derive(Clone, Debug, Default)]
pub struct Recorded {
    /// Number of the last one; 0 without any.
    pub last: u32,
    /// Those whose recordings could be read.
    pub progress: Progress,
    /// What is to be said of the others.
    pub not_counted: Vec<String>,
}

impl Recorded {
    /// Reads the recordings under a name; `trial_of` says which trial one is of by its provenance, or refuses it.
    pub fn under(record: &Path, trial_of: impl Fn(&Provenance) -> Result<usize, String>) -> anyhow::Result<Self> {
        let mut recorded = Self::default();
        for number in library::numbers(record) {
            recorded.last = number;
            let path = library::numbered(record, number);
            match Recording::open(&path) {
                Ok(recording) => {
                    let log = recording.log();
                    let trial = trial_of(&log.manifest.provenance);
                    let trial = trial.map_err(|reason| Usage(format!("{}: {reason}", path.display())))?;
                    recorded.progress.add(trial, Ended::of_log(log));
                }
                Err(error) => recorded.not_counted.push(format!("not counted: {error:#}")),
            }
        }
        Ok(recorded)
    }
}

impl Progress {
    /// Adds a run.
    pub fn add(&mut self, trial: usize, ended: Ended) {
        self.0.push((trial, ended));
    }

    /// All runs.
    pub fn runs(&self) -> impl Iterator<Item = &Ended> {
        self.0.iter().map(|(_, ended)| ended)
    }

    /// The runs of a trial.
    pub fn of_trial(&self, trial: usize) -> impl Iterator<Item = &Ended> {
        self.0.iter().filter(move |(of, _)| *of == trial).map(|(_, ended)| ended)
    }

    /// The first trial that is not done: with kilometres, as long as those that count are fewer; without, until a run
    /// that counts came to its end. None once all are done.
    pub fn next(&self, protocol: &Protocol) -> Option<usize> {
        (0..protocol.trials.len()).find(|trial| !self.is_done(protocol, *trial))
    }

    /// Whether a trial is done.
    pub fn is_done(&self, protocol: &Protocol, trial: usize) -> bool {
        let mut counting = self.of_trial(trial).filter(|ended| ended.counts);
        match protocol.trials[trial].km {
            Some(km) => Ended::sum_km(counting) >= km,
            None => counting.any(|ended| ended.is_over),
        }
    }

    /// What each of both did in each seat so far, a line each: by checkpoint, too, unless that is not to be known.
    pub fn totals(&self, protocol: &Protocol) -> Vec<String> {
        let kinds = if protocol.is_blind { 1 } else { protocol.checkpoints.len() };
        let seats = [false, true].into_iter().flat_map(|is_swapped| (0..kinds).map(move |kind| (is_swapped, kind)));
        let line = |(is_swapped, kind): (bool, usize)| {
            let is_of = |trial: usize| {
                let trial = &protocol.trials[trial];
                trial.is_swapped == is_swapped && (protocol.is_blind || trial.checkpoint == kind)
            };
            let runs: Vec<&Ended> = self.0.iter().filter(|(trial, _)| is_of(*trial)).map(|(_, ended)| ended).collect();
            let counting = || runs.iter().filter(|ended| ended.counts);
            let [semantic, safety] = protocol.seated(is_swapped);
            let through = match protocol.is_blind {
                true => String::new(),
                false => format!(" through {}", protocol.checkpoints[kind].name()),
            };
            let km = Ended::sum_km(counting().copied());
            let minutes =
                counting().map(|ended| ended.ticks).sum::<Tick>() as f64 / f64::from(60 * kernel::time::TICK_HZ);
            let cases = counting().filter(|ended| ended.is_case).count();
            let counted = counting().count();
            (!runs.is_empty()).then(|| {
                format!(
                    "{semantic} semantic, {safety} safety{through}: {}, {km:.2} km, {minutes:.1} min, {}",
                    base::words::count(counted, "run"),
                    base::words::count(cases, "corner case"),
                )
            })
        };
        seats.filter_map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn protocol(km: &str) -> Protocol {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("plan.toml");
        let condition = |checkpoint: &str| format!("[[conditions]]\ncheckpoint = \"{checkpoint}\"\n{km}\n");
        let text = format!("participants = [\"P07\", \"P03\"]\n{}{}", condition("early"), condition("full"));
        std::fs::write(&path, text).expect("written");
        Protocol::read(&path).expect("valid")
    }

    const KM: Ended = Ended { odometer_mm: 1_000_000, ticks: 3600, is_case: false, is_over: true, counts: true };

    #[test]
    fn a_trial_is_done_by_a_run_that_counts_and_was_not_stopped() {
        let protocol = protocol("");
        let mut progress = Progress::default();
        assert_eq!(progress.next(&protocol), Some(0));
        for not_done in [Ended { is_over: false, ..KM }, Ended { counts: false, ..KM }] {
            progress.add(0, not_done);
            assert_eq!(progress.next(&protocol), Some(0));
        }
        (0..4).for_each(|trial| {
            progress.add(trial, KM);
            assert_eq!(progress.next(&protocol), Some(trial + 1).filter(|next| *next < 4));
        });
    }

    #[test]
    fn kilometres_are_driven_in_as_many_runs_as_it_takes_stopped_ones_among_them() {
        let protocol = protocol("km = 2.5");
        let mut progress = Progress::default();
        for ended in [KM, Ended { counts: false, ..KM }, Ended { is_over: false, ..KM }] {
            progress.add(0, ended);
            assert_eq!(progress.next(&protocol), Some(0));
        }
        progress.add(0, KM);
        assert_eq!(progress.next(&protocol), Some(1));
    }

    #[test]
    fn totals_are_those_of_each_person_seat_and_checkpoint_unless_it_is_blind() {
        let mut protocol = protocol("");
        let mut progress = Progress::default();
        let case = Ended { is_case: true, ..KM };
        let runs = [(0, case), (0, Ended { counts: false, ..KM }), (1, KM), (3, KM)];
        runs.into_iter().for_each(|(trial, ended)| progress.add(trial, ended));
        assert_eq!(
            progress.totals(&protocol),
            [
                "P07 semantic, P03 safety through early: 1 run, 1.00 km, 1.0 min, 1 corner case",
                "P07 semantic, P03 safety through full: 1 run, 1.00 km, 1.0 min, 0 corner cases",
                "P03 semantic, P07 safety through early: 1 run, 1.00 km, 1.0 min, 0 corner cases",
            ]
        );
        protocol.is_blind = true;
        assert_eq!(progress.totals(&protocol)[0], "P07 semantic, P03 safety: 2 runs, 2.00 km, 2.0 min, 1 corner case");
    }
}
