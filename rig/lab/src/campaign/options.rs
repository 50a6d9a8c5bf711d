//! What a campaign is asked for, and what that comes to.

use std::path::PathBuf;

use base::failure::Usage;
use base::maps::Map;
use base::scenario_file::ScenarioFile;
use drivers::checkpoint::CheckpointChoice;
use kernel::scenario::HazardLevel;
use kernel::weather::WeatherPreset;
use render::Imaging;

use super::plan::{Plan, seed_of};
use super::until::{Goal, Until};

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
    /// Whether each run draws values for those parameters of the scenario's story that have ranges.
    pub vary: bool,
    /// When each checkpoint has driven enough.
    pub goal: Goal,
    /// People on foot, instead of as many as the scenario or the map's default has.
    pub pedestrians: Option<u16>,
    /// How often people at the wheel endanger others, instead of what the scenario says.
    pub hazards: Option<HazardLevel>,
    /// Weather, if not as the scenario or the map's default says.
    pub weather: Option<WeatherPreset>,
    /// How good the pictures are that networks look at.
    pub imaging: Imaging,
    /// Longest simulated time of a run, seconds.
    pub run_seconds: u32,
    /// Seed of the campaign; run `i` follows from it and `i` alone.
    pub seed: u64,
    /// Worlds simulated at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the results; a campaign that was interrupted goes on there.
    pub out: PathBuf,
}

/// Refuses a scenario of which nothing could be drawn.
fn check_varies(file: Option<&ScenarioFile>) -> anyhow::Result<()> {
    let expected = "expected a story whose parameters have ranges (<ConstraintGroup>)";
    let Some(file) = file else { return Err(Usage(format!("--vary without --scenario; {expected}")).into()) };
    let story = file.scenario.story.as_ref();
    let varies = story.map_or(Ok(false), |story| story.varies()).map_err(|error| file.refusal(&error.to_string()))?;
    if varies { Ok(()) } else { Err(file.refusal(&format!("nothing varies; {expected}"))) }
}

/// What the options come to.
pub fn plan(options: &Options) -> anyhow::Result<Plan> {
    let file = options.scenario.as_deref().map(ScenarioFile::read).transpose()?;
    if let Some(file) = file.as_ref().filter(|file| file.scenario.story.is_some() && !options.maps.is_empty()) {
        return Err(file.refusal("plays on the roads of its own map; expected no --maps"));
    }
    let maps = match &file {
        Some(file) if options.maps.is_empty() => vec![file.map.clone()],
        _ if options.maps.is_empty() => Map::find_all(&["all".to_owned()])?,
        _ => Map::find_all(&options.maps)?,
    };
    let maps = if options.embed_map { maps.into_iter().map(Map::embedded).collect() } else { maps };
    if let Some(file) = &file {
        maps.iter().try_for_each(|map| file.check_start(map))?;
    }
    let Options { vary, goal, pedestrians, hazards, weather, run_seconds, seed, .. } = *options;
    let (scenario, out) = (file.as_ref().map(|file| file.scenario.clone()), options.out.clone());
    let plan = Plan { maps, scenario, vary, pedestrians, hazards, weather, run_seconds, seed, goal, out };
    if options.vary {
        check_varies(file.as_ref())?;
        file.iter().try_for_each(|file| check_draws(file, &plan))?;
    }
    Ok(plan)
}

/// Refuses a scenario of which something is drawn that cannot be played.
fn check_draws(file: &ScenarioFile, plan: &Plan) -> anyhow::Result<()> {
    let Until::Runs(runs) = plan.goal.until else { return Ok(()) };
    for run in 0..runs {
        let (seed, mut drawn) = (seed_of(plan.seed, run), file.scenario.clone());
        let network = &plan.maps[plan.map_index(run)].network;
        let fits = drawn.vary(seed).map_err(|error| error.to_string());
        let fits = fits.and_then(|()| drawn.start_on(network).map_err(|error| error.to_string()));
        fits.map_err(|reason| file.refusal(&format!("draw {} of {runs}, seed {seed}: {reason}", run + 1)))?;
    }
    Ok(())
}
