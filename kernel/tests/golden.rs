//! A scripted drive on every bundled map ends in the state that the golden file says, in every
//! build. `AEYE_BLESS=1 cargo test -p kernel --release --test golden` writes the file.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

mod common;

use std::fmt::Write;

use common::script;
use kernel::events::EventKind;
use kernel::map::{self, BUNDLED};
use kernel::scenario::Scenario;
use kernel::{World, time::Tick};

const TICKS: Tick = 3600;
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden_hashes.txt");

/// One line: map, ticks, bytes of state, hash, and how often each kind of event happened. A size
/// that differs says the encoding changed, a hash that differs says the values did.
fn drive(name: &str) -> String {
    let network = map::bundled(name).expect("it is bundled");
    let mut world = World::new(&Scenario::default_for(name, 1), &network).expect("a default scenario fits");
    let mut counts = vec![0; EventKind::ALL.len()];
    for _ in 0..TICKS {
        for event in world.step(&script::input(&world)).events {
            counts[event.kind as usize] += 1;
        }
    }
    let mut line = format!("{name} {TICKS} {} {:?}", world.state_bytes(), world.hash());
    for (kind, count) in EventKind::ALL.iter().zip(&counts) {
        write!(line, " {kind:?}={count}").expect("writing to a string");
    }
    let happened = |kind: EventKind| counts[kind as usize] > 0;
    assert!(happened(EventKind::Intervention) && happened(EventKind::Ended), "{line}");
    assert!(happened(EventKind::CollisionActor) || happened(EventKind::CollisionScenery), "{line}");
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
