//! Bundled stories go as the golden timeline says in every build, resume from each keyframe and fork at them.
//! `AEYE_BLESS=1 cargo test -p kernel --release --test stories` writes it.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

mod common;

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use common::script;
use kernel::map;
use kernel::scenario::{HazardRates, Scenario, TrafficCounts};
use kernel::story::{BUNDLED, Story, bundled_text};
use kernel::time::{TICK_HZ, Tick};
use kernel::{Keyframe, RoadNetwork, World};

/// One with lane changes and braking, one on foot beside a bus, one with lights and somebody who arrives in time.
const STORIES: [&str; 3] = ["cut_in_and_brakes", "child_from_behind_bus", "red_light_runner"];
const TICKS: Tick = 26 * 60;
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden_stories.txt");

fn opened(name: &str) -> (Scenario, Arc<RoadNetwork>) {
    let story = Story::read(bundled_text(name).expect("it is bundled")).expect("it is a story");
    let map = Path::new(story.map_file()).file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
    let traffic = TrafficCounts { cars: 12, pedestrians: 12, ..TrafficCounts::NONE };
    let mut scenario = Scenario { traffic, hazards: HazardRates::NONE, ..Scenario::default_for(&map, 7) };
    scenario.play(story.varied(7).expect("it varies"));
    (scenario, map::bundled(&map).expect("it is bundled"))
}

/// Each second of a story, with the hash of its state; and the keyframes.
fn played(name: &str) -> (String, Vec<Keyframe>) {
    let (scenario, network) = opened(name);
    let mut world = World::new(&scenario, &network).expect("the scenario fits");
    let (mut lines, mut keyframes) = (format!("{name} bytes={}\n", world.state_bytes()), Vec::new());
    for _ in 0..TICKS {
        let output = world.step(&script::input(&world));
        keyframes.extend(output.keyframe);
        if output.tick.is_multiple_of(Tick::from(TICK_HZ)) {
            writeln!(lines, "{name} {} {:032x}", output.tick / Tick::from(TICK_HZ), output.hash.0)
                .expect("writing to a string");
        }
    }
    (lines, keyframes)
}

#[test]
fn every_build_plays_the_same() {
    let played: String = STORIES.iter().map(|name| played(name).0).collect();
    if std::env::var("AEYE_BLESS").is_ok_and(|bless| bless == "1") {
        std::fs::write(FILE, &played).expect("the golden file can be written");
    }
    let golden = std::fs::read_to_string(FILE).expect("tests/golden_stories.txt is there (AEYE_BLESS=1 writes it)");
    let differs = golden.lines().zip(played.lines()).find(|(golden, played)| golden != played);
    assert_eq!((differs, golden.lines().count()), (None, played.lines().count()));
}

#[test]
fn stories_resume_and_fork_from_every_keyframe() {
    for name in STORIES {
        let (scenario, network) = opened(name);
        let (_, keyframes) = played(name);
        assert!(keyframes.len() >= 2, "{name}: {}", keyframes.len());
        for keyframe in keyframes {
            let mut resumed = World::resume(&scenario, &network, &keyframe).expect("it is its own");
            // Another run of the same story, with other weather.
            let mut other = scenario.clone();
            other.weather.cloudiness_pct = 90.0;
            let mut fork = World::fork(&other, &network, &keyframe).expect("it has the same story");
            for tick in 0..300 {
                let input = script::input(&resumed);
                assert_eq!(resumed.step(&input).tick, fork.step(&input).tick);
                let (a, b) = (resumed.scene(), fork.scene());
                assert_eq!((&a.actors, a.ego), (&b.actors, b.ego), "{name}, {tick} ticks after {}", keyframe.tick);
            }
        }
    }
}

#[test]
fn a_keyframe_without_a_part_of_its_story_is_another() {
    let (scenario, network) = opened("cut_in_and_brakes");
    let (_, keyframes) = played("cut_in_and_brakes");
    let keyframe = keyframes.first().expect("one is made every 12 s");
    // The story's bytes are the last ones: whatever of them is left out, or is another, the world is refused or goes elsewhere.
    let world = World::resume(&scenario, &network, keyframe).expect("it is its own");
    let hash = world.hash();
    let is_another = |bytes: Vec<u8>| {
        let changed = Keyframe { tick: keyframe.tick, bytes };
        World::resume(&scenario, &network, &changed).map_or(true, |other| other.hash() != hash)
    };
    for at in (keyframe.bytes.len() - 400)..keyframe.bytes.len() {
        let mut bytes = keyframe.bytes.clone();
        bytes[at] ^= 1;
        assert!(is_another(bytes), "byte {at}");
        let mut bytes = keyframe.bytes.clone();
        bytes.remove(at);
        assert!(is_another(bytes), "without byte {at}");
    }
}

#[test]
fn every_file_of_the_folder_is_bundled() {
    let folder = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/stories")).expect("it is there");
    let files = folder.map(|entry| entry.expect("readable").file_name().into_string().expect("plain"));
    let mut stories: Vec<String> = files.filter_map(|file| Some(file.strip_suffix(".xosc")?.to_owned())).collect();
    stories.sort();
    assert_eq!(stories, BUNDLED.map(|(name, _)| name));
}
