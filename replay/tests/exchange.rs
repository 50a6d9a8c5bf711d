//! Recordings are the same files whatever build wrote them, and each build replays those of the others.
//! `tests/matrix.sh` runs this in several builds with one folder between them.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

use std::fs;
use std::io::Cursor;
use std::path::PathBuf;

use kernel::map::{self, BUNDLED};
use kernel::time::{Tick, seconds};
use kernel::{Controls, Scenario, TickInput, World};
use replay::{Manifest, Provenance, Recorder, Recording, verify};

const TICKS: Tick = seconds(25);
const SEED: u64 = 7;
/// Names the folder in which recordings are exchanged.
const FOLDER: &str = "AEYE_EXCHANGE";
/// What this build is called in there.
const BUILD: &str = "AEYE_BUILD";

/// Follows the route, and brakes for 3 s at the end, which is an intervention.
fn input(world: &World) -> TickInput {
    let hud = world.hud();
    let gap = 0.8 * hud.limit_mps - hud.speed_mps;
    let semantic = Controls::from_fractions(f32::from(hud.arrow.bearing_deg) * 0.013, gap * 0.3, -gap * 0.2);
    let braking = world.tick() > TICKS - seconds(3);
    TickInput { semantic, safety: Controls::from_fractions(0.0, 0.0, if braking { 0.8 } else { 0.0 }) }
}

fn recorded(name: &str) -> Vec<u8> {
    let network = map::bundled(name).expect("it is bundled");
    let scenario = Scenario::default_for(name, SEED);
    let mut world = World::new(&scenario, &network).expect("a default scenario fits");
    let manifest = Manifest::new(&scenario, &network, None, Provenance::new());
    let mut recorder =
        Recorder::new(Cursor::new(Vec::new()), &manifest, &world.initial_keyframe()).expect("memory takes it");
    for _ in 0..TICKS {
        let input = input(&world);
        let output = world.step(&input);
        recorder.tick(&input, &output, &world.part_hashes()).expect("memory takes it");
    }
    recorder.finish(world.arbiter().outcome).expect("memory takes it").into_inner()
}

/// Simulates a recording again.
fn replays(name: &str, bytes: &[u8], whose: &str) {
    let recording = Recording::from_bytes(bytes).unwrap_or_else(|e| panic!("{whose}: {e}"));
    let report = verify(recording.log(), &map::bundled(name).expect("it is bundled")).expect("the log fits its map");
    assert_eq!(report.divergence, None, "{whose}");
    assert!(
        recording.log().keyframes.len() > 2 && recording.log().intervention.is_some(),
        "{whose} holds what it should"
    );
}

#[test]
fn builds_write_the_same_recordings_and_replay_each_others() {
    let folder = std::env::var_os(FOLDER).map(PathBuf::from);
    for name in BUNDLED {
        let own = recorded(name);
        replays(name, &own, "this build's own recording");
        let Some(folder) = &folder else { continue };
        let build = std::env::var(BUILD).expect("AEYE_BUILD says what this build is called");
        fs::write(folder.join(format!("{name}.{build}")), &own).expect("the folder takes it");
        for file in fs::read_dir(folder).expect("the folder lists") {
            let path = file.expect("the folder lists").path();
            if path.file_stem().is_some_and(|stem| stem == name) {
                let other = fs::read(&path).expect("it reads");
                replays(name, &other, &path.display().to_string());
                assert!(other == own, "{} differs from what this build writes", path.display());
            }
        }
    }
}
