//! The comparison as tables on stdout.

use std::fmt::{self, Write};

use base::words::count;

use super::super::figures::decimal;
use super::contest::Difference;
use super::metrics::Metric;
use super::summary::{CaseLine, Compared, LookLine, Scoreboard, Speed};

/// With fewer cases than these, intervals are not to be trusted.
const FEW_CASES: usize = 10;

impl fmt::Display for Compared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&all(self))
    }
}

fn all(compared: &Compared) -> String {
    let summary = &compared.summary;
    let mut lines = metrics(summary);
    lines.push(String::new());
    lines.extend(cases(summary));
    lines.push(String::new());
    lines.extend(summary.checkpoints.iter().filter_map(|checkpoint| {
        let contest = checkpoint.against_baseline.as_ref()?;
        let (baseline, name) = (&summary.checkpoints[0].name, &checkpoint.name);
        let (fixed, broken, unchanged) = (contest.fixed, contest.broken, contest.unchanged);
        let none = contest.no_hazard;
        Some(format!("{name} against {baseline}: {fixed} fixed, {broken} broken, {unchanged} unchanged, {none} without a hazard to see"))
    }));
    let few = summary.cases.len() < FEW_CASES;
    lines.extend(few.then(|| {
        format!("{}: too few, intervals from drawing them again are too narrow", count(summary.cases.len(), "case"))
    }));
    lines.extend(summary.gates.iter().map(|passage| passage.sentence.clone()));
    lines.extend(compared.speed.as_ref().map(speed));
    lines.join("\n")
}

/// A difference with its interval, as in `+0.280 [+0.210, +0.310]`.
pub fn difference(difference: &Difference) -> String {
    let Some(value) = difference.difference else { return "-".into() };
    let interval = difference.interval_95.map(|(low, high)| format!(" [{low:+.3}, {high:+.3}]"));
    format!("{value:+.3}{}", interval.unwrap_or_default())
}

/// A row for each figure.
fn metrics(summary: &Scoreboard) -> Vec<String> {
    let mut head = format!("{:<26}", "");
    let rows_of = || Metric::OWN.into_iter().chain(Metric::OF_TRUST);
    let mut rows: Vec<String> = rows_of().map(|metric| format!("{:<26}", metric.title())).collect();
    for checkpoint in &summary.checkpoints {
        // Writing to a string cannot fail.
        let _ = write!(head, " {:>12}", checkpoint.name);
        for (row, metric) in rows.iter_mut().zip(rows_of()) {
            let _ = write!(row, " {:>12}", decimal(checkpoint.own(metric)));
        }
        let Some(contest) = &checkpoint.against_baseline else { continue };
        let _ = write!(head, "  {:<25}", "difference [95 %]");
        let differences = contest.differences.iter().map(difference).chain(std::iter::repeat(String::new()));
        for (row, each) in rows.iter_mut().zip(differences) {
            let _ = write!(row, "  {each:<25}");
        }
    }
    std::iter::once(head).chain(rows).map(|line| line.trim_end().to_owned()).collect()
}

/// A row for each case.
fn cases(summary: &Scoreboard) -> Vec<String> {
    let name = summary.cases.iter().map(|case| case.file.len()).max().unwrap_or(0).max("case".len());
    let hazard = summary.cases.iter().map(|case| words(case).len()).max().unwrap_or(0).max("hazard".len());
    let mut head = format!("{:<name$}  {:<hazard$}", "case", "hazard");
    summary.checkpoints.iter().for_each(|checkpoint| {
        let _ = write!(head, "  {:<20}", format!("{} sees it", checkpoint.name));
    });
    let row = |case: &CaseLine| {
        let mut row = format!("{:<name$}  {:<hazard$}", case.file, words(case));
        case.checkpoints.iter().for_each(|look| {
            let verdict = look.verdict.map(|verdict| format!(", {}", verdict.words())).unwrap_or_default();
            let _ = write!(row, "  {:<20}", format!("{}{verdict}", sight(look)));
        });
        row.trim_end().to_owned()
    };
    std::iter::once(head.trim_end().to_owned()).chain(summary.cases.iter().map(row)).collect()
}

fn words(case: &CaseLine) -> &str {
    case.hazard.as_deref().unwrap_or("-")
}

/// How long before the intervention a hazard is first seen.
pub fn sight(look: &LookLine) -> String {
    match (look.first_sight_s, look.first_seen_tick) {
        (None, _) => "-".into(),
        (Some(_), None) => "never".into(),
        (Some(s), Some(_)) => format!("{s:.1} s before"),
    }
}

fn speed(speed: &Speed) -> String {
    let Speed { frames, checkpoints, seconds, frames_per_s, alone, share_of_slower } = speed;
    let (frames, checkpoints) = (count(*frames, "frame"), count(*checkpoints, "checkpoint"));
    let together = format!("{frames} through {checkpoints} in {seconds:.1} s: {frames_per_s:.1} frames/s");
    match alone.zip(*share_of_slower) {
        Some((alone, share)) => format!(
            "{together}; alone, rendering {:.1} and inference {:.1} frames/s, of the slower of which that is {:.0} %",
            alone.render_fps,
            alone.inference_fps,
            100.0 * share
        ),
        None => together,
    }
}
