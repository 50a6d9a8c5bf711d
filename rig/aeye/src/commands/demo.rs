//! The main job from end to end: drive through the early checkpoint until three corner cases have
//! happened, verify every recording, draw the cases again through both checkpoints, and report.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use base::json::Typed;
use base::output::{self, OutputFolder};
use base::progress::Interrupt;
use drivers::checkpoint::CheckpointChoice;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use lab::campaign::{self, CampaignFigures, Until};
use lab::report;
use render::AdapterChoice;
use serde::Serialize;

use crate::cli::{DemoArgs, RerenderArgs, VerifyArgs};
use crate::commands::{rerender, verify};
use crate::exit::Verdict;
use crate::print::print;

/// Corner cases that the demo waits for.
const CASES: u32 = 3;
/// Longest simulated time of a run, seconds.
const RUN_SECONDS: u32 = 180;

/// What the command prints at the end.
#[derive(Serialize)]
struct Summary {
    /// The page.
    report: String,
    /// Runs that were driven.
    runs: usize,
    /// Corner cases.
    cases: usize,
    /// Kilometres driven.
    km: f64,
}

/// The last line of `aeye demo`.
impl Typed for Summary {
    const TYPE: &'static str = "aeye.demo";
}

/// Runs `aeye demo`.
pub fn run(args: &DemoArgs, json: bool) -> anyhow::Result<Verdict> {
    AdapterChoice::default().find()?;
    let _folder = OutputFolder::open(&args.out)?;
    let (early, full) = (CheckpointChoice::Bundled("early"), CheckpointChoice::Bundled("full"));
    let drives = args.out.join("drives");
    eprintln!("1/4 driving through the early checkpoint until {CASES} corner cases have happened");
    let figures = campaign::drive(&campaign_options(args, early.clone(), &drives), &Interrupt::listen()?)?;
    eprintln!("2/4 verifying every recording");
    let files = files(&drives, &figures);
    if verify::run(&VerifyArgs { files: files.all, rewind: None, against: None, jobs: args.jobs }, json)? != Verdict::Ok
    {
        return Ok(Verdict::CheckFailed);
    }
    eprintln!("3/4 drawing the corner cases again through both checkpoints");
    let both = vec![early, full];
    let rerendered = rerender_args(args, &files.cases, &both)?;
    if rerender::run(&rerendered, json)? != Verdict::Ok {
        return Ok(Verdict::CheckFailed);
    }
    eprintln!("4/4 writing the report");
    let path = args.out.join("report.html");
    output::write_file(&path, report::render(&files.cases, &both, None, args.jobs)?.html.as_bytes())?;
    let path = fs::canonicalize(&path).with_context(|| path.display().to_string())?;
    let summary = Summary {
        report: path.display().to_string(),
        runs: figures.runs.len(),
        cases: files.cases.len(),
        km: figures.km,
    };
    print(json, &summary, || summary.report.clone())?;
    Ok(Verdict::Ok)
}

fn campaign_options(args: &DemoArgs, checkpoint: CheckpointChoice, out: &Path) -> campaign::Options {
    campaign::Options {
        checkpoint: vec![checkpoint],
        maps: vec!["all".into()],
        scenario: None,
        until: Until::Cases(CASES),
        pedestrians: None,
        run_seconds: RUN_SECONDS,
        seed: args.seed,
        jobs: args.jobs,
        out: out.to_owned(),
    }
}

/// The window of every case through every checkpoint; what an earlier demo drew is kept.
fn rerender_args(args: &DemoArgs, cases: &[PathBuf], checkpoint: &[CheckpointChoice]) -> anyhow::Result<RerenderArgs> {
    let out = args.out.join("rerendered");
    let (last, fps) = (CLIP_TICKS, CLIP_FPS);
    Ok(RerenderArgs {
        files: cases.to_vec(),
        checkpoint: checkpoint.to_vec(),
        last,
        fps,
        size: None,
        jobs: args.jobs,
        out,
    })
}

/// The files of a campaign.
struct Files {
    /// Recordings and cases.
    all: Vec<PathBuf>,
    cases: Vec<PathBuf>,
}

fn files(folder: &Path, figures: &CampaignFigures) -> Files {
    let recordings = figures.runs.iter().map(|run| folder.join(&run.file));
    let cases: Vec<PathBuf> =
        figures.runs.iter().filter_map(|run| run.case.as_ref()).map(|case| folder.join(case)).collect();
    Files { all: recordings.chain(cases.iter().cloned()).collect(), cases }
}
