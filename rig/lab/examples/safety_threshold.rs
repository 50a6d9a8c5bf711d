//! Fits the simulated safety driver's threshold: `safety_threshold CHECKPOINT SCENARIO.toml MAP,... SEED RUNS` drives the
//! scenario without a safety driver, with the seeds from SEED on and the maps in turn, while one of each threshold looks on
//! and says when they would have taken over. What came after that moment is the verdict on it; who was hit without a word
//! before is a miss. A drive ends with its first collision.
//!
//! `blind` in place of a checkpoint is the truth in which people and vehicles are painted over with what is to the left of
//! them for some seconds now and then: it errs where it matters, and costs no inference.

#[path = "common/blind.rs"]
mod blind;

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::bail;
use base::maps::Map;
use base::say::say;
use base::scenario_file::ScenarioFile;
use drivers::checkpoint::CheckpointChoice;
use drivers::crew::Bots;
use drivers::safety::{Hazard, SafetyBot, URGENT};
use drivers::vision::{Eye, Vision};
use drivers::{Driver, MaskView};
use kernel::arbiter::Phase;
use kernel::events::EventKind;
use kernel::rng::{self, Stream};
use kernel::time::{TICK_HZ, Tick, seconds};
use kernel::{Scenario, Seat, TickInput, World};
use lab::redrive::{EARLY_TICKS, is_near_miss};
use measures::criticality::{SAMPLE_TICKS, Sample, Sampler};
use render::{AdapterChoice, Renderer};

/// Thresholds that look on.
const TRIED: [f32; 9] = [0.0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
/// Who would have taken over looks again after this time.
const AGAIN_TICKS: Tick = seconds(5);
/// A collision counts as foreseen by a takeover at most this long before.
const FORESEEN_TICKS: Tick = seconds(5);
/// Runs after which the table so far is shown.
const TOLD_EVERY: usize = 16;

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [checkpoint, scenario, maps, seed, runs] = &arguments[..] else {
        bail!("expected CHECKPOINT SCENARIO.toml MAP,... SEED RUNS")
    };
    let scenario = ScenarioFile::read(Path::new(scenario))?.scenario;
    let maps = Map::find_all(&maps.split(',').map(str::to_owned).collect::<Vec<_>>())?;
    let (seed, runs): (u64, usize) = (seed.parse()?, runs.parse()?);
    let is_blind = checkpoint == "blind";
    let choice = if is_blind { "truth" } else { checkpoint }.parse::<CheckpointChoice>().map_err(anyhow::Error::msg)?;
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || -> anyhow::Result<()> {
        loop {
            let run = next.fetch_add(1, Ordering::Relaxed);
            if run >= runs {
                return Ok(());
            }
            let map = &maps[run % maps.len()];
            let scenario = Scenario { map: map.network.name.clone(), seed: seed + run as u64, ..scenario.clone() };
            let vision = Vision::new(Renderer::new(&map.network, &AdapterChoice::default())?, Eye::open(&choice)?);
            let watched = watch(&scenario, map, vision, run as u64, is_blind)?;
            let mut found = found.lock().expect("no thread panics");
            say(format_args!("run {run} on {}: {:.2} km", map.network.name, watched.km));
            watched.words().iter().for_each(say);
            found.push(watched);
            if found.len() % TOLD_EVERY == 0 {
                table(&found).iter().for_each(say);
            }
        }
    };
    std::thread::scope(|scope| {
        let cores = std::thread::available_parallelism()?.get();
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        threads.into_iter().try_for_each(|thread| thread.join().expect("no thread panics"))
    })?;
    table(&found.into_inner()?).iter().for_each(say);
    Ok(())
}

/// What came of a drive.
struct Watched {
    km: f64,
    collision: Option<Tick>,
    /// Collisions and other harm.
    harms: Vec<(Tick, String)>,
    samples: Vec<Sample>,
    /// Of each threshold: when it would have taken over, and why.
    takeovers: [Vec<(Tick, Hazard)>; TRIED.len()],
}

fn watch(scenario: &Scenario, map: &Map, mut vision: Vision, person: u64, is_blind: bool) -> anyhow::Result<Watched> {
    let mut world = World::new(scenario, &map.network)?;
    let mut driver = Bots::beside(Seat::Safety, scenario.seed);
    let bot = |urgent| SafetyBot::of_person(person).with_urgent(urgent);
    let mut watchers = TRIED.map(|urgent| (bot(urgent), None));
    let mut sampler = Sampler::default();
    let mut watched =
        Watched { km: 0.0, collision: None, harms: Vec::new(), samples: Vec::new(), takeovers: Default::default() };
    while matches!(world.arbiter().phase, Phase::Arming | Phase::Driving) {
        let (mask, _) = vision.look(&world)?;
        let mut input = TickInput::default();
        let blinded = (is_blind && is_blind_at(scenario.seed, world.tick())).then(|| blind::without_traffic(mask));
        let mask = MaskView { ids: blinded.as_deref().unwrap_or(mask.ids), ..mask };
        driver.act(&world, Some(mask), &mut input);
        for (at, (watcher, since)) in watchers.iter_mut().enumerate() {
            watcher.controls(&world);
            let tick = world.tick();
            if let (Some(hazard), None) = (watcher.reason(), &since) {
                watched.takeovers[at].push((tick, hazard.clone()));
                *since = Some(tick);
            }
            if since.is_some_and(|since| tick >= since + AGAIN_TICKS) {
                (*watcher, *since) = (bot(TRIED[at]), None);
            }
        }
        if world.tick().is_multiple_of(SAMPLE_TICKS) {
            watched.samples.push(sampler.look(&world, &world.scene()));
        }
        let speed_mps = world.hud().speed_mps;
        for event in world.step(&input).events {
            use EventKind::{CollisionActor, CollisionScenery, OffRoad, RedLight, WrongWay};
            if matches!(event.kind, CollisionActor | CollisionScenery | RedLight | WrongWay | OffRoad) {
                let with = world.scene().actors.iter().find(|a| a.id == event.actor).map(|a| format!("{:?}", a.kind));
                watched.harms.push((
                    world.tick(),
                    format!("{:?} {} at {speed_mps:.1} m/s", event.kind, with.unwrap_or_default()),
                ));
            }
            // Who stands is run into.
            if matches!(event.kind, CollisionActor | CollisionScenery) && speed_mps > STANDS_MPS {
                watched.collision = watched.collision.or(Some(world.tick()));
            }
        }
    }
    watched.km = world.odometer_mm() as f64 / 1e6;
    Ok(watched)
}

/// Time is cut into stretches of [`BLIND_TICKS`], of which one in so many, drawn by the seed, is blind.
const BLIND_ONE_IN: u64 = 4;
const BLIND_TICKS: Tick = seconds(4);

fn is_blind_at(seed: u64, tick: Tick) -> bool {
    rng::bits(seed, Stream::Driver, u64::MAX, tick / BLIND_TICKS).is_multiple_of(BLIND_ONE_IN)
}

/// Slower than this the ego car stands, m/s.
const STANDS_MPS: f32 = 0.5;

/// As `lab::redrive::Need` has it.
#[derive(Clone, Copy, PartialEq)]
enum Came {
    Harm,
    NearMiss,
    Nothing,
}

impl Watched {
    fn after(&self, takeover: Tick) -> Came {
        let soon = takeover..=takeover + EARLY_TICKS;
        let near = self.samples.iter().filter(|sample| soon.contains(&sample.tick));
        if self.harms.iter().any(|(tick, _)| soon.contains(tick)) {
            Came::Harm
        } else if is_near_miss(near) {
            Came::NearMiss
        } else {
            Came::Nothing
        }
    }

    fn is_foreseen(&self, at: usize) -> Option<bool> {
        let collision = self.collision?;
        let before = collision.saturating_sub(FORESEEN_TICKS)..collision;
        Some(self.takeovers[at].iter().any(|(tick, _)| before.contains(tick)))
    }

    fn words(&self) -> Vec<String> {
        let at_s = |tick: Tick| tick as f64 / f64::from(TICK_HZ);
        let usual = TRIED.iter().position(|urgent| *urgent == URGENT).unwrap_or_default();
        let takeovers = self.takeovers[usual].iter().map(|(tick, hazard)| {
            let came = match self.after(*tick) {
                Came::Harm => "harm",
                Came::NearMiss => "near miss",
                Came::Nothing => "nothing",
            };
            format!("  {:.1} s: {} {:.2} -> {came}", at_s(*tick), hazard.comment, hazard.urgency)
        });
        let harms = self.harms.iter().map(|(tick, kind)| format!("  {:.1} s: {kind}", at_s(*tick)));
        takeovers.chain(harms).collect()
    }
}

fn table(all: &[Watched]) -> Vec<String> {
    let km: f64 = all.iter().map(|watched| watched.km).sum();
    let collisions = all.iter().filter(|watched| watched.collision.is_some()).count();
    let mut lines = vec![
        format!("{km:.1} km, {collisions} collisions"),
        "threshold  takeovers  necessary  near miss  neither  precision  foreseen  recall".into(),
    ];
    for (at, urgent) in TRIED.iter().enumerate() {
        let came = |what| {
            let takeovers = all.iter().flat_map(|w| w.takeovers[at].iter().map(move |(tick, _)| w.after(*tick)));
            takeovers.filter(|came| *came == what).count()
        };
        let (harm, near, nothing) = (came(Came::Harm), came(Came::NearMiss), came(Came::Nothing));
        let foreseen = all.iter().filter(|watched| watched.is_foreseen(at) == Some(true)).count();
        let takeovers = harm + near + nothing;
        lines.push(format!(
            "{urgent:9.2}  {takeovers:9}  {harm:9}  {near:9}  {nothing:7}  {:9.2}  {foreseen:8}  {:6.2}",
            (harm + near) as f64 / takeovers as f64,
            foreseen as f64 / collisions as f64,
        ));
    }
    lines
}
