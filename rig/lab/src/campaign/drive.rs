//! Simulated drives in parallel, resumable: a campaign from its options to its figures, or a shard of one.

use std::fmt;

use base::json::Typed;
use base::output::OutputFolder;
use base::progress::Interrupt;
use base::room::NoRoom;
use base::say::say;
use base::spread::jobs;
use base::words;
use drivers::checkpoint::check_names;
use drivers::vision::Eye;
use render::AdapterChoice;
use serde::Serialize;

use super::figures::CampaignFigures;
use super::options::{Options, plan};
use super::plan::Plan;
use super::run_line::RunLine;
use super::shard::Shard;
use super::sum::{Driven, sum_up};
use super::task::Task;
use super::workers::drive_all;
use crate::share::Share;

/// Drives a campaign, writes its files, and gives its figures.
pub fn drive(options: &Options, interrupt: &Interrupt) -> anyhow::Result<CampaignFigures> {
    let (plan, eyes) = open(options)?;
    let _folder = OutputFolder::open(&plan.out)?;
    let task = Task { plan: &plan, share: Share::WHOLE, adapters: &[], jobs: jobs(options.jobs), interrupt };
    let figures = sum_up(plan.seed, plan.goal, drive_share(&task, &eyes)?)?;
    figures.write(&plan.out)?;
    Ok(figures)
}

/// Drives a share of a campaign, for [`collect`](super::collect) to sum up.
pub fn drive_shard(options: &Options, share: Share, interrupt: &Interrupt) -> anyhow::Result<ShardFigures> {
    let (plan, eyes) = open(options)?;
    let _folder = OutputFolder::open(&plan.out)?;
    let adapters = Shard::enter(&plan, &eyes, share)?.adapters();
    let task = Task { plan: &plan, share, adapters: &adapters, jobs: jobs(options.jobs), interrupt };
    let runs: Vec<RunLine> = drive_share(&task, &eyes)?.into_iter().flat_map(|driven| driven.runs).collect();
    let cases = runs.iter().filter(|run| run.case.is_some()).count();
    Ok(ShardFigures { share, runs: runs.len(), km: runs.iter().map(|run| run.figures.km).sum(), cases })
}

/// What is driven, and who looks.
pub(super) fn open(options: &Options) -> anyhow::Result<(Plan, Vec<Eye>)> {
    check_names(&options.checkpoint)?;
    let plan = plan(options)?;
    let eyes = options.checkpoint.iter().map(|choice| Ok(Eye::open(choice)?.at(options.imaging)));
    let eyes = eyes.collect::<anyhow::Result<Vec<_>>>()?;
    AdapterChoice::default().find()?;
    Ok((plan, eyes))
}

/// Drives what is not there yet of the runs of each checkpoint.
fn drive_share(task: &Task<'_>, eyes: &[Eye]) -> anyhow::Result<Vec<Driven>> {
    let mut no_room = NoRoom::default();
    say_of_first_runs(task, &mut no_room)?;
    let driven = eyes.iter().zip(drive_all(task, eyes)?);
    let driven: Vec<_> = driven.map(|(eye, runs)| Driven { checkpoint: eye.name().to_owned(), runs }).collect();
    say_of_runs(driven.iter().flat_map(|driven| &driven.runs), &mut no_room);
    Ok(driven)
}

/// Says who has no room in the first run on each map: before hours are driven without them.
fn say_of_first_runs(task: &Task<'_>, no_room: &mut NoRoom) -> anyhow::Result<()> {
    for run in (0..task.plan.maps.len()).map_while(|turn| task.number(turn)) {
        let map = &task.plan.maps[task.plan.map_index(run)];
        no_room.of_run(&task.plan.scenario_of(run), map)?.into_iter().for_each(say);
    }
    Ok(())
}

/// Says it of maps on which the first run had room and a later one had not.
fn say_of_runs<'a>(runs: impl Iterator<Item = &'a RunLine>, no_room: &mut NoRoom) {
    let figures = runs.map(|run| &run.figures);
    let told = figures.filter_map(|figures| no_room.of(&figures.map, &figures.asked, figures.missing.as_ref()?));
    told.for_each(say);
}

/// What a shard came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShardFigures {
    /// Which one it is.
    #[serde(flatten)]
    pub share: Share,
    /// Runs of all checkpoints.
    pub runs: usize,
    /// Kilometres of them.
    pub km: f64,
    /// Corner cases among them.
    pub cases: usize,
}

/// What `aeye campaign --shard` prints.
impl Typed for ShardFigures {
    const TYPE: &'static str = "aeye.campaign.shard";
}

impl fmt::Display for ShardFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (runs, cases) = (words::count(self.runs, "run"), words::count(self.cases, "corner case"));
        write!(f, "shard {}: {runs}, {:.3} km, {cases}", self.share, self.km)
    }
}
