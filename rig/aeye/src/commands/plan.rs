//! What a plan for two people has, and how far it has come.

use std::path::Path;

use base::json::Typed;
use base::words;
use serde::Serialize;
use study::Protocol;
use study::protocol::{Ended, Progress, Recorded};

use crate::exit::Verdict;
use crate::print;

/// A plan, and what of it is driven.
#[derive(Serialize)]
struct Plan {
    /// Its file.
    plan: String,
    /// All that is to be driven, in order.
    trials: Vec<Planned>,
    /// What each person did in each seat: by checkpoint, too, unless that is not to be known.
    totals: Vec<String>,
    /// Recordings that could not be read.
    not_counted: Vec<String>,
}

/// A trial.
#[derive(Serialize)]
struct Planned {
    /// Its place, map and kilometres.
    trial: String,
    /// Pseudonym of the semantic driver.
    semantic: String,
    /// Pseudonym of the safety driver.
    safety: String,
    /// What the semantic driver sees; nothing where that is not to be known.
    checkpoint: Option<String>,
    /// Whether it is done.
    done: bool,
    /// Its runs that count.
    runs: usize,
    /// Their kilometres.
    km: f64,
    /// Corner cases among them.
    cases: usize,
}

/// What `aeye drive --print-plan` prints.
impl Typed for Plan {
    const TYPE: &'static str = "aeye.plan";
}

/// Prints what a protocol has, and what of it is recorded under a name.
pub fn print(protocol: &Protocol, record: &Path, json: bool) -> anyhow::Result<Verdict> {
    let Recorded { progress, not_counted, .. } = Recorded::under(record, |of| protocol.trial_of(of))?;
    let plan = Plan {
        plan: protocol.path().display().to_string(),
        trials: (0..protocol.trials.len()).map(|trial| planned(protocol, &progress, trial)).collect(),
        totals: progress.totals(protocol),
        not_counted,
    };
    print::print(json, &plan, || text(&plan))?;
    Ok(Verdict::Ok)
}

fn planned(protocol: &Protocol, progress: &Progress, trial: usize) -> Planned {
    let of = &protocol.trials[trial];
    let [semantic, safety] = protocol.seated(of.is_swapped).map(ToString::to_string);
    let counting: Vec<&Ended> = progress.of_trial(trial).filter(|ended| ended.counts).collect();
    Planned {
        trial: protocol.words(trial),
        semantic,
        safety,
        checkpoint: (!protocol.is_blind).then(|| protocol.checkpoints[of.checkpoint].name().into_owned()),
        done: progress.is_done(protocol, trial),
        runs: counting.len(),
        km: Ended::sum_km(counting.iter().copied()),
        cases: counting.iter().filter(|ended| ended.is_case).count(),
    }
}

fn text(plan: &Plan) -> String {
    let line = |trial: &Planned| {
        let Planned { trial, semantic, safety, checkpoint, done, runs, km, cases } = trial;
        let through = checkpoint.as_ref().map(|name| format!(", {name}")).unwrap_or_default();
        let done = if *done { "done" } else { "to drive" };
        let (runs, cases) = (words::count(*runs, "run"), words::count(*cases, "corner case"));
        format!("{trial}{through}: {semantic} semantic, {safety} safety: {done} ({runs}, {km:.2} km, {cases})")
    };
    let lines = plan.trials.iter().map(line).chain(plan.totals.iter().cloned()).chain(plan.not_counted.iter().cloned());
    lines.collect::<Vec<_>>().join("\n")
}
