//! How fast the ego car drives where others drive: `traffic_speed FILE|FOLDER...` replays drives and compares the speed of
//! their ego cars with that of the cars around on the same stretches of road, stops included.
//!
//! A stretch is what lies in a square of [`STRETCH_M`] in one of eight directions. Cars count within [`NEAR_M`] of the ego
//! car. The time that they take for a kilometre of a stretch, summed over the ego car's kilometres, is what the ego car
//! would have needed as one of them.

use std::collections::BTreeMap;
use std::f32::consts::TAU;
use std::path::{Path, PathBuf};

use anyhow::bail;
use base::library::{self, Kind};
use base::say::say;
use glam::{Vec2, Vec3};
use kernel::arbiter::Phase;
use kernel::scene::{ActorKind, FIRST_PARKED_ID};
use kernel::time::{TICK_HZ, Tick};
use rayon::prelude::*;
use replay::{Recording, Replayer};

/// Side of the square that a stretch lies in, metres.
const STRETCH_M: f32 = 50.0;
/// Others farther away are not looked at, metres.
const NEAR_M: f32 = 300.0;
/// Stretches on which others drove less than this in all tell nothing, kilometres.
const LEAST_KM: f64 = 0.05;
/// Ticks from one look to the next.
const LOOK_TICKS: Tick = 6;

/// A square, and a direction in it.
type Stretch = (i32, i32, u8);

/// Kilometres and seconds.
#[derive(Clone, Copy, Default)]
struct Driven {
    km: f64,
    s: f64,
}

impl Driven {
    fn add(&mut self, other: Self) {
        *self = Self { km: self.km + other.km, s: self.s + other.s };
    }

    fn kmh(self) -> f64 {
        3600.0 * self.km / self.s
    }
}

/// What the ego car and the others drove on each stretch of a map.
type Roads = BTreeMap<Stretch, [Driven; 2]>;

fn main() -> anyhow::Result<()> {
    let paths: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    let files = library::find(&paths, Kind::Drives).files;
    if files.is_empty() {
        bail!("expected recordings or folders with recordings");
    }
    let watched: Vec<(String, Roads)> =
        files.par_iter().map(|file| watch(&file.path)).collect::<anyhow::Result<_>>()?;
    let mut maps: BTreeMap<String, Roads> = BTreeMap::new();
    for (map, roads) in watched {
        let all = maps.entry(map).or_default();
        for (stretch, [ego, others]) in roads {
            let known = all.entry(stretch).or_default();
            known[0].add(ego);
            known[1].add(others);
        }
    }
    let mut sums = [Driven::default(); 2];
    for (map, roads) in &maps {
        let compared = compare(roads);
        sums.iter_mut().zip(compared).for_each(|(sum, driven)| sum.add(driven));
        line(map, compared);
    }
    line("all", sums);
    Ok(())
}

fn line(map: &str, [ego, others]: [Driven; 2]) {
    let (ego_kmh, others_kmh) = (ego.kmh(), others.kmh());
    if ego.km == 0.0 {
        return say(format_args!("{map:12} no stretch that others drove on as well"));
    }
    let percent = 100.0 * ego_kmh / others_kmh;
    say(format_args!(
        "{map:12} {:7.1} km  ego {ego_kmh:5.1} km/h  cars {others_kmh:5.1} km/h  {percent:4.0} %",
        ego.km
    ));
}

fn watch(path: &Path) -> anyhow::Result<(String, Roads)> {
    let recording = Recording::open(path)?;
    let network = recording.network()?;
    let log = recording.into_log();
    let mut replayer = Replayer::new(&log, network.clone())?;
    let mut roads = Roads::new();
    loop {
        let scene = replayer.world().scene();
        let is_driven = matches!(replayer.world().arbiter().phase, Phase::Arming | Phase::Driving);
        if is_driven && scene.tick.is_multiple_of(LOOK_TICKS) {
            let ego = stretch_of(scene.ego.position, scene.ego.rotation * Vec3::X);
            roads.entry(ego).or_default()[0].add(in_a_look(replayer.world().hud().speed_mps));
            let is_near = |at: Vec3| at.distance(scene.ego.position) < NEAR_M;
            let is_car = |id, kind| kind == ActorKind::Car && id < FIRST_PARKED_ID;
            for car in scene.actors.iter().filter(|car| is_car(car.id, car.kind) && is_near(car.position)) {
                let stretch = stretch_of(car.position, car.rotation * Vec3::X);
                roads.entry(stretch).or_default()[1].add(in_a_look(car.speed_mps));
            }
        }
        if replayer.step()?.is_none() {
            return Ok((network.name.clone(), roads));
        }
    }
}

fn in_a_look(speed_mps: f32) -> Driven {
    let s = LOOK_TICKS as f64 / f64::from(TICK_HZ);
    Driven { km: f64::from(speed_mps) * s / 1000.0, s }
}

fn stretch_of(at: Vec3, forward: Vec3) -> Stretch {
    let square = (at.truncate() / STRETCH_M).floor();
    let turns = Vec2::X.angle_to(forward.truncate()).rem_euclid(TAU) / TAU;
    (square.x as i32, square.y as i32, (8.0 * turns).round() as u8 % 8)
}

/// What the ego car drove where others were, and the same kilometres in the time of the others.
fn compare(roads: &Roads) -> [Driven; 2] {
    let mut compared = [Driven::default(); 2];
    for [ego, others] in roads.values().filter(|[_, others]| others.km >= LEAST_KM) {
        compared[0].add(*ego);
        compared[1].add(Driven { km: ego.km, s: others.s * ego.km / others.km });
    }
    compared
}
