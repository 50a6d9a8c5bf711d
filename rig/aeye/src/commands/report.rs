//! One self-contained page about corner cases.

use base::{library, output};
use lab::report;
use serde::Serialize;

use crate::cli::ReportArgs;
use crate::exit::Verdict;
use crate::print::print;

/// What the command prints.
#[derive(Serialize)]
struct Summary {
    report: String,
    cases: usize,
    bytes: usize,
}

/// Runs `aeye report`.
pub fn run(args: &ReportArgs, json: bool) -> anyhow::Result<Verdict> {
    output::check_file(&args.out)?;
    let files = library::cases(&args.files)?;
    let html = report::render(&files, &args.checkpoint, args.size)?;
    output::write_file(&args.out, html.as_bytes())?;
    let summary = Summary { report: args.out.display().to_string(), cases: files.len(), bytes: html.len() };
    print(json, &summary, || summary.report.clone())?;
    Ok(Verdict::Ok)
}
