//! Recordings simulated again and compared with what they hold, tick by tick.

use std::fmt;
use std::path::{Path, PathBuf};

use base::failure::Failure;
use base::json::Typed;
use base::library::{self, Found, Kind};
use base::progress;
use base::say::printable;
use base::spread::{in_order, jobs};
use base::words::count;
use replay::{Divergence, Error, Recording, Report};
use serde::Serialize;

/// What is checked.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Recordings or cases, or folders with such files anywhere below.
    pub files: Vec<PathBuf>,
    /// Also go back this many ticks again and again and compare.
    pub rewind: Option<u16>,
    /// Compare with this recording instead.
    pub against: Option<PathBuf>,
    /// Files checked at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
}

/// What the checks of all files came to.
#[derive(Clone, Debug, Default)]
pub struct Verified {
    /// Files that could be checked.
    pub checked: usize,
    /// Those of them that differ.
    pub diverged: Vec<PathBuf>,
    /// Those that could not be checked, and why.
    pub failed: Vec<Failure>,
}

/// What is printed for a file.
#[derive(Debug, Serialize)]
pub struct Checked {
    /// The file.
    pub file: String,
    /// Ticks simulated and compared.
    pub ticks: u64,
    /// Whether every tick is identical.
    pub ok: bool,
    /// Whether the writer came to its end; if not, up to a second is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finished: Option<bool>,
    /// Keyframes compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keyframes: Option<usize>,
    /// Where it first differs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub divergence: Option<Where>,
    /// Why the file cannot be checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// A line of `aeye verify`, of a file.
impl Typed for Checked {
    const TYPE: &'static str = "aeye.verify";
}

/// Where a replay first differs.
#[derive(Debug, Serialize)]
pub struct Where {
    /// The first tick that differs.
    pub tick: u64,
    /// Part of the state.
    pub part: String,
    /// Number of the road user.
    pub actor: Option<u32>,
    /// Field of the part.
    pub field: String,
    /// What was recorded.
    pub expected: String,
    /// What the replay gave.
    pub got: String,
    /// Tick at which that was read.
    pub seen_at: u64,
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

/// Checks every file, and shows what was found of each, in their order.
pub fn verify(options: &Options, mut show: impl FnMut(&Checked) -> anyhow::Result<()>) -> anyhow::Result<Verified> {
    let Found { files, failed } = library::find(&options.files, Kind::All);
    let bar = progress::bar("verify", files.len() as u64);
    failed.iter().try_for_each(|failure| show(&unchecked(failure)))?;
    let mut verified = Verified { failed, ..Verified::default() };
    in_order(
        jobs(options.jobs),
        files.len(),
        |index| check(&files[index].path, options),
        |index, checked| {
            let path = &files[index].path;
            let checked = checked.unwrap_or_else(|error| {
                let failure = Failure::new(path, &error);
                verified.failed.push(failure.clone());
                unchecked(&failure)
            });
            verified.checked += usize::from(checked.error.is_none());
            verified.diverged.extend(checked.divergence.is_some().then(|| path.clone()));
            bar.inc(1);
            bar.suspend(|| show(&checked))
        },
    )?;
    bar.finish_and_clear();
    Ok(verified)
}

fn unchecked(failure: &Failure) -> Checked {
    let Failure { file, error, .. } = failure.clone();
    Checked { file, ticks: 0, ok: false, finished: None, keyframes: None, divergence: None, error: Some(error) }
}

fn check(file: &Path, options: &Options) -> anyhow::Result<Checked> {
    let recording = Recording::open(file)?;
    let report = reports(&recording, options).or_else(diverged)?;
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
fn reports(recording: &Recording, options: &Options) -> Result<Report, Error> {
    let (log, network) = (recording.log(), recording.network()?);
    let mut report = match &options.against {
        None => replay::verify(log, &network)?,
        Some(path) => {
            let other = Recording::open(path)?;
            replay::against(log, &network, other.log(), &other.network()?)?
        }
    };
    if let (Some(ticks), None) = (options.rewind, &report.divergence) {
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

impl fmt::Display for Checked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&text(self))
    }
}

fn text(checked: &Checked) -> String {
    let (file, ticks) = (printable(&checked.file), count(checked.ticks, "tick"));
    match (&checked.divergence, &checked.error) {
        (_, Some(error)) => format!("{}; not checked", printable(error)),
        (Some(d), None) => {
            let actor = d.actor.map(|a| format!(" of actor {a}")).unwrap_or_default();
            let seen = if d.seen_at == d.tick { String::new() } else { format!(" (read at tick {})", d.seen_at) };
            let Where { tick, part, field, expected, got, .. } = d;
            format!("{file}: diverges at tick {tick}: {part}: {field}{actor}: expected {expected}, got {got}{seen}")
        }
        (None, None) => {
            let cut = if checked.finished == Some(false) { "; its writer was stopped before the end" } else { "" };
            format!("{file}: {ticks} identical{cut}")
        }
    }
}
