//! Where everybody starts.

use glam::{Vec2, Vec3};

use crate::actor::ActorKind;
use crate::map_data::{LaneKind, MapData};
use crate::ops;
use crate::rng::{Stream, bits, unit};

use super::counts::TrafficCounts;
use super::plan::stopping_speed;
use super::state::TrafficState;
use super::traits::{driver, walker_traits};
use super::vehicle::Vehicle;
use super::walker::{Walker, WalkerMode, turns};
use super::ways::Ways;

/// Nobody starts nearer to the ego car than this, metres.
pub(super) const EGO_CLEARANCE_M: f32 = 20.0;
/// Free space around a vehicle at its start, metres.
const VEHICLE_SPACE_M: f32 = 6.0;
/// Free space around a walker, metres.
const WALKER_SPACE_M: f32 = 0.9;
/// Places that are tried for each actor.
const TRIES: u64 = 40;
/// Highest speed at the start, m/s.
const START_MPS: f32 = 6.0;
/// Of 100 cars so many are lorries, and so many buses.
const TRUCKS_PCT: u32 = 8;
const BUSES_PCT: u32 = 4;

/// A stretch on which actors may start: an index, its length, and the sum of lengths up to its end.
struct Stretch {
    index: u32,
    length_m: f32,
    end_m: f32,
}

fn stretches(items: impl Iterator<Item = (u32, f32)>) -> Vec<Stretch> {
    let mut end_m = 0.0;
    let add = |(index, length_m): (u32, f32)| {
        end_m += length_m;
        Stretch { index, length_m, end_m }
    };
    items.map(add).collect()
}

/// The stretch and the place on it for a number in [0, 1).
fn pick(stretches: &[Stretch], t: f32) -> (u32, f32) {
    let at_m = t * stretches.last().map_or(0.0, |s| s.end_m);
    let i = stretches.partition_point(|s| s.end_m <= at_m).min(stretches.len() - 1);
    let stretch = &stretches[i];
    (stretch.index, (at_m - (stretch.end_m - stretch.length_m)).clamp(0.0, stretch.length_m))
}

/// Everybody who is asked for, as far as the map has room.
pub(super) fn spawn(counts: &TrafficCounts, seed: u64, ways: &Ways, ego: Vec3) -> TrafficState {
    let (map, ego) = (&*ways.places.map, ego.truncate());
    let mut spawner = Spawner { counts, seed, map, ways, ego, taken: Vec::new(), state: TrafficState::default() };
    spawner.vehicles();
    spawner.walkers();
    spawner.state
}

struct Spawner<'a> {
    counts: &'a TrafficCounts,
    seed: u64,
    map: &'a MapData,
    ways: &'a Ways,
    ego: Vec2,
    /// Places taken, with the free radius around each.
    taken: Vec<(Vec2, f32)>,
    state: TrafficState,
}

impl Spawner<'_> {
    fn next_id(&self) -> u16 {
        (self.state.vehicles.len() + self.state.walkers.len() + 1) as u16
    }

    fn take(&mut self, at: Vec2, radius_m: f32) -> bool {
        let free = self.taken.iter().all(|(other, r)| other.distance(at) > radius_m + r);
        let clear = self.ego.distance(at) > EGO_CLEARANCE_M + radius_m;
        if free && clear {
            self.taken.push((at, radius_m));
        }
        free && clear
    }

    fn vehicles(&mut self) {
        let lanes = self.map.lanes.iter().enumerate();
        let usable = lanes.filter(|(_, l)| l.kind == LaneKind::Driving && l.junction.is_none() && l.length_m > 20.0);
        let stretches = stretches(usable.map(|(i, l)| (i as u32, l.length_m)));
        if stretches.is_empty() {
            return;
        }
        let counts = self.counts;
        let kinds = [
            (counts.cars, ActorKind::Car),
            (counts.motorcycles, ActorKind::Motorcycle),
            (counts.bicycles, ActorKind::Bicycle),
        ];
        let wanted = kinds.into_iter().flat_map(|(count, kind)| (0..count).map(move |_| kind));
        for (number, kind) in wanted.enumerate() {
            let kind = if kind == ActorKind::Car { self.car(number as u64) } else { kind };
            for attempt in 0..TRIES {
                let t = unit(self.seed, Stream::Spawn, number as u64, attempt);
                if self.vehicle(kind, pick(&stretches, t)) {
                    break;
                }
            }
        }
    }

    fn car(&self, number: u64) -> ActorKind {
        match bits(self.seed, Stream::Spawn, number, TRIES) % 100 {
            n if n < u64::from(TRUCKS_PCT) => ActorKind::Truck,
            n if n < u64::from(TRUCKS_PCT + BUSES_PCT) => ActorKind::Bus,
            _ => ActorKind::Car,
        }
    }

    fn vehicle(&mut self, kind: ActorKind, (lane, s_m): (u32, f32)) -> bool {
        let id = self.next_id();
        let driver = driver(self.seed, id, kind);
        let half_m = driver.size_m.x * 0.5;
        let way = &self.map.lanes[lane as usize];
        let end_m = way.stop.map_or(way.length_m, |stop| stop.s_m.min(way.length_m));
        let on_crosswalk = self.ways.lanes[lane as usize]
            .crosswalks
            .iter()
            .any(|c| s_m + half_m > c.near_m - 1.0 && s_m - half_m < c.far_m + 1.0);
        if s_m < half_m + 2.0 || s_m > end_m - half_m - 3.0 || on_crosswalk {
            return false;
        }
        let place = way.straight_on(s_m);
        let offset_m = driver.from_right_m.map_or(0.0, |m| (m - place.half_width_m).min(0.0));
        if !self.take(place.position.truncate(), half_m + VEHICLE_SPACE_M * 0.5) {
            return false;
        }
        let desired = (way.speed_limit_mps * driver.limit_share).min(driver.top_mps).min(START_MPS);
        let speed_mps = desired.min(stopping_speed(end_m - s_m - half_m - 2.0, 1.0));
        self.state.vehicles.push(Vehicle {
            id,
            kind,
            flags: 0,
            lane,
            s_m,
            offset_m,
            speed_mps,
            hops: 0,
            wait_ticks: 0,
            phase: bits(self.seed, Stream::Spawn, u64::from(id), TRIES + 1) as u16,
        });
        true
    }

    fn walkers(&mut self) {
        let edges = self.map.walk_edges.iter().enumerate();
        let stretches = stretches(edges.filter(|(_, e)| e.crosswalk.is_none()).map(|(i, e)| (i as u32, e.length_m)));
        if stretches.is_empty() {
            return;
        }
        let first = 1 << 20;
        for number in first..first + u64::from(self.counts.pedestrians) {
            for attempt in 0..TRIES {
                let t = unit(self.seed, Stream::Spawn, number, attempt);
                if self.walker(number, pick(&stretches, t)) {
                    break;
                }
            }
        }
    }

    fn walker(&mut self, number: u64, (edge, s_m): (u32, f32)) -> bool {
        let id = self.next_id();
        let traits = walker_traits(self.seed, id);
        let way = &self.map.walk_edges[edge as usize];
        let place = self.ways.edge_place(edge, s_m);
        let offset_m = traits.place * (way.half_width_m - 0.4).max(0.0);
        if !self.take(place.beside(offset_m).truncate(), WALKER_SPACE_M * 0.5) {
            return false;
        }
        let random = bits(self.seed, Stream::Spawn, number, TRIES + 1);
        let forward = random & 1 == 0;
        let ahead = if forward { place.forward } else { -place.forward };
        self.state.walkers.push(Walker {
            id,
            mode: WalkerMode::Walk,
            forward,
            edge,
            s_m,
            offset_m,
            speed_mps: traits.speed_mps,
            hops: 0,
            wait_ticks: 0,
            phase: (random >> 16) as u16,
            heading: turns(ops::atan2(ahead.y, ahead.x)),
        });
        true
    }
}
