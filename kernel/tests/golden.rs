//! A scripted drive on every bundled map and through a roundabout goes as the golden timeline says, second by second and
//! part by part, in every build. `AEYE_BLESS=1 cargo test -p kernel --release --test golden` writes it, and
//! the kernel has another identity from then on ([`kernel::identity`]).
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

mod common;
#[path = "common/roundabout.rs"]
mod roundabout;

use std::fmt::Write;
use std::sync::Arc;

use common::script;
use kernel::arbiter::Phase;
use kernel::events::{EventKind, Hud};
use kernel::map::{self, SurfaceKind};
use kernel::scenario::Scenario;
use kernel::signals::LightPhase;
use kernel::time::{TICK_HZ, Tick};
use kernel::world::PARTS;
use kernel::{RoadNetwork, Seat, World};
use roundabout::Roundabout;

const TICKS: Tick = 3600;

/// A drive of the timeline.
struct Drive {
    /// What its lines begin with.
    name: &'static str,
    map: &'static str,
    seed: u64,
    /// What the scenario says beyond that.
    scenario: &'static str,
}

/// With these seeds the script brings about everything that a map can hold; on one drive others make mistakes, while
/// rain begins, on one people step out before the car again and again, and on the last they drive round, which they do on
/// no bundled map.
const DRIVES: [Drive; 5] = [
    Drive { name: "city", map: "city", seed: 101, scenario: "" },
    Drive { name: "rural", map: "rural", seed: 6, scenario: "" },
    Drive {
        name: "mistakes",
        map: "city",
        seed: 116,
        scenario: "[hazards]\nlevel = \"raised\"\nred_light_runners = 1.0\nrolling_stops = 1.0\ncut_ins_per_h = 600.0\n\
                   hard_brakings_per_h = 120.0\npull_outs_per_h = 600.0\n\
                   [weather.later]\npreset = \"HardRainNoon\"\nover_s = 40.0\n",
    },
    Drive {
        name: CROSSED,
        map: "suburb",
        seed: 5,
        scenario: "[traffic]\npedestrians = 300\njaywalks_per_min = 60.0\n",
    },
    Drive { name: ROUND, map: ROUND, seed: 61, scenario: "[traffic]\ncars = 50\nmotorcycles = 4\nbicycles = 6\n" },
];

impl Drive {
    fn scenario(&self) -> Scenario {
        let Self { map, seed, scenario, .. } = self;
        Scenario::from_toml(&format!("map = \"{map}\"\nseed = {seed}\n{scenario}")).expect("a valid scenario")
    }

    fn network(&self) -> Arc<RoadNetwork> {
        match self.map {
            ROUND => Arc::new(map::bake(ROUND, &Roundabout::default().open_drive()).expect("it bakes")),
            bundled => map::bundled(bundled).expect("it is bundled"),
        }
    }
}

/// Drives on which there are lights to keep and to pass at red.
const LIT: [&str; 1] = ["city"];
/// The drive on which others make mistakes, and those that it must hold.
const MISTAKEN: &str = "mistakes";
const MISTAKES: [EventKind; 3] = [EventKind::HazardRollingStop, EventKind::HazardBraking, EventKind::HazardPullOut];
/// The drive before which people step out, and how many of its seconds somebody is on the road ahead at least.
const CROSSED: &str = "crossed";
const CROSSED_S: u32 = 5;
/// So far ahead, metres.
const AHEAD_M: f32 = 40.0;
/// The drive through a roundabout, and how many of its seconds somebody drives round at least.
const ROUND: &str = "roundabout";
const ROUND_S: u32 = 30;
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden_timeline.txt");

/// What a drive held, so that its hash cannot come to stand for less.
struct Held {
    /// How often each kind of event happened.
    events: [u32; EventKind::ALL.len()],
    /// The safety driver acted on the car before the run was armed.
    overridden: bool,
    /// The car stands, or stood, before a red light.
    waited: bool,
    /// It waited, and drove on at green before anyone intervened.
    light_kept: bool,
    /// Seconds in which somebody on foot was on the road ahead.
    crossed_s: u32,
    /// Seconds in which somebody was where a roundabout is.
    round_s: u32,
}

impl Held {
    fn note(&mut self, phase: Phase, pedals: Seat, hud: &Hud) {
        self.overridden |= phase == Phase::Arming && pedals == Seat::Safety;
        let at_line = hud.light_distance_m < 5 && hud.speed_mps.abs() < 0.3;
        self.waited |= at_line && hud.light == Some(LightPhase::Red);
        let goes = hud.light == Some(LightPhase::Green) && hud.speed_mps > 2.0;
        self.light_kept |= self.waited && goes && phase == Phase::Driving;
    }

    /// What should have happened on a drive and did not.
    fn lacks(&self, drive: &str) -> Vec<String> {
        let absent = |kind: &&EventKind| self.events[**kind as usize] == 0;
        if drive == MISTAKEN {
            return MISTAKES.iter().filter(absent).map(|kind| format!("{kind:?}")).collect();
        }
        if drive == ROUND {
            return if self.round_s < ROUND_S { vec!["vehicles that drive round".to_owned()] } else { Vec::new() };
        }
        if drive == CROSSED {
            return if self.crossed_s < CROSSED_S { vec!["people on the road".to_owned()] } else { Vec::new() };
        }
        let lit = LIT.contains(&drive);
        // What the watchdog tells is a failure of traffic, and mistakes are rare by themselves.
        let rare = |kind: EventKind| format!("{kind:?}").starts_with("Hazard");
        let watchdog = [EventKind::Stuck, EventKind::Dissolved];
        let kinds = EventKind::ALL.iter().filter(|kind| !watchdog.contains(kind) && !rare(**kind));
        let kinds = kinds.filter(|kind| lit || **kind != EventKind::RedLight);
        let mut lacks: Vec<_> = kinds.filter(absent).map(|kind| format!("{kind:?}")).collect();
        lacks.extend((!self.overridden).then(|| "an override before arming".to_owned()));
        lacks.extend((lit && !self.light_kept).then(|| "a light kept".to_owned()));
        lacks
    }
}

/// The timeline of a drive: one line with the bytes of state and how often each kind of event happened, then one
/// for each second with the low 32 bits of a hash for each of [`PARTS`]. A size that differs says the encoding
/// changed, a hash that differs says the values did.
fn drive(drive: &Drive) -> String {
    let name = drive.name;
    let network = drive.network();
    let mut world = World::new(&drive.scenario(), &network).expect("the scenario fits");
    let mut held = Held {
        events: Default::default(),
        overridden: false,
        waited: false,
        light_kept: false,
        crossed_s: 0,
        round_s: 0,
    };
    let mut seconds = String::new();
    for _ in 0..TICKS {
        let output = world.step(&script::input(&world));
        output.events.iter().for_each(|event| held.events[event.kind as usize] += 1);
        held.note(world.arbiter().phase, output.applied.pedals, &world.hud());
        if output.tick.is_multiple_of(Tick::from(TICK_HZ)) {
            held.crossed_s += u32::from(somebody_crosses(&world, &network));
            held.round_s += u32::from(somebody_drives_round(&world));
            let hashes = world.part_hashes().map(|hash| format!("{:08x}", hash as u32)).join(" ");
            writeln!(seconds, "{name} {} {hashes}", output.tick / Tick::from(TICK_HZ)).expect("writing to a string");
        }
    }
    let mut head = format!("{name} bytes={}", world.state_bytes());
    for (kind, count) in EventKind::ALL.iter().zip(held.events) {
        write!(head, " {kind:?}={count}").expect("writing to a string");
    }
    let lacks = held.lacks(name);
    assert!(lacks.is_empty(), "the drive lacks {}: {head}", lacks.join(", "));
    format!("{head}\n{seconds}")
}

/// Whether somebody on foot is on the road within [`AHEAD_M`] before the car.
fn somebody_crosses(world: &World, network: &RoadNetwork) -> bool {
    let scene = world.scene();
    let ahead = scene.ego.rotation * glam::Vec3::X;
    let is_ahead = |at: glam::Vec3| {
        let offset = at - scene.ego.position;
        offset.dot(ahead) > 0.0 && offset.length() < AHEAD_M
    };
    let is_road = |at| network.ground(at).is_some_and(|ground| ground.kind == SurfaceKind::Road);
    scene.actors.iter().any(|a| a.kind.is_on_foot() && is_ahead(a.position) && is_road(a.position))
}

/// Whether a vehicle is within the outer edge of the roundabout's ring, whose middle is at zero.
fn somebody_drives_round(world: &World) -> bool {
    let inside = |at: glam::Vec3| f64::from(at.truncate().length()) < Roundabout::default().radius_m + 2.5;
    world.scene().actors.iter().any(|actor| actor.kind.is_car_or_heavier() && inside(actor.position))
}

/// What differs first between two timelines: which parts of the state, on which map, in which second.
fn difference(golden: &str, driven: &str) -> Option<String> {
    let (mut golden, mut driven) = (golden.lines(), driven.lines());
    loop {
        let (expected, got) = match (golden.next(), driven.next()) {
            (None, None) => return None,
            (expected, got) => (expected.unwrap_or("nothing"), got.unwrap_or("nothing")),
        };
        if expected == got {
            continue;
        }
        let columns = |line: &str| line.split(' ').map(str::to_owned).collect::<Vec<_>>();
        let (a, b) = (columns(expected), columns(got));
        let timed = a.len() == PARTS.len() + 2 && a.len() == b.len() && a[..2] == b[..2];
        let parts = PARTS.iter().zip(a.iter().zip(&b).skip(2)).filter(|(_, (a, b))| a != b).map(|(part, _)| *part);
        return Some(match timed {
            true => format!("{}: {} first, at second {}", a[0], parts.collect::<Vec<_>>().join(" and "), a[1]),
            false => format!("expected {expected}\n     got {got}"),
        });
    }
}

#[test]
fn every_build_drives_the_same() {
    let driven: String = DRIVES.iter().map(drive).collect();
    if std::env::var("AEYE_BLESS").is_ok_and(|bless| bless == "1") {
        std::fs::write(FILE, &driven).expect("the golden file can be written");
    }
    let golden = std::fs::read_to_string(FILE).expect("tests/golden_timeline.txt is there (AEYE_BLESS=1 writes it)");
    if let Some(difference) = difference(&golden, &driven) {
        panic!("this build drives differently from the golden timeline: {difference}");
    }
}

#[test]
fn a_difference_says_which_part_was_first_and_when() {
    let golden = "city bytes=9 Seen=1\ncity 3 1 2 3 4 5 6 7\ncity 4 1 2 3 4 5 6 7\ncity 5 1 2 3 4 5 6 7\n";
    assert_eq!(difference(golden, golden), None);
    let said = |driven: &str| difference(golden, driven).expect("they differ");
    let driven = golden.replace("city 4 1 2 3", "city 4 1 2 9").replace("city 5 1 2 3 4 5 6", "city 5 1 9 9 9 9 9");
    assert_eq!(said(&driven), "city: vehicles first, at second 4");
    assert_eq!(said(&golden.replace("city 4 1 2 3", "city 4 0 2 0")), "city: input and vehicles first, at second 4");
    assert_eq!(
        said(&golden.replace("bytes=9", "bytes=8")),
        "expected city bytes=9 Seen=1\n     got city bytes=8 Seen=1"
    );
    assert!(said(&golden[..golden.len() - 20]).starts_with("expected city 5"));
}
