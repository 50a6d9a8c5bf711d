//! Checkpoints side by side over a library of corner cases.
//!
//! `OUT/compare.json`, `OUT/report.html`, and in `OUT/.compare` what each checkpoint made of each case, so
//! that a further checkpoint or case costs only itself.

mod contest;
mod differing;
mod gate;
mod looking;
mod metrics;
mod page;
mod score;
mod summary;
mod text;
mod witness;

use std::path::PathBuf;

use anyhow::bail;
use drivers::checkpoint::{CheckpointChoice, check_names};
use kernel::time::{CLIP_FPS, CLIP_FRAMES, CLIP_TICKS};
use render::{AdapterChoice, Imaging};

use self::contest::Contest;
pub use self::gate::Passage;
use self::gate::no_worse;
use self::looking::{Looked, Looking};
use self::metrics::CaseSums;
pub use self::score::Hits;
use self::summary::Speed;
pub use self::summary::{Compared, Scoreboard};
pub use self::witness::Witness;
use super::looks::open_eyes;
use super::pipeline::{Pipeline, Studios, set_aside};
use super::store::{Settings, Store};
use crate::redrive::{Need, keep_judged};
use crate::share::{Share, ShareDone};
use base::failure::{Failed, Failure, Usage};
use base::json;
use base::library::{self, Entry, Kind};
use base::output;
use base::progress::{self, Interrupt};
use base::say::say;
use base::spread::jobs;
use drivers::vision::Eye;

pub use gate::Gate;

/// What is compared.
#[derive(Clone, Debug)]
pub struct Options {
    /// Corner cases, or folders with cases anywhere below.
    pub files: Vec<PathBuf>,
    /// Only cases on whose takeover a campaign came to one of these verdicts.
    pub verdict: Vec<Need>,
    /// Two or more checkpoints; the first is the baseline.
    pub checkpoint: Vec<CheckpointChoice>,
    /// A condition on every checkpoint but the baseline, as in `ped_iou>=0.5`. Metrics: ped_iou, miou,
    /// ped_recall_on_path, hazards_seen (share of the hazards seen 1 s or more before the intervention),
    /// first_sight_s (mean), and against the baseline the numbers of cases fixed and broken.
    pub gate: Vec<Gate>,
    /// A checkpoint than which no other may be worse: of no metric may the paired 95 % interval of the
    /// difference lie below 0 as a whole.
    pub no_worse_than: Option<String>,
    /// Size of the pictures; none: that which the first network takes.
    pub size: Option<(u32, u32)>,
    /// How good the pictures are.
    pub imaging: Imaging,
    /// Frames looked at at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the results. One that this command began is completed: what follows from the same cases,
    /// checkpoints and size is kept.
    pub out: PathBuf,
}

/// Draws every case, looks at it through each checkpoint, and writes `compare.json` and `report.html`.
pub fn compare(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Compared> {
    let reference = reference(args)?;
    let Seen { cases, failed, eyes, size, looked, studios, speed, _store } = look(args, None, interrupt)?;
    for (case, looked) in cases.iter().zip(&looked) {
        if let Some(kernel) = &looked.facts.other_kernel {
            let path = case.path.display();
            say(format_args!("{path}: made by kernel {kernel}; its pictures count, who was in the way is not known"));
        }
    }
    let sums = sums(&looked, eyes.len());
    let mut summary = Scoreboard::new(size, &cases, &eyes, &looked, &sums);
    summary.failed = failed;
    summary.gates = passages(args, &eyes, &sums, reference);
    let differing = differing::most(&looked);
    let render = |studio: &mut _| page::render(&summary, &cases, (&mut eyes.clone(), studio), &differing, interrupt);
    let page = studios.with(size, render)?;
    output::write_file(&args.out.join("report.html"), page.as_bytes())?;
    output::write_file(&args.out.join("compare.json"), json::json_file(&summary)?.as_bytes())?;
    Ok(Compared { summary, speed })
}

/// Looks at a share of the cases, and writes neither table nor report: a later call finds in the folder what came of it.
pub fn compare_shard(args: &Options, share: Share, interrupt: &Interrupt) -> anyhow::Result<ShareDone> {
    reference(args)?;
    let Seen { cases, failed, .. } = look(args, Some(share), interrupt)?;
    Ok(ShareDone { share, out: args.out.display().to_string(), done: cases.len(), failed })
}

/// Cases that were looked at, and with what.
struct Seen {
    cases: Vec<Entry>,
    failed: Vec<Failure>,
    eyes: Vec<Eye>,
    size: (u32, u32),
    looked: Vec<Looked>,
    studios: Studios,
    speed: Option<Speed>,
    /// Nobody else works in the folder for as long.
    _store: Store,
}

/// Looks at what is missing of a share, or of all.
fn look(args: &Options, share: Option<Share>, interrupt: &Interrupt) -> anyhow::Result<Seen> {
    AdapterChoice::default().find()?;
    let store = Store::open(&args.out, "compare")?;
    let mut found = library::find(&args.files, Kind::Cases).only_cases().or_failed()?;
    found.files = keep_judged(found.files, |entry| &entry.path, &args.verdict)?;
    let library::Found { files: mut cases, mut failed } = match share {
        Some(share) => share.pick(found),
        None => found,
    };
    let (eyes, size) = open_eyes(&args.checkpoint, args.size)?;
    let settings = Settings::new(CLIP_TICKS, CLIP_FPS, size, args.imaging);
    let bar = progress::bar("frames", 0);
    let work = Looking { cases: &cases, eyes: &eyes, store: &store, settings: settings.clone(), bar: &bar };
    let left = work.left();
    bar.set_length(left.len() as u64 * u64::from(CLIP_FRAMES));
    let (jobs, studios) = (jobs(args.jobs), Studios::new(args.imaging));
    let pipeline = Pipeline { work: &work, files: &left, size, eyes: &eyes, jobs, interrupt, studios };
    let alone = if share.is_none() { pipeline.alone()? } else { None };
    let (pace, unread) = pipeline.run()?;
    let studios = pipeline.studios;
    bar.finish_and_clear();
    failed.extend(set_aside(&mut cases, unread));
    if cases.is_empty() && !failed.is_empty() {
        return Err(Failed::new(failed).into());
    }
    let work = Looking { cases: &cases, eyes: &eyes, store: &store, settings, bar: &bar };
    let Some(looked) = work.all() else {
        bail!("{}: interrupted; the same command goes on from there", args.out.display());
    };
    let speed = Speed::of(pace, alone, eyes.len());
    Ok(Seen { cases, failed, eyes, size, looked, studios, speed, _store: store })
}

/// Number of the checkpoint that none of the others may be worse than.
fn reference(args: &Options) -> Result<Option<usize>, Usage> {
    if args.checkpoint.len() < 2 {
        return Err(Usage("expected two or more checkpoints, the first of which is the baseline".into()));
    }
    check_names(&args.checkpoint)?;
    let Some(name) = &args.no_worse_than else { return Ok(None) };
    let found = args.checkpoint.iter().position(|choice| choice.name() == *name);
    let names = || args.checkpoint.iter().map(CheckpointChoice::name).collect::<Vec<_>>().join(", ");
    let sentence = || format!("--no-worse-than {name}: no such checkpoint; expected one of {}", names());
    found.map(Some).ok_or_else(|| Usage(sentence()))
}

/// What counts, by checkpoint and case.
fn sums(looked: &[Looked], checkpoints: usize) -> Vec<Vec<CaseSums>> {
    let of = |checkpoint: usize| looked.iter().map(move |case| CaseSums::of(&case.facts, &case.scores[checkpoint]));
    (0..checkpoints).map(|checkpoint| of(checkpoint).collect()).collect()
}

/// How every checkpoint but the baseline did at every gate.
fn passages(args: &Options, eyes: &[Eye], sums: &[Vec<CaseSums>], reference: Option<usize>) -> Vec<Passage> {
    let all: Vec<usize> = (0..sums[0].len()).collect();
    let mut passages = Vec::new();
    for (eye, own) in eyes.iter().zip(sums).skip(1) {
        let contest = Contest::of(&sums[0], own);
        let passage = |gate: &Gate| gate.passage(eye.name(), |metric| metric.of(own, &all), &contest);
        passages.extend(args.gate.iter().map(passage));
    }
    if let Some(reference) = reference {
        let others = eyes.iter().zip(sums).enumerate().filter(|(other, _)| *other != reference);
        for (_, (eye, own)) in others {
            passages.extend(no_worse(eye.name(), eyes[reference].name(), &Contest::of(&sums[reference], own)));
        }
    }
    passages
}
