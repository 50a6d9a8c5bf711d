//! Rain, fog and water on the road change how everybody drives and walks, and nothing else.

mod common;

use std::sync::Arc;

use common::{on_ring, ring, script};
use glam::Vec3;
use kernel::map::bundled;
use kernel::scene::{FIRST_PARKED_ID, lamps};
use kernel::time::{KEYFRAME_TICKS, Tick, seconds};
use kernel::traffic::{Obstacle, Population, Surroundings, Traffic, TrafficCounts};
use kernel::weather::{Conditions, Weather, WeatherChange, WeatherPreset};
use kernel::{RoadNetwork, Scenario, World};

const FAR: Vec3 = Vec3::new(1e5, 0.0, 0.0);
const DRY: Weather = Weather::dry(0.0, 0.0, 45.0, 0.0);

fn preset(name: &str) -> Weather {
    WeatherPreset::find(name).expect(name).weather(0.0)
}

fn drive(network: &Arc<RoadNetwork>, counts: &TrafficCounts, weather: &Weather, ticks: Tick) -> Traffic {
    let mut traffic = Traffic::spawn(counts, 4, network.ways(), FAR);
    let size_m = kernel::ego::SIZE_M;
    let ego = Obstacle { id: 0, position: FAR, heading_rad: 0.0, velocity_mps: Vec3::ZERO, size_m, on_foot: false };
    let conditions = Conditions::of(weather);
    for tick in 1..=ticks {
        traffic.step(&Surroundings { conditions, ..Surroundings::calm(tick, ego) });
        assert!(traffic.told().is_empty(), "tick {tick}: {:?}", traffic.told());
    }
    traffic
}

/// A straight one-way road without anything on it but what is asked for.
fn road() -> Arc<RoadNetwork> {
    road_of("asphalt")
}

/// The same, made of something.
fn road_of(material: &str) -> Arc<RoadNetwork> {
    let text = "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\
        <road id=\"0\" length=\"6000\" junction=\"-1\"><planView>\
        <geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"6000\"><line/></geometry></planView>\
        <type s=\"0\" type=\"rural\"><speed max=\"100\" unit=\"km/h\"/></type>\
        <lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right>\
        <lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>\
        <material sOffset=\"0\" surface=\"MATERIAL\"/></lane></right></laneSection></lanes></road></OpenDRIVE>";
    Arc::new(kernel::map::bake("road", &text.replace("MATERIAL", material)).expect("it bakes"))
}

/// The speed of the only car after a minute, m/s.
fn free_mps(weather: &Weather) -> f32 {
    let counts = TrafficCounts {
        cars: 1,
        motorcycles: 0,
        bicycles: 0,
        pedestrians: 0,
        jaywalks_per_min: 0.0,
        drivers: Population::USUAL,
    };
    drive(&road(), &counts, weather, seconds(40)).state().vehicles[0].speed_mps
}

#[test]
fn rain_slows_a_free_car_as_was_measured_and_fog_until_it_can_stop_within_sight() {
    let dry = free_mps(&DRY);
    let wet = free_mps(&preset("WetNoon")) / dry;
    let rain = free_mps(&preset("HardRainNoon")) / dry;
    let fog = free_mps(&Weather { fog_density_pct: 100.0, ..DRY });
    println!("{dry} m/s, wet {wet}, heavy rain {rain}, fog {fog} m/s");
    assert!((0.87..0.98).contains(&wet) && (0.84..0.97).contains(&rain) && rain < wet, "{wet} {rain}");
    // Dense fog: 50 m for 2.5 s of reaction and braking at 3.4 m/s².
    let stops_m = 2.5 * fog + fog * fog / (2.0 * 3.4);
    assert!(stops_m < 51.0 && stops_m > 45.0, "{fog} m/s stop within {stops_m} m");
}

#[test]
fn people_hurry_in_rain() {
    let network = bundled("rural").expect("it is bundled");
    let counts = TrafficCounts {
        cars: 0,
        motorcycles: 0,
        bicycles: 0,
        pedestrians: 60,
        jaywalks_per_min: 0.0,
        drivers: Population::USUAL,
    };
    let pace = |weather: &Weather| {
        let traffic = drive(&network, &counts, weather, seconds(30));
        let mut speeds: Vec<f32> = traffic.state().walkers.iter().map(|walker| walker.speed_mps).collect();
        speeds.sort_unstable_by(f32::total_cmp);
        speeds[speeds.len() / 2]
    };
    let faster = pace(&preset("HardRainNoon")) / pace(&DRY);
    println!("{faster}");
    assert!((1.05..1.15).contains(&faster), "{faster}");
}

#[test]
fn traffic_flows_in_a_downpour() {
    let network = bundled("city").expect("it is bundled");
    let counts = Scenario::default_for("city", 1).traffic;
    let driven_km = |weather: &Weather| {
        let mut traffic = Traffic::spawn(&counts, 9, network.ways(), FAR);
        let size_m = kernel::ego::SIZE_M;
        let ego = Obstacle { id: 0, position: FAR, heading_rad: 0.0, velocity_mps: Vec3::ZERO, size_m, on_foot: false };
        let conditions = Conditions::of(weather);
        let mut driven_m = 0.0;
        for tick in 1..=seconds(300) {
            traffic.step(&Surroundings { conditions, ..Surroundings::calm(tick, ego) });
            let vehicles = traffic.bodies().iter().filter(|body| !body.kind.is_on_foot());
            driven_m += vehicles.map(|body| f64::from(body.velocity_mps.length())).sum::<f64>() / 60.0;
        }
        driven_m / 1000.0
    };
    let (dry, rain) = (driven_km(&DRY), driven_km(&preset("HardRainNoon")));
    println!("{dry} km, in heavy rain {rain} km");
    assert!(rain > 0.7 * dry && rain < dry, "{dry} km, in heavy rain {rain} km");
}

/// A world on the ring in weather that turns to heavy rain.
fn turning() -> Scenario {
    let to = preset("HardRainSunset");
    Scenario { weather: DRY, later: Some(WeatherChange { to, over_s: 40.0 }), ..on_ring(3) }
}

#[test]
fn what_is_to_be_seen_changes_slowly() {
    let scenario = turning();
    let mut world = World::new(&scenario, &ring()).expect("it fits");
    let mut before = world.scene().weather;
    assert_eq!(before, scenario.weather);
    for _ in 0..seconds(60) {
        world.step(&script::input(&world));
        let now = world.scene().weather;
        assert_eq!(now, scenario.weather_at(world.tick()));
        let step = now.precipitation_pct - before.precipitation_pct;
        assert!((0.0..0.05).contains(&step), "{step}");
        before = now;
    }
    assert_eq!(before, scenario.later.expect("it changes").to);
}

#[test]
fn a_world_resumed_while_the_weather_changes_stays_identical() {
    let (scenario, network) = (turning(), ring());
    let mut original = World::new(&scenario, &network).expect("it fits");
    let mut resumed: Option<World> = None;
    let mut keyframes = 0;
    for _ in 0..6 * KEYFRAME_TICKS {
        let input = script::input(&original);
        let output = original.step(&input);
        if let Some(other) = &mut resumed {
            let same = other.step(&input);
            assert_eq!(same.hash, output.hash, "tick {}: {:?}", output.tick, original.difference(other));
        }
        if let Some(keyframe) = output.keyframe {
            keyframes += 1;
            resumed = Some(World::resume(&scenario, &network, &keyframe).expect("it resumes"));
        }
    }
    assert!(keyframes >= 6, "{keyframes}");
    let dry = Scenario { later: None, ..scenario };
    assert_eq!(World::new(&dry, &network).expect("it fits").friction(), 1.0);
    assert!(original.friction() < 0.76, "{}", original.friction());
}

#[test]
fn the_road_under_the_ego_car_says_how_it_holds() {
    for (material, dry, wet) in [("asphalt", 1.0, 0.75), ("gravel", 0.6, 0.55), ("cobblestone", 0.7, 0.45)] {
        for (weather, expected) in [(DRY, dry), (Weather { wetness_pct: 100.0, ..DRY }, wet)] {
            let scenario = Scenario { weather, ..Scenario::default_for("road", 1) };
            let world = World::new(&scenario, &road_of(material)).expect("it fits");
            assert!((world.friction() - expected).abs() < 1e-3, "{material}: {}", world.friction());
        }
    }
}

#[test]
fn headlights_come_on_in_the_dark_and_go_off_by_day() {
    let network = bundled("city").expect("a bundled map");
    for (weather, is_lit) in [(DRY, false), (preset("ClearNight"), true), (preset("HardRainNoon"), true)] {
        let scenario = Scenario { weather, ..Scenario::default_for("city", 3) };
        let scene = World::new(&scenario, &network).expect("it fits").scene();
        assert_eq!(scene.ego.lamps & lamps::HEADLIGHTS != 0, is_lit);
        let mut vehicles = scene.actors.iter().filter(|actor| actor.kind.is_vehicle() && actor.id < FIRST_PARKED_ID);
        assert!(vehicles.all(|actor| (actor.lamps & lamps::HEADLIGHTS != 0) == is_lit));
    }
}
