//! A scripted drive on every bundled map ends in the state that the golden file says, in every
//! build. `AEYE_BLESS=1 cargo test -p kernel --release --test golden` writes the file.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

mod common;

use std::fmt::Write;

use common::script;
use kernel::arbiter::Phase;
use kernel::events::{EventKind, Hud};
use kernel::map::{self, BUNDLED};
use kernel::scenario::Scenario;
use kernel::signals::LightPhase;
use kernel::time::Tick;
use kernel::{Seat, World};

const TICKS: Tick = 3600;
/// With this seed the script brings about everything that a map can hold.
const SEED: u64 = 101;
/// Maps on which there are lights to keep and to pass at red.
const LIT: [&str; 1] = ["city"];
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden_hashes.txt");

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
}

impl Held {
    fn note(&mut self, phase: Phase, pedals: Seat, hud: &Hud) {
        self.overridden |= phase == Phase::Arming && pedals == Seat::Safety;
        let at_line = hud.light_distance_m < 5 && hud.speed_mps.abs() < 0.3;
        self.waited |= at_line && hud.light == Some(LightPhase::Red);
        let goes = hud.light == Some(LightPhase::Green) && hud.speed_mps > 2.0;
        self.light_kept |= self.waited && goes && phase == Phase::Driving;
    }

    /// What should have happened on a map and did not.
    fn lacks(&self, map: &str) -> Vec<String> {
        let lit = LIT.contains(&map);
        let kinds = EventKind::ALL.iter().filter(|kind| lit || **kind != EventKind::RedLight);
        let mut lacks: Vec<_> =
            kinds.filter(|kind| self.events[**kind as usize] == 0).map(|kind| format!("{kind:?}")).collect();
        lacks.extend((!self.overridden).then(|| "an override before arming".to_owned()));
        lacks.extend((lit && !self.light_kept).then(|| "a light kept".to_owned()));
        lacks
    }
}

/// One line: map, ticks, bytes of state, hash, and how often each kind of event happened. A size
/// that differs says the encoding changed, a hash that differs says the values did.
fn drive(name: &str) -> String {
    let network = map::bundled(name).expect("it is bundled");
    let mut world = World::new(&Scenario::default_for(name, SEED), &network).expect("a default scenario fits");
    let mut held = Held { events: Default::default(), overridden: false, waited: false, light_kept: false };
    for _ in 0..TICKS {
        let output = world.step(&script::input(&world));
        output.events.iter().for_each(|event| held.events[event.kind as usize] += 1);
        held.note(world.arbiter().phase, output.applied.pedals, &world.hud());
    }
    let mut line = format!("{name} {TICKS} {} {:?}", world.state_bytes(), world.hash());
    for (kind, count) in EventKind::ALL.iter().zip(held.events) {
        write!(line, " {kind:?}={count}").expect("writing to a string");
    }
    let lacks = held.lacks(name);
    assert!(lacks.is_empty(), "the drive lacks {}: {line}", lacks.join(", "));
    line
}

#[test]
fn every_build_drives_the_same() {
    let driven: Vec<String> = BUNDLED.iter().map(|name| drive(name)).collect();
    let driven = driven.join("\n") + "\n";
    if std::env::var("AEYE_BLESS").is_ok_and(|bless| bless == "1") {
        std::fs::write(FILE, &driven).expect("the golden file can be written");
    }
    let golden = std::fs::read_to_string(FILE).expect("tests/golden_hashes.txt is there (AEYE_BLESS=1 writes it)");
    assert_eq!(driven, golden, "this build drives differently from the golden file");
}
