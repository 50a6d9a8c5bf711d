//! Traffic lives: nobody stands for ever, nobody is in anybody, nobody runs a light, nobody is missing.
//!
//! `AEYE_TRAFFIC=20x40 cargo test -p kernel --release --test traffic -- --nocapture` drives 20 seeds of 40
//! minutes on each bundled map, with the default counts and with 400 people, and 10 minutes of each file in
//! `../shared/maps` (or `AEYE_REAL_MAPS`), where that is; `AEYE_TRAFFIC_SEED` is the first seed, `AEYE_TRAFFIC_MAP` a map's name or
//! a part of it, or `roundabout` for generated ones, which are driven only when asked for; `AEYE_TRAFFIC_WHO` names those who stand
//! or overlap, `AEYE_TRAFFIC_HAZARDS` is the level of hazards.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

#[path = "common/census.rs"]
mod census;
#[path = "common/roundabout.rs"]
mod roundabout;

use std::path::Path;
use std::sync::Arc;

use census::{Census, Drive};
use glam::Vec3;
use kernel::RoadNetwork;
use kernel::map::{Lane, StopKind, bake, bundled};
use kernel::scenario::Scenario;
use kernel::traffic::{HazardLevel, HazardRates, Traffic, TrafficCounts};
use roundabout::Roundabout;

/// Seeds of the short set; those that anything was tuned on begin at 1000.
const SEED: u64 = 1;
/// Least mean speed on a roundabout at rush hour with its arms, those who wait among them, km/h.
const LEAST_KMH: f64 = 5.0;

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

/// What no run may hold; the rest of what was counted.
fn is_sound(name: &str, drive: &Drive) -> Census {
    let census = drive.census();
    println!("{name:24} seed {:5}: {census}", drive.seed);
    assert_eq!((census.stood, census.overlaps, census.red), (0, [0, 0, 0], 0), "{name}: {census}");
    assert_eq!((census.missing, census.dissolved, census.collided), (0, 0, 0), "{name}: {census}");
    census
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

/// Over the level crossing, through the tunnel and over the hill, on several seeds.
#[test]
fn traffic_lives_by_the_lake() {
    for seed in SEED..SEED + 3 {
        is_sound("lakeside", &on("lakeside", seed, 10));
    }
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

/// Roundabouts of several sizes, on both sides of the road.
fn roundabouts() -> Vec<Roundabout> {
    let mut found = Vec::new();
    for radius_m in [10.0, 18.0, 25.0, 35.0] {
        for arms in 3..=5 {
            let right_hand = Roundabout { radius_m, arms, ..Roundabout::default() };
            found.extend([right_hand, Roundabout { left_hand: true, ..right_hand }]);
        }
    }
    found.retain(Roundabout::is_drivable);
    found
}

fn baked(roundabout: &Roundabout) -> Arc<RoadNetwork> {
    Arc::new(bake("roundabout", &roundabout.open_drive()).expect("it bakes"))
}

/// Fifteen vehicles for each arm, three of them on two wheels: a city at rush hour.
fn round(roundabout: &Roundabout, seed: u64, minutes: u32) -> Drive {
    let arms = roundabout.arms as u16;
    let counts = TrafficCounts { cars: 12 * arms, motorcycles: arms, bicycles: 2 * arms, ..TrafficCounts::NONE };
    Drive { network: baked(roundabout), counts, hazards: HazardRates::NONE, seed, minutes }
}

/// What the roads of a roundabout lead to, by the hundreds of their ids: the ring behind an arm, the arm, the ring past it,
/// the way out, and the way in; an arm outwards leads nowhere.
const LEADS_TO: [(char, &[char]); 6] =
    [('1', &['3', '4']), ('2', &['5']), ('2', &[]), ('3', &['1']), ('4', &['2']), ('5', &['1'])];

#[test]
fn roundabouts_hang_together() {
    let mut drivable = Vec::new();
    for (radius_m, arms) in [10.0, 15.0, 18.0, 25.0, 35.0].into_iter().flat_map(|m| (3..=6).map(move |n| (m, n))) {
        for (left_hand, signs) in [(false, true), (false, false), (true, true), (true, false)] {
            let roundabout = Roundabout { radius_m, arms, left_hand, signs, ..Roundabout::default() };
            if roundabout.is_drivable() {
                check_joined(&roundabout, &baked(&roundabout));
                drivable.push((radius_m, arms));
            }
        }
    }
    drivable.dedup();
    let of = |radius_m: f64| drivable.iter().filter(|(m, _)| *m == radius_m).count();
    assert_eq!([10.0, 15.0, 18.0, 25.0, 35.0].map(of), [2, 3, 4, 4, 4], "small ones have no room for many arms");
}

/// Every lane leads where it shall, without a step or a kink.
fn check_joined(roundabout: &Roundabout, network: &RoadNetwork) {
    let road = |lane: &Lane| lane.name.chars().next().expect("a name");
    let mut found = Vec::new();
    for lane in &network.lanes {
        let successors: Vec<&Lane> = lane.successors.iter().map(|next| &network.lanes[*next as usize]).collect();
        for next in &successors {
            let (end, start) = (lane.end(), next.start());
            let gap_m = end.position.distance(start.position);
            let kink_rad = kernel::ops::wrap_angle(start.heading_rad - end.heading_rad).abs();
            let joint = format!("{roundabout}: {} to {}", lane.name, next.name);
            assert!(gap_m < 0.01 && kink_rad < 1e-3, "{joint}: {gap_m} m, {kink_rad} rad");
        }
        let mut leads_to: Vec<char> = successors.into_iter().map(road).collect();
        leads_to.sort_unstable();
        found.push((road(lane), leads_to));
    }
    let arms = roundabout.arms as usize;
    for (from, to) in LEADS_TO {
        let such = found.iter().filter(|(road, leads_to)| *road == from && leads_to == to).count();
        assert_eq!(such, arms, "{roundabout}: {from} to {to:?}");
    }
    let starts = network.lanes.iter().filter(|lane| lane.predecessors.is_empty()).count();
    let yields = network.lanes.iter().filter(|lane| lane.stop.is_some_and(|stop| stop.kind == StopKind::Yield)).count();
    assert_eq!((found.len(), starts, yields), (6 * arms, arms, arms), "{roundabout}");
}

/// At a rush hour traffic goes on in every one of them, however small.
#[test]
fn roundabouts_do_not_fill_up() {
    let variants = [
        (10.0, 3, false, true),
        (10.0, 4, true, false),
        (18.0, 3, true, true),
        (18.0, 4, false, false),
        (18.0, 5, true, true),
        (25.0, 4, true, false),
        (25.0, 5, false, true),
        (35.0, 3, false, false),
        (35.0, 5, true, true),
    ];
    for (seed, (radius_m, arms, signs, left_hand)) in (SEED..).zip(variants) {
        let roundabout = Roundabout { radius_m, arms, signs, left_hand, ..Roundabout::default() };
        let census = is_sound(&roundabout.to_string(), &round(&roundabout, seed, 10));
        assert!(census.vehicle_km / census.vehicle_h > LEAST_KMH, "{roundabout}: {census}");
    }
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
    if wanted.starts_with("roundabout") {
        for variant in roundabouts() {
            let drives_round = (first..first + seeds).map(|seed| round(&variant, seed, minutes));
            drives.push((variant.to_string(), drives_round.collect()));
        }
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
                println!("{name:40} seed {:5}: {census}", drive.seed);
            }
            all.add(&census);
        }
        println!("{name:40}  {:3} runs: {all}", runs.len());
    }
}

/// A ring of 600 m with two narrow lanes in each direction.
fn narrow_ring() -> Arc<RoadNetwork> {
    let lane = |id: i32| {
        format!(
            "<lane id=\"{id}\" type=\"driving\"><link><predecessor id=\"{id}\"/><successor id=\"{id}\"/></link>\
             <width sOffset=\"0\" a=\"3\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
        )
    };
    let joint = |end: &str, at: &str| format!("<{end} elementType=\"road\" elementId=\"0\" contactPoint=\"{at}\"/>");
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"0\" length=\"600\" junction=\"-1\">\
         <link>{}{}</link><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"600\"><arc curvature=\"{}\"/></geometry>\
         </planView><lanes><laneSection s=\"0\"><left>{}</left><center><lane id=\"0\" type=\"none\"/></center>\
         <right>{}</right></laneSection></lanes></road></OpenDRIVE>",
        joint("predecessor", "end"),
        joint("successor", "start"),
        std::f64::consts::TAU / 600.0,
        lane(2) + &lane(1),
        lane(-1) + &lane(-2)
    );
    Arc::new(bake("narrow_ring", &text).expect("it bakes"))
}

/// Who makes room for somebody that changes lanes on the other side may have another beside: on seed 3 a bus did.
#[test]
fn room_is_made_only_where_nobody_is_beside() {
    for seed in SEED..SEED + 6 {
        let counts = TrafficCounts { cars: 44, motorcycles: 1, bicycles: 8, ..TrafficCounts::NONE };
        let drive = Drive { network: narrow_ring(), counts, hazards: HazardRates::NONE, seed, minutes: 10 };
        is_sound("narrow ring", &drive);
    }
}
