//! The main job from end to end: drive through the early checkpoint until three corner cases have
//! happened, verify every recording, draw the cases again through both checkpoints, and report.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use base::failure::{Failed, Failure};
use base::json::Typed;
use base::output::{self, OutputFolder};
use base::progress::Interrupt;
use base::say::say;
use drivers::checkpoint::CheckpointChoice;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use render::{AdapterChoice, Imaging};
use serde::Serialize;

use crate::campaign::{self, CampaignFigures, Until};
use crate::report;
use crate::rerender::{self, Rerendered, rerender};
use crate::verify::{self, Checked, verify};

/// Corner cases that the demo waits for.
const CASES: u32 = 3;
/// Longest simulated time of a run, seconds.
const RUN_SECONDS: u32 = 60;
/// Where people walk.
const MAPS: [&str; 3] = ["city", "old_town", "suburb"];
/// A scenario in which three cases do not take long, and the name of its file in the demo's folder.
const SCENARIO: &str = include_str!("demo.toml");
const SCENARIO_FILE: &str = "scenario.toml";

/// What the demo is made from.
#[derive(Clone, Debug)]
pub struct Options {
    /// Seed of the campaign.
    pub seed: u64,
    /// Drives, files and frames worked on at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the results; a demo that was interrupted goes on there.
    pub out: PathBuf,
}

/// What is seen of the demo on its way.
pub trait Onlooker {
    /// A recording or case was checked.
    fn checked(&mut self, checked: &Checked) -> anyhow::Result<()>;
    /// The cases were drawn again.
    fn rerendered(&mut self, rerendered: &Rerendered) -> anyhow::Result<()>;
}

/// What the demo came to.
#[derive(Clone, Debug, Serialize)]
pub struct Demo {
    /// The page.
    pub report: String,
    /// Runs that were driven.
    pub runs: usize,
    /// Corner cases.
    pub cases: usize,
    /// Kilometres driven.
    pub km: f64,
}

/// The last line of `aeye demo`.
impl Typed for Demo {
    const TYPE: &'static str = "aeye.demo";
}

impl fmt::Display for Demo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.report)
    }
}

/// Drives, verifies, draws and reports; what is there already is kept. A recording that does not replay is an error.
pub fn demo(options: &Options, onlooker: &mut impl Onlooker, interrupt: &Interrupt) -> anyhow::Result<Demo> {
    AdapterChoice::default().find()?;
    let _folder = OutputFolder::open(&options.out)?;
    let (early, full) = (CheckpointChoice::Bundled("early"), CheckpointChoice::Bundled("full"));
    let drives = options.out.join("drives");
    say(format_args!(
        "1/4 driving among hasty people through the early checkpoint until {CASES} corner cases have happened"
    ));
    let scenario = options.out.join(SCENARIO_FILE);
    output::write_file(&scenario, SCENARIO.as_bytes())?;
    let figures = campaign::drive(&campaign_options(options, early.clone(), scenario, &drives), interrupt)?;
    let (recordings, cases) = files(&drives, &figures);
    say("2/4 verifying every recording");
    verify_all([recordings, cases.clone()].concat(), options.jobs, onlooker)?;
    say("3/4 drawing the corner cases again through both checkpoints");
    let both = vec![early, full];
    let rerendered = rerender(&rerender_options(options, &cases, &both), interrupt)?;
    onlooker.rerendered(&rerendered)?;
    Failed::check(&rerendered.failed, rerendered.files)?;
    say("4/4 writing the report");
    let path = options.out.join("report.html");
    output::write_file(&path, report::render(&cases, &both, None, options.jobs)?.html.as_bytes())?;
    let path = fs::canonicalize(&path).with_context(|| path.display().to_string())?;
    let report = path.display().to_string();
    Ok(Demo { report, runs: figures.runs.len(), cases: cases.len(), km: figures.km })
}

fn verify_all(files: Vec<PathBuf>, jobs: Option<u16>, onlooker: &mut impl Onlooker) -> anyhow::Result<()> {
    let options = verify::Options { files, jobs, ..verify::Options::default() };
    let verified = verify(&options, |checked| onlooker.checked(checked))?;
    Failed::check(&verified.failed, verified.checked)?;
    let differs = |path: &PathBuf| Failure::diverged(path);
    Failed::check(
        &verified.diverged.iter().map(differs).collect::<Vec<_>>(),
        verified.checked - verified.diverged.len(),
    )
}

fn campaign_options(
    options: &Options,
    checkpoint: CheckpointChoice,
    scenario: PathBuf,
    out: &Path,
) -> campaign::Options {
    campaign::Options {
        checkpoint: vec![checkpoint],
        maps: MAPS.map(str::to_owned).into(),
        embed_map: false,
        scenario: Some(scenario),
        goal: Until::Cases(CASES).into(),
        vary: false,
        pedestrians: None,
        hazards: None,
        weather: None,
        imaging: Imaging::default(),
        run_seconds: RUN_SECONDS,
        seed: options.seed,
        jobs: options.jobs,
        out: out.to_owned(),
    }
}

/// The window of every case through every checkpoint.
fn rerender_options(options: &Options, cases: &[PathBuf], checkpoint: &[CheckpointChoice]) -> rerender::Options {
    let out = options.out.join("rerendered");
    let (last, fps) = (CLIP_TICKS, CLIP_FPS);
    let (files, checkpoint) = (cases.to_vec(), checkpoint.to_vec());
    let imaging = Imaging::default();
    rerender::Options { files, checkpoint, last, fps, size: None, imaging, cameras: None, jobs: options.jobs, out }
}

/// Recordings and cases of a campaign.
fn files(folder: &Path, figures: &CampaignFigures) -> (Vec<PathBuf>, Vec<PathBuf>) {
    let cases = figures.runs.iter().filter_map(|run| run.case.as_ref());
    (figures.runs.iter().map(|run| folder.join(&run.file)).collect(), cases.map(|case| folder.join(case)).collect())
}
