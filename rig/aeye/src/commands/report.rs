//! One self-contained page about corner cases.

use base::failure::{Failed, Failure};
use base::json::Typed;
use base::output;
use lab::report::{self, Report};
use serde::Serialize;

use crate::cli::ReportArgs;
use crate::exit::Verdict;
use crate::print::print;

/// What the command prints.
#[derive(Serialize)]
struct Summary {
    /// The page.
    report: String,
    /// Corner cases on it.
    cases: usize,
    /// Its size, bytes.
    bytes: usize,
    /// Files that were left out, and why.
    failed: Vec<Failure>,
}

/// What `aeye report` prints.
impl Typed for Summary {
    const TYPE: &'static str = "aeye.report";
}

/// Runs `aeye report`.
pub fn run(args: &ReportArgs, json: bool) -> anyhow::Result<Verdict> {
    output::check_file(&args.out)?;
    let Report { html, cases, failed } = report::render(&args.files, &args.checkpoint, args.size, args.jobs)?;
    output::write_file(&args.out, html.as_bytes())?;
    let summary = Summary { report: args.out.display().to_string(), cases, bytes: html.len(), failed };
    print(json, &summary, || summary.report.clone())?;
    Failed::check(&summary.failed, cases)?;
    Ok(Verdict::Ok)
}
