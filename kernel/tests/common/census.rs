//! Drives traffic alone, and counts what must not happen in it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use kernel::RoadNetwork;
use kernel::events::EventKind;
use kernel::scene::ActorKind;
use kernel::signals::{self, LightPhase};
use kernel::time::{Tick, seconds};
use kernel::traffic::{Body, HazardRates, Obstacle, Surroundings, Traffic, TrafficCounts, Vehicle};

/// Nobody may stand for so long but before a red light, or behind somebody who waits there.
const STAND_S: u32 = 180;
/// Ticks between two looks at who overlaps.
const LOOK_TICKS: Tick = 6;
/// Radius of a person without wheels, metres.
const PERSON_M: f32 = 0.2;
/// Circles before and behind the middle one of somebody with wheels.
const CIRCLES: i32 = 3;
/// Touching by less than this is none, metres.
const SKIN_M: f32 = 0.025;
/// Who stands in the way of one is within this, metres.
const AROUND_M: f32 = 45.0;
/// A vehicle stands behind another at a gap of at most this, metres.
const BEHIND_M: f32 = 8.0;

/// A run of traffic without an ego car.
#[derive(Clone)]
pub struct Drive {
    pub network: Arc<RoadNetwork>,
    pub counts: TrafficCounts,
    pub hazards: HazardRates,
    pub seed: u64,
    pub minutes: u32,
}

/// What was counted in a run, or in several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Census {
    /// Hours that all vehicles together were on the road.
    pub vehicle_h: f64,
    /// Distance that all vehicles together drove, km.
    pub vehicle_km: f64,
    /// Hours that all people on foot together were there, and the distance that they went, km.
    pub walker_h: f64,
    pub walker_km: f64,
    /// Vehicles that stood for [`STAND_S`] without a red light.
    pub stood: u32,
    /// Times that two vehicles, a vehicle and a person, and two persons began to overlap.
    pub overlaps: [u32; 3],
    /// Times that a vehicle passed a line at red.
    pub red: u32,
    /// Actors that were asked for and are not there.
    pub missing: u32,
    /// Vehicles that were taken off the road.
    pub dissolved: u32,
    /// Vehicles that were in a collision because of a mistake, which is told.
    pub collided: u32,
    /// Mistakes of drivers that began, and those among them who run a light.
    pub mistakes: u32,
    pub runners: u32,
}

impl Census {
    /// Mean speed of people on foot, those who wait among them, m/s.
    pub fn walker_mps(&self) -> f64 {
        self.walker_km / self.walker_h.max(1e-9) / 3.6
    }

    /// Adds another one.
    pub fn add(&mut self, other: &Self) {
        self.vehicle_h += other.vehicle_h;
        self.vehicle_km += other.vehicle_km;
        self.walker_h += other.walker_h;
        self.walker_km += other.walker_km;
        self.stood += other.stood;
        (0..3).for_each(|k| self.overlaps[k] += other.overlaps[k]);
        self.red += other.red;
        self.missing += other.missing;
        self.dissolved += other.dissolved;
        self.collided += other.collided;
        self.mistakes += other.mistakes;
        self.runners += other.runners;
    }
}

impl fmt::Display for Census {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [cars, person, persons] = self.overlaps;
        let (h, km_h) = (self.vehicle_h, self.vehicle_km / self.vehicle_h.max(1e-9));
        let (stood, red, missing, dissolved) = (self.stood, self.red, self.missing, self.dissolved);
        let (collided, mistakes, walker_mps) = (self.collided, self.mistakes, self.walker_mps());
        write!(
            f,
            "{h:7.1} vehicle-h at {km_h:4.1} km/h, people at {walker_mps:4.2} m/s: {stood:3} stood, overlaps {cars:4} vehicles {person:4} with a person \
             {persons:6} persons, {red:2} at red, {missing:4} missing, {dissolved:3} dissolved, \
             {mistakes:4} mistakes, {collided:2} collided"
        )
    }
}

impl Drive {
    /// Drives it.
    pub fn census(&self) -> Census {
        self.census_around(Vec3::new(1e5, 0.0, 0.0))
    }

    /// Drives it around a car that stands at a place, facing east.
    pub fn census_around(&self, place: Vec3) -> Census {
        let size_m = kernel::ego::SIZE_M;
        let ego =
            Obstacle { id: 0, position: place, heading_rad: 0.0, velocity_mps: Vec3::ZERO, size_m, on_foot: false };
        let mut traffic = Traffic::spawn(&self.counts, self.seed, self.network.ways(), place);
        traffic = traffic.with_hazards(&self.hazards);
        let mut watcher = Watcher::new(self, &traffic);
        for tick in 1..=seconds(60 * self.minutes) {
            traffic.step(&Surroundings::calm(tick, ego));
            watcher.look(&traffic, tick);
        }
        watcher.found
    }
}

struct Watcher<'a> {
    drive: &'a Drive,
    found: Census,
    /// For each vehicle, the seconds it has stood without a red light.
    stands_s: Vec<u32>,
    before: Vec<Vehicle>,
    /// Where people who stood in the world were a second ago.
    walked_from: BTreeMap<u32, Vec3>,
    overlapping: BTreeSet<(u32, u32)>,
}

impl<'a> Watcher<'a> {
    fn new(drive: &'a Drive, traffic: &Traffic) -> Self {
        let counts = &drive.counts;
        let asked = [counts.cars, counts.motorcycles, counts.bicycles, counts.pedestrians];
        let missing = asked.map(u32::from).iter().sum::<u32>() - traffic.bodies().len() as u32;
        let vehicles = &traffic.state().vehicles;
        Self {
            drive,
            found: Census { missing, ..Census::default() },
            stands_s: vec![0; vehicles.len()],
            before: vehicles.clone(),
            walked_from: people(traffic).collect(),
            overlapping: BTreeSet::new(),
        }
    }

    fn look(&mut self, traffic: &Traffic, tick: Tick) {
        let dissolved = traffic.told().iter().filter(|(kind, _)| *kind == EventKind::Dissolved);
        for (_, id) in dissolved {
            self.found.dissolved += 1;
            if std::env::var("AEYE_TRAFFIC_WHO").is_ok() {
                let seed = self.drive.seed;
                eprintln!("seed {seed} tick {tick}: dissolved {id}, of those around it");
                self.around(traffic, *id);
            }
        }
        let collided = |kind: &EventKind| *kind == EventKind::HazardCollision;
        let kinds = || traffic.told().iter().map(|(kind, _)| *kind);
        self.found.collided += kinds().filter(collided).count() as u32;
        self.found.runners += kinds().filter(|kind| *kind == EventKind::HazardRedLight).count() as u32;
        let mistake = |kind: &EventKind| *kind > EventKind::Dissolved && !collided(kind);
        self.found.mistakes += kinds().filter(mistake).count() as u32;
        let vehicles = &traffic.state().vehicles;
        let driven_m: f32 = vehicles.iter().map(|v| v.speed_mps / 60.0).sum();
        self.found.vehicle_km += f64::from(driven_m) / 1000.0;
        self.found.vehicle_h += vehicles.len() as f64 / seconds(3600) as f64;
        self.lights(vehicles, tick);
        if tick.is_multiple_of(LOOK_TICKS) {
            self.overlaps(traffic);
        }
        if tick.is_multiple_of(seconds(1)) {
            self.standing(traffic, tick);
            // Who rode in a bus did not walk.
            let moved = people(traffic).filter_map(|(id, to)| Some(f64::from(self.walked_from.get(&id)?.distance(to))));
            let moved: Vec<f64> = moved.collect();
            self.found.walker_km += moved.iter().sum::<f64>() / 1000.0;
            self.found.walker_h += moved.len() as f64 / 3600.0;
            self.walked_from = people(traffic).collect();
        }
        self.before.clone_from(vehicles);
    }

    /// Prints the vehicles around one as they were a tick ago.
    fn around(&self, traffic: &Traffic, id: u32) {
        let network = &self.drive.network;
        let place = |v: &Vehicle| network.lanes[v.lane as usize].straight_on(v.s_m).beside(v.offset_m);
        let Some(me) = self.before.iter().find(|v| u32::from(v.id) == id) else { return };
        for v in self.before.iter().filter(|v| place(v).distance(place(me)) < AROUND_M) {
            let heading = network.lanes[v.lane as usize].at(v.s_m).heading_rad.to_degrees();
            let at = place(v);
            eprintln!("  at {:.1} {:.1} {heading:.0} deg: {v:?}", at.x, at.y);
        }
        let standing = traffic.state().walkers.iter().filter(|walker| !walker.rides());
        let on_foot = traffic.bodies()[self.before.len()..].iter().zip(standing);
        for (body, walker) in on_foot.filter(|(body, _)| body.position.distance(place(me)) < AROUND_M * 0.2) {
            eprintln!("  at {:.1} {:.1} on foot: {walker:?}", body.position.x, body.position.y);
        }
    }

    /// What the light before a vehicle shows, and the distance to its line; of several for the ways on the one that shows
    /// most.
    fn phase(&self, vehicle: &Vehicle, tick: Tick) -> Option<(LightPhase, f32)> {
        let network = &self.drive.network;
        let lane = &network.lanes[vehicle.lane as usize];
        let ahead_m = lane.stop?.s_m - vehicle.s_m - vehicle.kind.size_m().x * 0.5;
        let lights = lane.successors.iter().map(|next| network.light_between(vehicle.lane, *next));
        let shown = lights.map(|light| Some(signals::phase(network, self.drive.seed, light?, tick).0));
        // Without a light one may go.
        Some((shown.collect::<Option<Vec<_>>>()?.into_iter().max()?, ahead_m))
    }

    fn lights(&mut self, vehicles: &[Vehicle], tick: Tick) {
        for (was, is) in self.before.iter().zip(vehicles).filter(|(was, is)| was.lane == is.lane) {
            let (then, now) = (self.phase(was, tick), self.phase(is, tick));
            if let (Some((LightPhase::Red, then_m)), Some((_, now_m))) = (then, now) {
                let ran = then_m >= 0.0 && now_m < 0.0 && then_m < 5.0;
                self.found.red += u32::from(ran);
                if ran && std::env::var("AEYE_TRAFFIC_WHO").is_ok() {
                    eprintln!("tick {tick}: at red {was:?}");
                }
            }
        }
    }

    fn standing(&mut self, traffic: &Traffic, tick: Tick) {
        let vehicles = &traffic.state().vehicles;
        for (i, vehicle) in vehicles.iter().enumerate() {
            let stands = vehicle.speed_mps < 0.1 && self.before[i].lane == vehicle.lane;
            if !stands {
                self.stands_s[i] = 0;
            } else if !self.waits_at_red(traffic, i, tick) {
                self.stands_s[i] += 1;
                if self.stands_s[i] == STAND_S {
                    self.found.stood += 1;
                    if std::env::var("AEYE_TRAFFIC_WHO").is_ok() {
                        eprintln!("tick {tick}: stands {vehicle:?} at {}", traffic.bodies()[i].position);
                    }
                }
            }
        }
    }

    /// Whether a vehicle stands before a red or yellow light, or behind one that does.
    fn waits_at_red(&self, traffic: &Traffic, index: usize, tick: Tick) -> bool {
        let vehicles = &traffic.state().vehicles;
        let bodies = &traffic.bodies()[..vehicles.len()];
        let mut seen = BTreeSet::new();
        let mut at = index;
        while seen.insert(at) {
            let red =
                self.phase(&vehicles[at], tick).is_some_and(|(p, m)| p != LightPhase::Green && m > -3.0 && m < 15.0);
            if red {
                return true;
            }
            match self.queues_behind(vehicles, at).or_else(|| leader(bodies, at)) {
                Some(next) if vehicles[next].speed_mps < 0.1 => at = next,
                _ => return false,
            }
        }
        false
    }

    /// The vehicle that stands closely before another along its lane, also in bends.
    fn queues_behind(&self, vehicles: &[Vehicle], index: usize) -> Option<usize> {
        let me = &vehicles[index];
        let length_m = self.drive.network.lanes[me.lane as usize].length_m;
        let gap_m = |other: &Vehicle| {
            let between_m = match (other.lane == me.lane, other.before == me.lane) {
                (true, _) => other.s_m - me.s_m,
                (_, true) => length_m - me.s_m + other.s_m,
                _ => return None,
            };
            let gap_m = between_m - (me.kind.size_m().x + other.kind.size_m().x) * 0.5;
            (between_m > 0.0 && gap_m < BEHIND_M).then_some(gap_m)
        };
        nearest(vehicles, index, gap_m)
    }

    fn overlaps(&mut self, traffic: &Traffic) {
        let bodies = traffic.bodies();
        let mut order: Vec<&Body> = bodies.iter().collect();
        order.sort_by(|a, b| a.position.x.total_cmp(&b.position.x));
        let mut now = BTreeSet::new();
        for (k, a) in order.iter().enumerate() {
            for b in order[k + 1..].iter().take_while(|b| b.position.x - a.position.x < 14.0) {
                let near = (b.position.y - a.position.y).abs() < 14.0 && (b.position.z - a.position.z).abs() < 2.0;
                if near && overlap(a, b) {
                    now.insert((a.id.min(b.id), a.id.max(b.id)));
                }
            }
        }
        let walks = |id: u32| bodies.iter().any(|b| b.id == id && b.kind.is_on_foot());
        for (a, b) in now.difference(&self.overlapping) {
            self.found.overlaps[usize::from(walks(*a)) + usize::from(walks(*b))] += 1;
            if std::env::var("AEYE_TRAFFIC_WHO").is_ok_and(|who| !walks(*a) || who == "all") {
                let who = |id| bodies.iter().find(|body| body.id == id).expect("it is there");
                let told = |b: &Body| (b.id, b.kind, b.position, b.velocity_mps);
                let lane = |id| self.before.iter().find(|v| u32::from(v.id) == id);
                let walker = traffic.state().walkers.iter().find(|w| u32::from(w.id) == *b);
                let seed = self.drive.seed;
                eprintln!("overlap, seed {seed} {:?} {:?} {walker:?}", told(who(*a)), told(who(*b)));
                eprintln!("  {:?}\n  {:?}", lane(*a), lane(*b));
            }
        }
        self.overlapping = now;
    }
}

/// Where the people on foot are, by their ids.
fn people(traffic: &Traffic) -> impl Iterator<Item = (u32, Vec3)> {
    traffic.bodies()[traffic.state().vehicles.len()..].iter().map(|body| (body.id, body.position))
}

/// The vehicle that stands closely before another as the eye sees it, whatever lanes they are on.
fn leader(bodies: &[Body], index: usize) -> Option<usize> {
    let me = &bodies[index];
    let forward = (me.rotation * Vec3::X).truncate();
    let gap_m = |other: &Body| {
        let to = (other.position - me.position).truncate();
        let (ahead_m, aside_m) = (to.dot(forward), forward.perp_dot(to).abs());
        let gap_m = ahead_m - (me.kind.size_m().x + other.kind.size_m().x) * 0.5;
        (ahead_m > 0.0 && aside_m < 2.0 && gap_m < BEHIND_M).then_some(gap_m)
    };
    nearest(bodies, index, gap_m)
}

/// The other one of a list to which the gap is smallest, of those to whom there is one.
fn nearest<T>(all: &[T], index: usize, gap_m: impl Fn(&T) -> Option<f32>) -> Option<usize> {
    let others = all.iter().enumerate().filter(|(i, _)| *i != index);
    let near = others.filter_map(|(i, other)| Some((i, gap_m(other)?)));
    near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
}

/// Whether two road users overlap: vehicles as boxes, people as circles, with a pram or in a wheelchair as the longest row of
/// circles inside of their box.
fn overlap(a: &Body, b: &Body) -> bool {
    let way = (b.position - a.position).truncate();
    match (a.kind.is_on_foot(), b.kind.is_on_foot()) {
        (true, true) => circles(a).any(|(at, r_m)| circles(b).any(|(to, s_m)| (way + to - at).length() < r_m + s_m)),
        (true, false) => circles(a).any(|(at, r_m)| box_meets_circle(b, at - way, r_m)),
        (false, true) => circles(b).any(|(at, r_m)| box_meets_circle(a, way + at, r_m)),
        (false, false) => boxes_meet(a, b, way),
    }
}

/// The circles that somebody on foot fills: from its middle, and radius, metres.
fn circles(body: &Body) -> impl Iterator<Item = (Vec2, f32)> {
    let size_m = body.kind.size_m();
    let is_round = matches!(body.kind, ActorKind::Pedestrian | ActorKind::Child);
    let radius_m = if is_round { PERSON_M } else { size_m.y * 0.5 - SKIN_M };
    let half_m = if is_round { 0.0 } else { (size_m.x - size_m.y) * 0.5 };
    let [forward, _] = axes(body);
    (-CIRCLES..=CIRCLES).map(move |k| (forward * (half_m * k as f32 / CIRCLES as f32), radius_m))
}

fn axes(body: &Body) -> [Vec2; 2] {
    let forward = (body.rotation * Vec3::X).truncate().normalize_or(Vec2::X);
    [forward, forward.perp()]
}

fn half(body: &Body) -> Vec2 {
    body.kind.size_m().truncate() * 0.5 - SKIN_M
}

fn box_meets_circle(body: &Body, way: Vec2, radius_m: f32) -> bool {
    let [forward, left] = axes(body);
    let local = Vec2::new(way.dot(forward), way.dot(left));
    (local - local.clamp(-half(body), half(body))).length() < radius_m
}

fn boxes_meet(a: &Body, b: &Body, way: Vec2) -> bool {
    let extent = |body: &Body, axis: Vec2| {
        let [forward, left] = axes(body);
        half(body).x * forward.dot(axis).abs() + half(body).y * left.dot(axis).abs()
    };
    axes(a).into_iter().chain(axes(b)).all(|axis| way.dot(axis).abs() < extent(a, axis) + extent(b, axis))
}
