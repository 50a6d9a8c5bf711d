//! Traffic lives: nobody stands for ever, nobody is in anybody, nobody runs a light, nobody is missing.
//!
//! `AEYE_TRAFFIC=20x40 cargo test -p kernel --release --test traffic -- --nocapture` drives 20 seeds of 40
//! minutes on each bundled map, with the default counts and with 400 people, and 10 minutes of each file in
//! `../shared/maps` (or `AEYE_REAL_MAPS`), where that is; `AEYE_TRAFFIC_SEED` is the first seed, `AEYE_TRAFFIC_MAP` a map's name or
//! a part of it, `AEYE_TRAFFIC_WHO` names those who stand or overlap, `AEYE_TRAFFIC_HAZARDS` is the level of hazards.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

#[path = "common/census.rs"]
mod census;

use std::path::Path;
use std::sync::Arc;

use census::{Census, Drive};
use glam::Vec3;
use kernel::RoadNetwork;
use kernel::map::{bake, bundled};
use kernel::scenario::Scenario;
use kernel::traffic::{HazardLevel, HazardRates, Traffic, TrafficCounts};

/// Seeds of the short set; those that anything was tuned on begin at 1000.
const SEED: u64 = 1;

fn default_counts(map: &str, seed: u64) -> TrafficCounts {
    Scenario::default_for(map, seed).traffic
}

fn crowded(counts: TrafficCounts) -> TrafficCounts {
    TrafficCounts { pedestrians: 400, ..counts }
}

fn on(name: &str, seed: u64, minutes: u32) -> Drive {
    let network = bundled(name).expect("it is bundled");
    Drive { network, counts: default_counts(name, seed), hazards: HazardRates::NONE, seed, minutes }
}

fn with_people(drive: Drive) -> Drive {
    Drive { counts: crowded(drive.counts), ..drive }
}

/// What no run may hold.
fn is_sound(name: &str, drive: &Drive) {
    let census = drive.census();
    println!("{name:24} seed {:5}: {census}", drive.seed);
    assert_eq!((census.stood, census.overlaps, census.red), (0, [0, 0, 0], 0), "{name}: {census}");
    assert_eq!((census.missing, census.dissolved, census.collided), (0, 0, 0), "{name}: {census}");
}

#[test]
fn traffic_lives_in_the_city() {
    is_sound("city", &on("city", SEED, 10));
}

#[test]
fn traffic_lives_among_people() {
    is_sound("city, 400 people", &with_people(on("city", SEED, 10)));
}

#[test]
fn traffic_lives_in_the_country() {
    is_sound("rural", &on("rural", SEED, 10));
}

/// Two people for every three metres of ways of two metres: nobody jams, and nobody holds up traffic.
#[test]
fn people_get_past_each_other_where_it_is_narrow() {
    let drive = with_people(on("rural", SEED, 10));
    let census = drive.census();
    println!("rural, 400 people        seed {:5}: {census}", drive.seed);
    let found = (census.stood, census.overlaps, census.red, census.dissolved, census.collided);
    assert_eq!(found, (0, [0, 0, 0], 0, 0, 0), "{census}");
    assert!(census.walker_mps() > 0.7, "{census}");
}

/// With people at the wheel who make mistakes traffic lives too: they make some, nobody is hurt, nobody stands.
#[test]
fn traffic_lives_with_natural_hazards() {
    for name in ["city", "rural"] {
        let drive = Drive { hazards: HazardLevel::Natural.rates(), ..on(name, SEED, 10) };
        let census = drive.census();
        println!("{name:24} seed {:5}: {census}", drive.seed);
        assert_eq!((census.stood, census.overlaps, census.dissolved), (0, [0, 0, 0], 0), "{name}: {census}");
        assert!(census.mistakes > 0 && census.collided == 0, "{name}: {census}");
        assert!(census.red <= census.runners, "{name}: {census}, {} of them run a light", census.runners);
    }
}

/// A lane of a one-way road, with its width as (at the start, a metre).
fn lane(id: i32, (width_m, slope): (f64, f64), follows: bool) -> String {
    let link = if follows { format!("<successor id=\"{id}\"/>") } else { String::new() };
    format!(
        "<lane id=\"{id}\" type=\"driving\"><link><predecessor id=\"{id}\"/>{link}</link>\
         <width sOffset=\"0\" a=\"{width_m}\" b=\"{slope}\" c=\"0\" d=\"0\"/></lane>"
    )
}

/// A one-way road of 600 m whose second lane ends half-way, over 60 m.
fn lane_drop() -> Arc<RoadNetwork> {
    let section = |s: f64, lanes: String| {
        let center = "<center><lane id=\"0\" type=\"none\"/></center>";
        format!("<laneSection s=\"{s}\">{center}<right>{lanes}</right></laneSection>")
    };
    let full = (3.5, 0.0);
    let sections = [
        section(0.0, lane(-1, full, true) + &lane(-2, full, true)),
        section(300.0, lane(-1, full, true) + &lane(-2, (3.5, -3.5 / 60.0), false)),
        section(360.0, lane(-1, full, false)),
    ];
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\
         <road id=\"0\" length=\"600\" junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" \
         length=\"600\"><line/></geometry></planView><lanes>{}</lanes></road></OpenDRIVE>",
        sections.concat()
    );
    Arc::new(bake("lane_drop", &text).expect("it bakes"))
}

#[test]
fn a_lane_that_ends_merges_into_the_one_beside_it() {
    let counts = TrafficCounts { cars: 16, motorcycles: 1, bicycles: 1, ..TrafficCounts::NONE };
    let hazards = HazardRates::NONE;
    is_sound("lane_drop", &Drive { network: lane_drop(), counts, hazards, seed: SEED, minutes: 10 });
}

#[test]
fn who_has_no_room_is_told() {
    let counts = TrafficCounts { cars: 400, pedestrians: 7, ..TrafficCounts::NONE };
    let traffic = Traffic::spawn(&counts, SEED, lane_drop().ways(), Vec3::new(1e5, 0.0, 0.0));
    let (there, missing) = (traffic.bodies().len(), traffic.missing());
    assert!(there > 80, "960 m of lanes hold {there} vehicles");
    assert_eq!(missing.to_string(), format!("{} of 400 cars and 7 of 7 pedestrians", 400 - there));
}

/// The files of `../shared/maps`, where that is.
fn shared() -> Vec<(String, Arc<RoadNetwork>)> {
    let named = std::env::var("AEYE_REAL_MAPS").ok();
    let roots = named.as_deref().into_iter().chain(["../../shared/maps", "../../../shared/maps"]);
    let root = roots.map(Path::new).find(|root| root.is_dir());
    let Some(files) = root.and_then(|root| std::fs::read_dir(root).ok()) else { return Vec::new() };
    let mut paths: Vec<_> = files.filter_map(|file| Some(file.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "xodr"));
    paths.sort();
    let load = |path: &Path| {
        let name = path.file_stem()?.to_str()?.to_owned();
        let network = bake(&name, &std::fs::read_to_string(path).ok()?).ok()?;
        Some((name, Arc::new(network)))
    };
    paths.iter().filter_map(|path| load(path)).collect()
}

#[test]
fn traffic_lives_for_long_where_that_is_asked_for() {
    let Ok(asked) = std::env::var("AEYE_TRAFFIC") else { return };
    let (seeds, minutes) = asked.split_once('x').expect("AEYE_TRAFFIC=SEEDSxMINUTES");
    let (seeds, minutes): (u64, u32) = (seeds.parse().expect("seeds"), minutes.parse().expect("minutes"));
    let first = std::env::var("AEYE_TRAFFIC_SEED").map_or(SEED, |seed| seed.parse().expect("a seed"));
    let wanted = std::env::var("AEYE_TRAFFIC_MAP").unwrap_or_default();
    let mut drives = Vec::new();
    for name in kernel::map::BUNDLED {
        drives.push((name.to_owned(), (first..first + seeds).map(|s| on(name, s, minutes)).collect::<Vec<_>>()));
        let crowds = (first..first + seeds).map(|s| with_people(on(name, s, minutes)));
        drives.push((format!("{name}, 400 people"), crowds.collect()));
    }
    for (name, network) in shared() {
        let minutes = minutes.min(10);
        let drive = |seed| {
            let mut counts = default_counts(&name, seed);
            if name == "Town06" {
                counts = TrafficCounts { cars: 60, ..TrafficCounts::NONE };
            }
            Drive { network: network.clone(), counts, hazards: HazardRates::NONE, seed, minutes }
        };
        drives.push((name.clone(), (first..first + seeds.min(3)).map(drive).collect()));
    }
    let level = std::env::var("AEYE_TRAFFIC_HAZARDS").unwrap_or_else(|_| "none".into());
    let hazards = HazardLevel::named(&level).expect("a level of hazards").rates();
    drives.iter_mut().flat_map(|(_, runs)| runs).for_each(|drive| drive.hazards = hazards);
    let is_one = drives.iter().any(|(name, _)| *name == wanted);
    drives.retain(|(name, _)| if is_one { *name == wanted } else { name.contains(&wanted) });
    for (name, runs) in drives {
        let mut all = Census::default();
        for drive in &runs {
            let census = drive.census();
            if runs.len() <= 5 || census.stood > 0 {
                println!("{name:28} seed {:5}: {census}", drive.seed);
            }
            all.add(&census);
        }
        println!("{name:28}  {:3} runs: {all}", runs.len());
    }
}
