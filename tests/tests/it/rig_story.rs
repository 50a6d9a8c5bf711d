//! Stories in OpenSCENARIO XML are driven, recorded and verified as all else; a recording that is exported as one is
//! played back as it was.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::Cli;
use aeye::exit;
use base::failure::sentence;
use base::scenario_file::ScenarioFile;
use clap::Parser;
use glam::Vec3;
use kernel::story::FIRST_STORY_ID;
use kernel::{TickInput, World};
use measures::footage::decisive_tick;
use replay::{Recording, Replayer};
use tests::recordings::{TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::busy_city;

/// Exit code and sentence of `aeye`.
fn aeye(arguments: &[&str]) -> (u8, String) {
    let cli = Cli::try_parse_from([&["aeye", "--json"], arguments].concat()).expect("a valid command line");
    let result = aeye::run(&cli);
    (exit::number(&result), result.err().map(|e| sentence(&e)).unwrap_or_default())
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a name in UTF-8")
}

/// The end of a recorded drive through the city as a story.
fn exported(folder: &Path) -> (PathBuf, PathBuf) {
    let (recording, out) = (folder.join("a.mcap"), folder.join("a.xosc"));
    fs::write(&recording, record(&busy_city(), TAKEOVER + 180, WITH_TAKEOVER)).unwrap();
    let (code, said) =
        aeye(&["export", text(&recording), "--last", "4s", "--format", "openscenario", "--out", text(&out)]);
    assert_eq!(code, 0, "{said}");
    (recording, out)
}

#[test]
fn an_exported_story_plays_everybody_as_they_were() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, out) = exported(dir.path());
    let file = ScenarioFile::read(&out).unwrap();
    assert_eq!(file.map.network.name, "a", "the map beside the story");
    let cast = &file.scenario.story.as_ref().expect("a story").script().cast;
    let mut world = World::new(&file.scenario, &file.map.network).unwrap();

    let recording = Recording::open(&recording).unwrap();
    let mut replayer = Replayer::new(recording.log(), recording.network().unwrap()).unwrap();
    let (last, length) = (decisive_tick(recording.log()), 240);
    let from = last + 1 - length;
    let (mut compared, mut worst_m) = (0, 0.0_f32);
    for tick in from..=last {
        replayer.run_to(tick).unwrap();
        let scene = replayer.world().scene();
        let was: BTreeMap<u32, Vec3> = scene.actors.iter().map(|actor| (actor.id, actor.position)).collect();
        for actor in world.scene().actors {
            let name = &cast[(actor.id - FIRST_STORY_ID) as usize].name;
            let id: u32 = name.trim_start_matches(char::is_alphabetic).parse().expect("its number");
            if let Some(was) = was.get(&id) {
                worst_m = worst_m.max((actor.position - *was).length());
                compared += 1;
            }
        }
        world.step(&TickInput::default());
    }
    assert!(compared > 10_000, "{compared}");
    assert!(worst_m < 0.01, "{worst_m} m");
}

#[test]
fn a_story_is_driven_recorded_and_verified() {
    let dir = tempfile::tempdir().unwrap();
    let (_, story) = exported(dir.path());
    let run = dir.path().join("run.mcap");
    let drive =
        ["drive", "--headless", "--scenario", text(&story), "--checkpoint", "truth", "--max-time", "5s", "--record"];
    let (code, said) = aeye(&[drive.as_slice(), &[text(&run)]].concat());
    assert_eq!(code, 0, "{said}");
    let (code, said) = aeye(&["verify", text(&run)]);
    assert_eq!(code, 0, "{said}");
    // Another story at the same place is not overwritten.
    fs::write(&story, "<OpenSCENARIO/>").unwrap();
    let again = ["export", text(&run), "--format", "openscenario", "--out", text(&story)];
    assert!(aeye(&again).1.contains("exists already and is no export of this"));
    let (code, said) =
        aeye(&["drive", "--headless", "--scenario", text(&story), "--max-time", "5s", "--record", "no.mcap"]);
    assert!(code != 0 && said.contains("a.xosc: line 1: <OpenSCENARIO> has no <RoadNetwork>"), "{code} {said}");
}
