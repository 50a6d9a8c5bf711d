//! Tries provoked accidents.
//!
//! `provoked CHECKPOINT,... SEED DRAWS STORY...` drives each story with as many draws of its parameters, and prints a table in
//! Markdown of how often something is hit: by a car that drives on, whose driver sees nobody and has nobody beside him, and by
//! both bots through each checkpoint, in the time that the former took and ten seconds more; and how often the safety driver took
//! over. `provoked strips SEED DIR STORY...` draws the last seconds of the former, as its driver's camera has them.

#[path = "../common/blind.rs"]
mod blind;
mod strips;

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use anyhow::bail;
use base::maps::Map;
use base::say::say;
use base::scenario_file::ScenarioFile;
use drivers::MaskView;
use drivers::checkpoint::CheckpointChoice;
use drivers::crew::Bots;
use drivers::safety::SafetyBot;
use drivers::semantic::SemanticBot;
use drivers::vision::{Eye, Vision};
use kernel::arbiter::Phase;
use kernel::events::EventKind;
use kernel::time::{Tick, seconds};
use kernel::{Scenario, SceneSnapshot, Seat, TickInput, World};
use render::{AdapterChoice, Renderer};

/// Longest drive, seconds, and how much longer than who drives on those drive who look out.
const LONGEST_S: u32 = 30;
const LONGER_S: u32 = 10;

/// Who drives.
#[derive(Clone)]
enum Who {
    /// Nobody is seen, and nobody takes over.
    On,
    /// Both bots.
    Crew(Eye),
}

/// What came of a drive.
#[derive(Clone, Copy, Debug, Default)]
struct Came {
    hit: bool,
    taken_over: bool,
    ticks: Tick,
}

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [checkpoints, seed, draws, files @ ..] = &arguments[..] else {
        bail!("expected CHECKPOINT,... SEED DRAWS STORY..., or strips SEED DIR STORY...")
    };
    if checkpoints == "strips" {
        return files.iter().try_for_each(|file| strips::strip(Path::new(file), seed.parse()?, Path::new(draws)));
    }
    let choices = checkpoints.split(',').map(|name| name.parse::<CheckpointChoice>().map_err(anyhow::Error::msg));
    let eyes = choices.map(|choice| Eye::open(&choice?)).collect::<anyhow::Result<Vec<_>>>()?;
    let (seed, draws): (u64, u64) = (seed.parse()?, draws.parse()?);
    let crews: Vec<Who> = std::iter::once(Who::On).chain(eyes.iter().cloned().map(Who::Crew)).collect();
    let names: Vec<&str> = eyes.iter().map(Eye::name).collect();
    let heads: String = names.iter().map(|name| format!(" `{name}`: hit | taken over |")).collect();
    say(format_args!("| story | drives on: hit |{heads}"));
    say(format_args!("|---|---|{}", "---|---|".repeat(eyes.len())));
    for file in files {
        let scenario = ScenarioFile::read(Path::new(file))?;
        let came = try_out(&scenario, &crews, seed, draws)?;
        let count = |who: usize, what: fn(&Came) -> bool| came[who].iter().filter(|came| what(came)).count();
        let cells: String = (1..crews.len())
            .map(|who| format!(" {} | {} |", count(who, |c| c.hit), count(who, |c| c.taken_over)))
            .collect();
        let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
        say(format_args!("| {stem} | {} of {draws} |{cells}", count(0, |c| c.hit)));
    }
    Ok(())
}

/// What came of each draw, for each who drives.
fn try_out(file: &ScenarioFile, crews: &[Who], seed: u64, draws: u64) -> anyhow::Result<Vec<Vec<Came>>> {
    let (next, found) = (AtomicU64::new(0), Mutex::new(vec![vec![Came::default(); draws as usize]; crews.len()]));
    let work = || -> anyhow::Result<()> {
        let mut renderer = Renderer::new(&file.map.network, &AdapterChoice::default())?;
        loop {
            let draw = next.fetch_add(1, Ordering::Relaxed);
            if draw >= draws {
                return Ok(());
            }
            let scenario = drawn(&file.scenario, seed + draw)?;
            let mut longest_ticks = seconds(LONGEST_S);
            for (who, crew) in crews.iter().enumerate() {
                let came;
                (came, renderer) = drive(&scenario, &file.map, crew, longest_ticks, renderer, |_| {})?;
                found.lock().expect("no thread panics")[who][draw as usize] = came;
                if matches!(crew, Who::On) {
                    longest_ticks = longest_ticks.min(came.ticks + seconds(LONGER_S));
                }
            }
        }
    };
    std::thread::scope(|scope| {
        let cores = std::thread::available_parallelism()?.get();
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        threads.into_iter().try_for_each(|thread| thread.join().expect("no thread panics"))
    })?;
    Ok(found.into_inner()?)
}

/// The scenario with values drawn by a seed.
fn drawn(of: &Scenario, seed: u64) -> anyhow::Result<Scenario> {
    let mut scenario = Scenario { seed, ..of.clone() };
    if let Some(story) = &of.story {
        scenario.play(story.varied(seed)?);
    }
    scenario.rules.max_seconds = LONGEST_S;
    Ok(scenario)
}

/// Drives until something is hit, the run is over or the time is up, and hands the renderer back; `look` sees each tick.
fn drive(
    scenario: &Scenario,
    map: &Map,
    who: &Who,
    longest_ticks: Tick,
    renderer: Renderer,
    mut look: impl FnMut(SceneSnapshot),
) -> anyhow::Result<(Came, Renderer)> {
    let mut world = World::new(scenario, &map.network)?;
    let (eye, mut bots) = match who {
        Who::On => (Eye::Truth, Bots::beside(Seat::Safety, scenario.seed)),
        Who::Crew(eye) => (eye.clone(), Bots::both(SemanticBot::drawn(scenario.seed), SafetyBot::drawn(scenario.seed))),
    };
    let mut vision = Vision::new(renderer, eye);
    let mut came = Came::default();
    while world.arbiter().phase != Phase::Done && !came.hit && came.ticks < longest_ticks {
        let (mask, _) = vision.look(&world)?;
        let blinded = matches!(who, Who::On).then(|| blind::without_traffic(mask));
        let mask = MaskView { ids: blinded.as_deref().unwrap_or(mask.ids), ..mask };
        let mut input = TickInput::default();
        bots.act(&world, Some(mask), &mut input);
        let output = world.step(&input);
        let is_hit = |kind: EventKind| matches!(kind, EventKind::CollisionActor | EventKind::CollisionScenery);
        came.hit |= output.events.iter().any(|event| is_hit(event.kind));
        came.taken_over |= output.intervention.is_some();
        came.ticks += 1;
        look(world.scene());
    }
    Ok((came, vision.into_renderer()))
}
