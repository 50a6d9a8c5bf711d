//! A run that leaves the recorded one: the same ticks up to a fork, then other controls.

use std::sync::Arc;

use anyhow::{Context, bail};
use base::words;
use drivers::crew::Crew;
use drivers::safety::SafetyBot;
use drivers::semantic::SemanticBot;
use drivers::simulate::{fork_before_ticks, lasting};
use drivers::temper::Temper;
use drivers::vision::{self, Vision};
use kernel::arbiter::Phase;
use kernel::events::{Event, EventKind};
use kernel::scene::Weather;
use kernel::time::{CLIP_TICKS, TICK_HZ, Tick};
use kernel::{Controls, Keyframe, RoadNetwork, Seat, TickInput, World};
use measures::Criticality;
use measures::criticality::Extremes;
use replay::{Case, Label, Log, PROGRAM, Provenance, Recorder, Recording, Replayer, WRITTEN_BY};
use serde::{Deserialize, Serialize};

use super::near_miss::{EARLY_TICKS, is_near_miss};

/// What is done otherwise than in the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Otherwise {
    /// The safety driver does nothing from so many ticks before the intervention on, and a bot gives
    /// the semantic controls; until then both are as recorded.
    NoIntervention {
        /// 0: from the tick of the intervention on.
        earlier_ticks: Tick,
    },
    /// Bots give all controls from the first tick.
    OtherEye {
        /// Which of many safety drivers; they differ in their reaction times.
        person: u64,
    },
}

/// A fork: what is done otherwise, in which weather, and how long after the intervention it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fork {
    /// What is done otherwise.
    pub otherwise: Otherwise,
    /// Other weather than recorded, which then stays. Among dry weathers without fog it changes pictures and nothing
    /// else.
    pub weather: Option<Weather>,
    /// Ticks from the recorded intervention to the end.
    pub after_ticks: Tick,
}

/// What came of a fork.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Its recording.
    pub recording: Vec<u8>,
    /// First tick that may differ from the recorded run.
    pub fork_tick: Tick,
    /// The first thing that went wrong from then on.
    pub harm: Option<Harm>,
    /// The first collision from then on.
    pub collision: Option<Harm>,
    /// The first thing that went wrong in the recorded run from its takeover on.
    pub recorded_harm: Option<Harm>,
    /// Tick of an intervention, which there is only with a safety bot.
    pub intervention: Option<Tick>,
    /// Somebody came close within 3 s of the takeover.
    pub near_miss: bool,
    /// How critical it was from then on.
    pub closest: Extremes,
}

/// What went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HarmKind {
    /// Anything was hit.
    Collision,
    /// A red light was run.
    #[serde(rename = "red light")]
    RedLight,
    /// The car drove against the traffic.
    #[serde(rename = "wrong way")]
    WrongWay,
    /// The car left the road.
    #[serde(rename = "off road")]
    OffRoad,
}

impl HarmKind {
    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Collision => "collision",
            Self::RedLight => "red light",
            Self::WrongWay => "wrong way",
            Self::OffRoad => "off road",
        }
    }
}

/// Something that went wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Harm {
    /// When.
    pub tick: Tick,
    /// What.
    pub what: HarmKind,
    /// With what kind of road user a collision was; `scenery` stands for everything else.
    pub with: Option<String>,
    /// Speed of the ego car just before, km/h.
    pub speed_kmh: f64,
}

impl Fork {
    /// Drives it from the last keyframe that is at least 3 s before the intervention, or where bots may get
    /// bored again, long enough for that (the first one if there is none). Vision is that of the semantic bot.
    pub fn drive(&self, log: &Log, network: &Arc<RoadNetwork>, vision: Vision) -> anyhow::Result<(Course, Vision)> {
        let at = takeover(log).context("holds neither an intervention nor a collision that nobody prevented")?;
        let start = self.start_of(log, at)?;
        let fork_tick = match self.otherwise {
            Otherwise::NoIntervention { earlier_ticks } => at.saturating_sub(earlier_ticks).max(start.tick + 1),
            Otherwise::OtherEye { .. } => start.tick + 1,
        };
        let mut manifest = log.manifest.clone();
        manifest.case = None;
        if let Some(weather) = self.weather {
            (manifest.scenario.weather, manifest.scenario.later) = (weather, None);
        }
        manifest.provenance.extend(self.provenance(fork_tick));
        manifest.provenance.insert(WRITTEN_BY.to_owned(), PROGRAM.to_owned());
        vision::replace_eye(&mut manifest.provenance, vision.eye());
        let end = at + self.after_ticks;
        manifest.scenario = lasting(manifest.scenario, end);
        let mut world = World::fork(&manifest.scenario, network, start)?;
        let mut recorder = Recorder::new(Vec::new(), &manifest, &world.initial_keyframe())?;
        // What an earlier drive left on the screen is none of this one's.
        let eye = vision.eye().clone();
        let semantic =
            SemanticBot::of_temper(Temper::told(&log.manifest.provenance, Seat::Semantic).unwrap_or_default());
        let mut crew = Crew::of(vision.with_eye(eye), semantic, self.safety_driver(&log.manifest.provenance));
        let (mut harm, mut collision) = (None, None);
        while world.tick() < end && world.arbiter().phase != Phase::Done {
            // The bots look on before the fork, too: their memory is then that of the drive.
            let (bots, shown) = crew.act(&world)?;
            let tick = world.tick() + 1;
            if tick == fork_tick {
                check(log, network, &world)?;
                harm = Harm::already(&world);
            }
            let input = if tick < fork_tick { logged(log, tick)? } else { self.controls(bots) };
            recorder.mask_shown(shown)?;
            let speed_mps = world.hud().speed_mps;
            let output = world.step(&input);
            recorder.tick(&input, &output, &world.part_hashes())?;
            if tick >= fork_tick {
                let mut harms = output.events.iter().filter_map(|event| Harm::of(event, &world, speed_mps));
                harm = harm.or_else(|| harms.clone().next());
                collision = collision.or_else(|| harms.find(|harm| harm.what == HarmKind::Collision));
            }
        }
        let intervention = world.arbiter().intervention.map(|i| i.tick);
        let recording = recorder.finish(world.arbiter().outcome)?;
        let recorded_harm = recorded_harm(log, network, at)?;
        let driven = Recording::from_bytes(&recording)?.into_log();
        let Criticality { extremes: closest, samples } =
            Criticality::of(&driven, network, fork_tick..=driven.last_tick())?;
        let near_miss = is_near_miss(samples.iter().filter(|sample| sample.tick <= at + EARLY_TICKS));
        let course = Course { recording, fork_tick, harm, collision, recorded_harm, intervention, near_miss, closest };
        Ok((course, crew.into_vision()))
    }

    fn start_of<'a>(&self, log: &'a Log, at: Tick) -> anyhow::Result<&'a Keyframe> {
        let label = log.annotation.as_ref().map(|annotation| annotation.label);
        let bored =
            label.filter(|label| *label == Label::Boredom && matches!(self.otherwise, Otherwise::OtherEye { .. }));
        let before = bored.map_or(CLIP_TICKS, fork_before_ticks);
        let early = log.keyframes.iter().rev().find(|keyframe| keyframe.tick + before <= at);
        let first = log.keyframes.first().filter(|first| bored.is_none() || first.tick == 0);
        early.or(first).with_context(|| match bored {
            Some(_) => format!(
                "begins less than {} s before a takeover out of boredom, which takes that long to come again; \
                 expected the recording instead of the case",
                before / Tick::from(TICK_HZ)
            ),
            None => "holds no keyframe to start from".into(),
        })
    }

    /// Somebody else than in the recorded run, or the same, but in the temper of then.
    fn safety_driver(&self, told: &Provenance) -> SafetyBot {
        let temper = Temper::told(told, Seat::Safety).unwrap_or_default();
        match self.otherwise {
            Otherwise::NoIntervention { .. } => SafetyBot::default().with_temper(temper),
            Otherwise::OtherEye { person } => SafetyBot::of_person(person).with_temper(temper),
        }
    }

    fn controls(&self, bots: TickInput) -> TickInput {
        match self.otherwise {
            Otherwise::NoIntervention { .. } => TickInput { safety: Controls::default(), ..bots },
            Otherwise::OtherEye { .. } => bots,
        }
    }

    fn provenance(&self, fork_tick: Tick) -> Vec<(String, String)> {
        let said = match self.otherwise {
            Otherwise::NoIntervention { .. } => "without the intervention",
            Otherwise::OtherEye { .. } => "through another checkpoint",
        };
        let mut entries = vec![
            ("fork".to_owned(), said.to_owned()),
            ("fork_tick".to_owned(), fork_tick.to_string()),
            ("semantic".to_owned(), "bot".to_owned()),
        ];
        if let Otherwise::OtherEye { person } = self.otherwise {
            entries.push(("safety_driver".to_owned(), format!("bot {person}")));
        }
        entries
    }
}

fn logged(log: &Log, tick: Tick) -> anyhow::Result<TickInput> {
    log.input(tick).copied().with_context(|| format!("holds no controls of tick {tick}"))
}

/// Where a run was taken over, or a collision that nobody prevented ended it.
pub fn takeover(log: &Log) -> Option<Tick> {
    log.intervention.map(|i| i.tick).or_else(|| Case::window(log).map(|window| *window.end()))
}

/// What went wrong all the same from the takeover on.
fn recorded_harm(log: &Log, network: &Arc<RoadNetwork>, at: Tick) -> anyhow::Result<Option<Harm>> {
    let mut replayer = Replayer::new(log, network.clone())?;
    replayer.seek(at - 1)?;
    loop {
        let speed_mps = replayer.world().hud().speed_mps;
        let Some(output) = replayer.step()? else { return Ok(None) };
        let harm = output.events.iter().find_map(|event| Harm::of(event, replayer.world(), speed_mps));
        if harm.is_some() {
            return Ok(harm);
        }
    }
}

/// The fork must leave the recorded run where that really was.
fn check(log: &Log, network: &Arc<RoadNetwork>, world: &World) -> anyhow::Result<()> {
    let mut replayer = Replayer::new(log, network.clone())?;
    replayer.seek(world.tick())?;
    // The first part names the scenario, which is another one where a fork lasts longer or has other weather.
    if replayer.world().part_hashes()[1..] != world.part_hashes()[1..] {
        bail!("tick {}: the fork is not the recorded run", world.tick());
    }
    Ok(())
}

impl Harm {
    /// What goes wrong already where the fork begins, and therefore has no event of its own.
    fn already(world: &World) -> Option<Self> {
        let watch = world.watch_state();
        let what = match (watch.wrong_way, watch.off_road) {
            (true, _) => HarmKind::WrongWay,
            (false, true) => HarmKind::OffRoad,
            (false, false) => return None,
        };
        Some(Self { tick: world.tick() + 1, what, with: None, speed_kmh: 3.6 * f64::from(world.hud().speed_mps) })
    }

    /// That of an event of the world's tick, before which the ego car had a speed.
    fn of(event: &Event, world: &World, speed_mps: f32) -> Option<Self> {
        let what = match event.kind {
            EventKind::CollisionActor | EventKind::CollisionScenery => HarmKind::Collision,
            EventKind::RedLight => HarmKind::RedLight,
            EventKind::WrongWay => HarmKind::WrongWay,
            EventKind::OffRoad => HarmKind::OffRoad,
            _ => return None,
        };
        let with = match event.kind {
            EventKind::CollisionActor => {
                world.scene().actors.iter().find(|a| a.id == event.actor).map(|a| words::road_user(a.kind))
            }
            EventKind::CollisionScenery => Some("scenery"),
            _ => None,
        };
        let with = with.map(str::to_owned);
        Some(Self { tick: world.tick(), what, with, speed_kmh: 3.6 * f64::from(speed_mps) })
    }

    /// What it was, how fast, and how long after a takeover.
    pub fn words(&self, after_s: f64) -> String {
        let with = self.with.as_ref().map(|with| format!(" with {with}")).unwrap_or_default();
        format!("{}{with} at {} km/h, {}", self.what.name(), words::kmh(self.speed_kmh / 3.6), from_takeover(after_s))
    }

    /// Seconds from a tick; negative before it.
    pub fn seconds_after(&self, tick: Tick) -> f64 {
        (self.tick as f64 - tick as f64) / f64::from(TICK_HZ)
    }
}

/// So many seconds after the takeover, in words.
pub fn from_takeover(after_s: f64) -> String {
    format!("{:.1} s {} the takeover", after_s.abs(), if after_s < 0.0 { "before" } else { "after" })
}
