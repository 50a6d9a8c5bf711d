//! Simulated drives in parallel, resumable, and their figures.

use std::fmt;
use std::path::PathBuf;

use base::json;
use base::maps::{Map, ScenarioFile};
use base::output::{self, OutputFolder};
use base::progress::Interrupt;
use base::room::NoRoom;
use base::say::say;
use base::spread::jobs;
use drivers::checkpoint::{CheckpointChoice, check_names};
use drivers::vision::Eye;
use kernel::scenario::HazardLevel;
use kernel::weather::WeatherPreset;
use measures::statistics::table;
use render::AdapterChoice;

use super::figures::{CampaignFigures, figures};
use super::plan::Plan;
use super::run_line::RunLine;
use super::until::Until;
use super::workers::drive_all;

/// What is driven, and until when.
#[derive(Clone, Debug)]
pub struct Options {
    /// What the semantic driver sees; each of them drives the same runs.
    pub checkpoint: Vec<CheckpointChoice>,
    /// Bundled maps or OpenDRIVE files, in turn; `all` are the bundled ones. None: the scenario's map, or all.
    pub maps: Vec<String>,
    /// Whether the files of foreign maps stand in the recordings, instead of once beside them.
    pub embed_map: bool,
    /// A scenario file; its seed and length are replaced for each run.
    pub scenario: Option<PathBuf>,
    /// When each checkpoint has driven enough.
    pub until: Until,
    /// People on foot, instead of as many as the scenario or the map's default has.
    pub pedestrians: Option<u16>,
    /// How often people at the wheel endanger others, instead of what the scenario says.
    pub hazards: Option<HazardLevel>,
    /// Weather, if not as the scenario or the map's default says.
    pub weather: Option<WeatherPreset>,
    /// Longest simulated time of a run, seconds.
    pub run_seconds: u32,
    /// Seed of the campaign; run `i` follows from it and `i` alone.
    pub seed: u64,
    /// Worlds simulated at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the results; a campaign that was interrupted goes on there.
    pub out: PathBuf,
}

/// Drives a campaign, writes its files, and gives its figures.
pub fn drive(options: &Options, interrupt: &Interrupt) -> anyhow::Result<CampaignFigures> {
    check_names(&options.checkpoint)?;
    let plan = plan(options)?;
    let eyes = options.checkpoint.iter().map(Eye::open).collect::<Result<Vec<_>, _>>()?;
    let names: Vec<String> = eyes.iter().map(|eye| eye.name().to_owned()).collect();
    AdapterChoice::default().find()?;
    let _folder = OutputFolder::open(&plan.out)?;
    let jobs = jobs(options.jobs);
    let mut no_room = NoRoom::default();
    say_of_first_runs(&plan, &mut no_room)?;
    let mut runs = Vec::new();
    for eye in &eyes {
        runs.extend(drive_all(&plan, eye, jobs, interrupt)?);
    }
    say_of_runs(&runs, &mut no_room);
    let figures = figures(plan.seed, plan.until, &names, runs);
    output::write_file(&plan.out.join("campaign.json"), json::json_file(&figures)?.as_bytes())?;
    Ok(figures)
}

/// Says who has no room in the first run on each map: before hours are driven without them.
fn say_of_first_runs(plan: &Plan, no_room: &mut NoRoom) -> anyhow::Result<()> {
    let runs = match plan.until {
        Until::Runs(runs) => runs.min(plan.maps.len() as u32),
        Until::Km(_) | Until::Cases(_) | Until::PedestrianCases(_) => plan.maps.len() as u32,
    };
    for run in 0..runs {
        let map = &plan.maps[plan.map_index(run)];
        no_room.of_run(&plan.scenario_of(run), map)?.into_iter().for_each(say);
    }
    Ok(())
}

/// Says it of maps on which the first run had room and a later one had not.
fn say_of_runs(runs: &[RunLine], no_room: &mut NoRoom) {
    let figures = runs.iter().map(|run| &run.figures);
    let told = figures.filter_map(|figures| no_room.of(&figures.map, &figures.asked, figures.missing.as_ref()?));
    told.for_each(say);
}

/// What the options come to.
pub fn plan(options: &Options) -> anyhow::Result<Plan> {
    let file = options.scenario.as_deref().map(ScenarioFile::read).transpose()?;
    let maps = match &file {
        Some(file) if options.maps.is_empty() => vec![file.map.clone()],
        _ if options.maps.is_empty() => Map::find_all(&["all".to_owned()])?,
        _ => Map::find_all(&options.maps)?,
    };
    let maps = if options.embed_map { maps.into_iter().map(Map::embedded).collect() } else { maps };
    if let Some(file) = &file {
        maps.iter().try_for_each(|map| file.check_start(map))?;
    }
    let scenario = file.map(|file| file.scenario);
    let Options { until, pedestrians, hazards, weather, run_seconds, seed, .. } = *options;
    Ok(Plan { maps, scenario, pedestrians, hazards, weather, run_seconds, seed, until, out: options.out.clone() })
}

impl fmt::Display for CampaignFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.checkpoints.iter();
        let columns = columns.map(|c| (c.checkpoint.as_str(), &c.statistics, c.against_first.as_ref()));
        f.write_str(&table(columns))?;
        for each in self.checkpoints.iter().filter(|each| !each.interventions.is_empty()) {
            let verdicts: Vec<_> = each.interventions.iter().map(|(verdict, n)| format!("{n} {verdict}")).collect();
            write!(f, "\n{}: without the interventions: {}", each.checkpoint, verdicts.join(", "))?;
        }
        Ok(())
    }
}
