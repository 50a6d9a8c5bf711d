//! Every hazard by its name: the scenario files of the documentation show what they say they show.
#![allow(clippy::disallowed_methods, reason = "tests may read files")]

mod common;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use common::script;
use glam::Vec3;
use kernel::events::EventKind;
use kernel::map::{RoadNetwork, bake, bundled};
use kernel::scenario::{HazardRates, Scenario};
use kernel::scene::SceneSnapshot;
use kernel::time::seconds;
use kernel::{Controls, TickInput, World};

/// Simulated time of each file, s.
const DRIVE_S: u32 = 180;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/hazards")
}

fn scenario(name: &str) -> Scenario {
    let path = folder().join(format!("{name}.toml"));
    let text = std::fs::read_to_string(&path).expect("the file is there");
    Scenario::from_toml(&text).expect("a valid scenario")
}

/// Metres to whoever is next before the ego car.
fn free_m(scene: &SceneSnapshot) -> f32 {
    let forward = scene.ego.rotation * Vec3::X;
    let ahead = scene.actors.iter().filter_map(|actor| {
        let to = actor.position - scene.ego.position;
        let (ahead_m, aside_m) = (to.dot(forward), forward.cross(to).z.abs());
        (ahead_m > 0.0 && aside_m < 2.2).then_some(ahead_m - 5.0)
    });
    ahead.fold(f32::MAX, f32::min)
}

/// Drives by the HUD, and not into anybody ahead.
fn careful(world: &World) -> Controls {
    let (scene, speed_mps) = (world.scene(), world.hud().speed_mps);
    let room_m = free_m(&scene);
    match speed_mps * speed_mps / (2.0 * 3.0) + 1.0 > room_m {
        true => Controls { throttle: 0, ..Controls::from_fractions(0.0, 0.0, 0.7) },
        false => script::polite(world),
    }
}

/// A bundled map, or one that lies beside the scenario, and the scenario on it.
fn on_its_map(scenario: &Scenario) -> (Scenario, Arc<RoadNetwork>) {
    let Some(name) = scenario.map.strip_suffix(".xodr") else {
        return (scenario.clone(), bundled(&scenario.map).expect("a bundled map"));
    };
    let text = std::fs::read_to_string(folder().join(&scenario.map)).expect("the map is there");
    (Scenario { map: name.to_owned(), ..scenario.clone() }, Arc::new(bake(name, &text).expect("it bakes")))
}

/// Drives a scenario; what happened of the kind, and the world at the end.
fn drive(scenario: &Scenario, kind: Option<EventKind>) -> (usize, World) {
    let (scenario, network) = on_its_map(scenario);
    let mut world = World::new(&scenario, &network).expect("the scenario fits");
    let mut found = 0;
    for _ in 0..seconds(DRIVE_S) {
        let output = world.step(&TickInput { semantic: careful(&world), ..TickInput::default() });
        for event in output.events.iter().filter(|event| Some(event.kind) == kind) {
            let scene = world.scene();
            let actor = scene.actors.iter().find(|actor| actor.id == event.actor).expect("it names an actor");
            assert!(actor.position.distance(scene.ego.position) < 102.0, "near the ego car");
            found += 1;
        }
    }
    (found, world)
}

#[test]
fn every_file_shows_its_hazard() {
    let kinds = [
        ("red-light-runners", EventKind::HazardRedLight),
        ("rolling-stops", EventKind::HazardRollingStop),
        ("cut-ins", EventKind::HazardCutIn),
        ("hard-braking", EventKind::HazardBraking),
        ("pull-outs", EventKind::HazardPullOut),
        ("doors", EventKind::HazardDoor),
    ];
    for (name, kind) in kinds {
        let (found, _) = drive(&scenario(name), Some(kind));
        println!("{name}: {found} in {DRIVE_S} s near the ego car");
        assert!(found > 0, "{name}: none in {DRIVE_S} s");
    }
    // These are no events: they change how everybody drives.
    for name in ["tailgaters", "inattention"] {
        let scenario = scenario(name);
        assert_ne!(scenario.hazards, HazardRates::NONE);
        let perfect = Scenario { hazards: HazardRates::NONE, ..scenario.clone() };
        let [some, none] = [&scenario, &perfect].map(|scenario| drive(scenario, None).1.scene());
        assert_ne!(some.actors, none.actors, "{name}");
    }
}

#[test]
fn there_is_a_test_for_every_file() {
    let files = std::fs::read_dir(folder()).expect("the folder is there");
    let tomls =
        files.filter(|file| file.as_ref().is_ok_and(|file| file.path().extension().is_some_and(|e| e == "toml")));
    assert_eq!(tomls.count(), 8);
}
