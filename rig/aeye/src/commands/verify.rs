//! Simulates recordings again and compares every tick.

use std::path::Path;

use base::failure::{Failed, Failure};
use base::json::Typed;
use base::library::{self, Found, Kind};
use base::progress;
use base::spread::{in_order, jobs};
use replay::{Divergence, Error, Recording, Report};
use serde::Serialize;

use crate::cli::VerifyArgs;
use crate::exit::Verdict;
use crate::print::print;

/// What is printed for a file.
#[derive(Debug, Serialize)]
struct Checked {
    /// The file.
    file: String,
    /// Ticks simulated and compared.
    ticks: u64,
    /// Whether every tick is identical.
    ok: bool,
    /// Whether the writer came to its end; if not, up to a second is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    finished: Option<bool>,
    /// Keyframes compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    keyframes: Option<usize>,
    /// Where it first differs.
    #[serde(skip_serializing_if = "Option::is_none")]
    divergence: Option<Where>,
    /// Why the file cannot be checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

/// A line of `aeye verify`, of a file.
impl Typed for Checked {
    const TYPE: &'static str = "aeye.verify";
}

/// Where a replay first differs.
#[derive(Debug, Serialize)]
struct Where {
    /// The first tick that differs.
    tick: u64,
    /// Part of the state.
    part: String,
    /// Number of the road user.
    actor: Option<u32>,
    /// Field of the part.
    field: String,
    /// What was recorded.
    expected: String,
    /// What the replay gave.
    got: String,
    /// Tick at which that was read.
    seen_at: u64,
}

impl From<Divergence> for Where {
    fn from(d: Divergence) -> Self {
        Self {
            tick: d.tick,
            part: d.part,
            actor: d.actor,
            field: d.field,
            expected: d.expected,
            got: d.got,
            seen_at: d.seen_at,
        }
    }
}

/// Runs `aeye verify`.
pub fn run(args: &VerifyArgs, json: bool) -> anyhow::Result<Verdict> {
    let Found { files, mut failed } = library::find(&args.files, Kind::All);
    let bar = progress::bar("verify", files.len() as u64);
    let (mut diverged, mut well) = (false, 0);
    let show = |checked: &Checked| bar.suspend(|| print(json, checked, || text(checked)));
    failed.iter().try_for_each(|failure| show(&unchecked(failure)))?;
    in_order(
        jobs(args.jobs),
        files.len(),
        |index| check(&files[index].path, args),
        |index, checked| {
            let checked = checked.unwrap_or_else(|error| {
                let failure = Failure::new(&files[index].path, &error);
                failed.push(failure.clone());
                unchecked(&failure)
            });
            diverged |= checked.divergence.is_some();
            well += usize::from(checked.error.is_none());
            bar.inc(1);
            show(&checked)
        },
    )?;
    bar.finish_and_clear();
    Failed::check(&failed, well)?;
    Ok(Verdict::of_check(!diverged))
}

fn unchecked(failure: &Failure) -> Checked {
    let Failure { file, error, .. } = failure.clone();
    Checked { file, ticks: 0, ok: false, finished: None, keyframes: None, divergence: None, error: Some(error) }
}

fn check(file: &Path, args: &VerifyArgs) -> anyhow::Result<Checked> {
    let recording = Recording::open(file)?;
    let report = reports(&recording, args).or_else(diverged)?;
    Ok(Checked {
        file: file.display().to_string(),
        ticks: report.ticks,
        ok: report.divergence.is_none(),
        finished: Some(recording.finished()),
        keyframes: Some(report.keyframes),
        divergence: report.divergence.map(Where::from),
        error: None,
    })
}

/// The checks that were asked for, up to the first that fails.
fn reports(recording: &Recording, args: &VerifyArgs) -> Result<Report, Error> {
    let (log, network) = (recording.log(), recording.network()?);
    let mut report = match &args.against {
        None => replay::verify(log, &network)?,
        Some(path) => {
            let other = Recording::open(path)?;
            replay::against(log, &network, other.log(), &other.network()?)?
        }
    };
    if let (Some(ticks), None) = (args.rewind, &report.divergence) {
        report.divergence = replay::rewind(log, &network, ticks.into())?.divergence;
    }
    Ok(report)
}

/// A divergence that stopped the replay is a result, not an error.
fn diverged(error: Error) -> Result<Report, Error> {
    match error {
        Error::Diverged(divergence) => {
            Ok(Report { ticks: divergence.tick, keyframes: 0, divergence: Some(*divergence) })
        }
        error => Err(error),
    }
}

fn text(checked: &Checked) -> String {
    let Checked { file, ticks, .. } = checked;
    match (&checked.divergence, &checked.error) {
        (_, Some(error)) => format!("{file}: not checked: {error}"),
        (Some(d), None) => {
            let actor = d.actor.map(|a| format!(" of actor {a}")).unwrap_or_default();
            let seen = if d.seen_at == d.tick { String::new() } else { format!(" (read at tick {})", d.seen_at) };
            let Where { tick, part, field, expected, got, .. } = d;
            format!("{file}: diverges at tick {tick}: {part}: {field}{actor}: expected {expected}, got {got}{seen}")
        }
        (None, None) => {
            let cut = if checked.finished == Some(false) { "; its writer was stopped before the end" } else { "" };
            format!("{file}: {ticks} ticks identical{cut}")
        }
    }
}
