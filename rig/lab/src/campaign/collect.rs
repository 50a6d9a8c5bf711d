//! What the shards of a campaign came to: a function of their folders, which gives what one process would have given.

use std::path::{Path, PathBuf};

use anyhow::bail;
use base::files::{self, most};
use base::maps;
use base::output::{self, OutputFolder};
use base::spread::jobs;

use super::figures::CampaignFigures;
use super::gather::{Gathered, RunFiles, gather};
use super::shards::{Placed, check, find, machines};
use super::sum::{TooFew, sum_up};

/// Shards of a campaign.
#[derive(Clone, Debug)]
pub struct Collection {
    /// Folders of shards, or folders with such folders in them.
    pub folders: Vec<PathBuf>,
    /// Runs read at the same time (default: one a core).
    pub jobs: Option<u16>,
    /// Folder of the results.
    pub out: PathBuf,
}

/// Puts together what shards drove, up to the run with which the campaign's goal is met.
pub fn collect(options: &Collection) -> anyhow::Result<CampaignFigures> {
    let shards = find(&options.folders)?;
    let Placed { folder, shard: first } = check(&shards)?;
    let machines = machines(&shards);
    let goal = first.plan.goal();
    let Some(end) = goal.end() else {
        bail!("{}/shard.json: has no runs; expected the number that shards drive up to", folder.display())
    };
    let Gathered { driven, files, missing } = gather(&shards, goal, end, jobs(options.jobs))?;
    if !missing.is_empty() {
        return Err(TooFew::runs(&missing, first.share.of).into());
    }
    let figures = CampaignFigures { machines, ..sum_up(first.plan.seed, goal, driven)? };
    write(&options.out, &shards, &files, &figures)?;
    Ok(figures)
}

/// Copies the runs that count, and writes their figures last.
fn write(out: &Path, shards: &[Placed], runs: &[RunFiles], figures: &CampaignFigures) -> anyhow::Result<()> {
    shards.iter().try_for_each(|placed| output::check_outside(out, &placed.folder))?;
    let _folder = OutputFolder::open(out)?;
    for (RunFiles { places, map }, line) in runs.iter().zip(&figures.runs) {
        maps::put_beside(map.as_ref(), &out.join(&line.file))?;
        places.of(line).try_for_each(|path| copy(path, out))?;
    }
    figures.write(out)
}

/// Copies a file to a folder, unless it is there.
fn copy(path: &Path, folder: &Path) -> anyhow::Result<()> {
    let bytes = files::read(path, most::RECORDING)?;
    let copy = folder.join(path.file_name().unwrap_or_default());
    match files::read_if_there(&copy, most::RECORDING)? {
        Some(there) if there == bytes => Ok(()),
        Some(_) => {
            bail!("{}: belongs to another campaign; expected an empty folder or this campaign's", copy.display())
        }
        None => output::write_claimed(&copy, &bytes),
    }
}
