//! Where everybody starts.

use glam::{Vec2, Vec3};

use crate::actor::ActorKind;
use crate::geometry::rectangles_overlap;
use crate::map_data::{LaneKind, MapData};
use crate::ops;
use crate::rng::{Stream, bits, unit};

use super::counts::TrafficCounts;
use super::groups::first_of_group;
use super::lapse::Lapse;
use super::manoeuvre::Manoeuvre;
use super::plan::stopping_speed;
use super::state::TrafficState;
use super::traits::{driver, walker_traits};
use super::vehicle::Vehicle;
use super::walker::{Walker, WalkerMode, turns};
use super::ways::Ways;

/// Nobody starts nearer to the ego car than this, metres.
pub(super) const EGO_CLEARANCE_M: f32 = 20.0;
/// Free space around a vehicle at its start, along its lane and across, metres.
const VEHICLE_SPACE_M: Vec2 = Vec2::new(1.5, 0.3);
/// Free space around a person, metres.
const WALKER_SPACE_M: Vec2 = Vec2::splat(0.2);
/// The same around somebody with a pram or in a wheelchair, metres.
const WHEELED_SPACE_M: Vec2 = Vec2::splat(0.08);
/// Places that are drawn for each actor.
const TRIES: u64 = 40;
/// Who finds none of these free looks all over the map, at places so far apart, metres.
const SEARCH_M: f32 = 1.25;
/// Places beside and behind somebody at which those start who walk together, metres along the way and aside.
const BESIDE_M: [[f32; 2]; 8] =
    [[0.0, 0.95], [0.0, -0.95], [0.95, 0.0], [-0.95, 0.0], [0.95, 0.95], [0.95, -0.95], [-0.95, 0.95], [-0.95, -0.95]];
/// Half the extent of a person without wheels, metres.
const WALKER_M: Vec2 = Vec2::splat(0.25);
/// Half the width of a lane that is wide enough to start on, metres.
const LEAST_HALF_M: f32 = 1.2;
/// Speed at the start of who had to look for a place, m/s.
const CROWDED_MPS: f32 = 2.0;
/// Highest speed at the start, m/s.
const START_MPS: f32 = 6.0;
/// Of 100 cars so many are lorries, and so many buses; vans and sport utilities as in the stock of the Kraftfahrt-Bundesamt
/// (2024: a sixth of all cars are SUVs or off-road vehicles); patrol cars and ambulances are an assumption.
const TRUCKS_PCT: u64 = 8;
const BUSES_PCT: u64 = 4;
const VANS_PCT: u64 = 8;
const SUVS_PCT: u64 = 15;
const EMERGENCY_PCT: u64 = 1;
/// Of 100 motorcycles so many are scooters, and of 100 bicycles so many carry a box (assumptions).
const SCOOTERS_PCT: u64 = 30;
const CARGO_PCT: u64 = 6;

/// A stretch on which actors may start: an index, where on that it begins, its length, how much each metre of it counts,
/// and the sum of what all metres up to its end do.
struct Stretch {
    index: u32,
    from_m: f32,
    length_m: f32,
    weight: f32,
    end: f32,
}

/// Stretches of an index, a beginning, a length and a weight.
fn stretches(items: impl Iterator<Item = (u32, f32, f32, f32)>) -> Vec<Stretch> {
    let mut end = 0.0;
    let add = |(index, from_m, length_m, weight): (u32, f32, f32, f32)| {
        end += length_m * weight;
        Stretch { index, from_m, length_m, weight, end }
    };
    items.map(add).collect()
}

/// The stretch and the place on it for a number in [0, 1).
fn pick(stretches: &[Stretch], t: f32) -> (u32, f32) {
    let at = t * stretches.last().map_or(0.0, |s| s.end);
    let i = stretches.partition_point(|s| s.end <= at).min(stretches.len() - 1);
    let stretch = &stretches[i];
    let left_m = (stretch.end - at) / stretch.weight;
    (stretch.index, stretch.from_m + (stretch.length_m - left_m).clamp(0.0, stretch.length_m))
}

/// Tries all places, as far apart as a search looks, from a random one on.
fn search(stretches: &[Stretch], from: f32, mut fits: impl FnMut((u32, f32)) -> bool) -> bool {
    // Nothing counts less than 1.
    let total_m = stretches.last().map_or(0.0, |s| s.end);
    let count = (total_m / SEARCH_M) as u32 + 1;
    (0..count).any(|k| {
        let t = from + k as f32 / count as f32;
        fits(pick(stretches, if t < 1.0 { t } else { t - 1.0 }))
    })
}

/// A place that is taken: a box on the ground with the free space around it.
struct Taken {
    middle: Vec2,
    forward: Vec2,
    half: Vec2,
}

impl Taken {
    fn meets(&self, other: &Self) -> bool {
        let to = other.middle - self.middle;
        let reach_m = self.half.length() + other.half.length();
        let turned = |v: Vec2| Vec2::new(v.dot(self.forward), self.forward.perp_dot(v));
        let near = to.length_squared() < reach_m * reach_m;
        near && rectangles_overlap(self.half, turned(to), turned(other.forward), other.half)
    }
}

/// Everybody who is asked for, as far as the map has room.
pub(super) fn spawn(counts: &TrafficCounts, seed: u64, ways: &Ways, clear_of: &[Vec3]) -> TrafficState {
    let map = &*ways.places.map;
    let state = TrafficState::default();
    let mut spawner = Spawner { counts, seed, map, ways, clear_of, taken: Vec::new(), next_id: 1, state };
    spawner.vehicles();
    spawner.walkers();
    spawner.state
}

struct Spawner<'a> {
    counts: &'a TrafficCounts,
    seed: u64,
    map: &'a MapData,
    ways: &'a Ways,
    /// Nobody enters near these places.
    clear_of: &'a [Vec3],
    taken: Vec<Taken>,
    /// Of whom is looked for room next; what somebody is follows from it.
    next_id: u16,
    state: TrafficState,
}

impl Spawner<'_> {
    fn take(&mut self, place: Taken) -> bool {
        let free = self.taken.iter().all(|other| !other.meets(&place));
        let least_m = EGO_CLEARANCE_M + place.half.length();
        let clear = self.clear_of.iter().all(|other| other.truncate().distance(place.middle) > least_m);
        if free && clear {
            self.taken.push(place);
        }
        free && clear
    }

    fn vehicles(&mut self) {
        let lanes = self.map.lanes.iter().enumerate();
        let usable = lanes.filter(|(_, l)| l.kind == LaneKind::Driving && l.junction.is_none() && l.length_m > 10.0);
        let stretches = stretches(usable.map(|(i, l)| (i as u32, 0.0, l.length_m, 1.0)));
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
        // Kinds for which there is no room any more.
        let mut full: Vec<ActorKind> = Vec::new();
        for (number, kind) in wanted.enumerate() {
            let number = number as u64;
            let kind = self.kind(kind, number);
            let t = |attempt| unit(self.seed, Stream::Spawn, number, attempt);
            let (drawn, from): (Vec<f32>, f32) = ((0..TRIES).map(t).collect(), t(TRIES + 2));
            let found = full.contains(&kind)
                || drawn.into_iter().any(|t| self.vehicle(kind, START_MPS, pick(&stretches, t)))
                || search(&stretches, from, |place| self.vehicle(kind, CROWDED_MPS, place));
            if !found {
                full.push(kind);
            }
        }
    }

    /// What a car, motorcycle or bicycle is exactly.
    fn kind(&self, kind: ActorKind, number: u64) -> ActorKind {
        let rarer: &[(u64, ActorKind)] = match kind {
            ActorKind::Car => &[
                (TRUCKS_PCT, ActorKind::Truck),
                (BUSES_PCT, ActorKind::Bus),
                (VANS_PCT, ActorKind::Van),
                (SUVS_PCT, ActorKind::Suv),
                (EMERGENCY_PCT, ActorKind::Emergency),
            ],
            ActorKind::Motorcycle => &[(SCOOTERS_PCT, ActorKind::Scooter)],
            _ => &[(CARGO_PCT, ActorKind::CargoBike)],
        };
        let mut drawn = bits(self.seed, Stream::Spawn, number, TRIES) % 100;
        for (pct, rarer) in rarer {
            if drawn < *pct {
                return *rarer;
            }
            drawn -= pct;
        }
        kind
    }

    fn vehicle(&mut self, kind: ActorKind, most_mps: f32, (lane, s_m): (u32, f32)) -> bool {
        let id = self.next_id;
        let driver = driver(&self.counts.drivers, self.seed, id, kind);
        let half_m = driver.size_m.x * 0.5;
        let way = &self.map.lanes[lane as usize];
        let end_m = way.stop.map_or(way.length_m, |stop| stop.s_m.min(way.length_m));
        let on_crosswalk = self.ways.lanes[lane as usize]
            .crosswalks
            .iter()
            .any(|c| s_m + half_m > c.near_m - 1.0 && s_m - half_m < c.far_m + 1.0);
        if !self.ways.may_start(kind, lane) || s_m < half_m + 2.0 || s_m > end_m - half_m - 3.0 || on_crosswalk {
            return false;
        }
        let place = way.straight_on(s_m);
        let offset_m = driver.keeps_to_m(place.half_width_m, self.ways.kerb);
        let middle = place.beside(offset_m).truncate();
        let forward = place.forward.truncate().normalize_or(Vec2::X);
        let half = driver.size_m.truncate() * 0.5 + VEHICLE_SPACE_M;
        if place.half_width_m < LEAST_HALF_M || !self.take(Taken { middle, forward, half }) {
            return false;
        }
        let desired = (way.speed_limit_mps * driver.limit_share).min(driver.top_mps).min(most_mps);
        let speed_mps = desired.min(stopping_speed(end_m - s_m - half_m - 2.0, 1.0));
        self.next_id += 1;
        self.state.vehicles.push(Vehicle {
            id,
            kind,
            flags: 0,
            lane,
            before: lane,
            s_m,
            offset_m,
            speed_mps,
            accel_cmps2: 0,
            trips: 0,
            wait_ticks: 0,
            phase: bits(self.seed, Stream::Spawn, u64::from(id), TRIES + 1) as u16,
            stuck_s: 0,
            manoeuvre: Manoeuvre::Keep,
            signal_ticks: 0,
            drift: 0,
            drift_aim: 0,
            lapse: Lapse::None,
            lapse_left: 0,
            late_ticks: 0,
        });
        true
    }

    fn walkers(&mut self) {
        let edges = self.map.walk_edges.iter().zip(&self.ways.edges).enumerate();
        let pieces = edges.filter(|(_, (edge, _))| edge.crosswalk.is_none()).flat_map(|(i, (edge, way))| {
            let (pieces, length_m) = (&way.draw.pieces, edge.length_m / way.draw.pieces.len() as f32);
            pieces.iter().enumerate().map(move |(k, draw)| (i as u32, k as f32 * length_m, length_m, *draw))
        });
        let stretches = stretches(pieces);
        if stretches.is_empty() {
            return;
        }
        let first = 1 << 20;
        for number in first..first + u64::from(self.counts.pedestrians) {
            let t = |attempt| unit(self.seed, Stream::Spawn, number, attempt);
            let (drawn, from): (Vec<f32>, f32) = ((0..TRIES).map(t).collect(), t(TRIES + 2));
            let found = self.joins(number)
                || drawn.into_iter().any(|t| self.walker(number, pick(&stretches, t)))
                || search(&stretches, from, |place| self.walker(number, place));
            // What has wheels needs more room than the others.
            if !found && !walker_traits(self.seed, self.next_id).kind.is_wheeled_on_foot() {
                return;
            }
            self.next_id += u16::from(!found);
        }
    }

    /// Puts somebody beside the one before, if they walk together and there is room.
    fn joins(&mut self, number: u64) -> bool {
        let Some(before) = self.state.walkers.last().copied() else { return false };
        let group = |id| first_of_group(self.seed, id);
        if group(before.id) != group(self.next_id) {
            return false;
        }
        let way = &self.map.walk_edges[before.edge as usize];
        BESIDE_M.into_iter().any(|[along_m, aside_m]| {
            let (s_m, offset_m) = (before.s_m + along_m, before.offset_m + aside_m);
            let fits = (0.0..way.length_m).contains(&s_m) && offset_m.abs() <= way.half_width_m;
            fits && self.walker_at(number, before.edge, s_m, offset_m, before.forward)
        })
    }

    /// Puts somebody on a way, where it likes to walk; beside that where there is no room.
    fn walker(&mut self, number: u64, (edge, s_m): (u32, f32)) -> bool {
        let traits = walker_traits(self.seed, self.next_id);
        let most_m = (self.map.walk_edges[edge as usize].half_width_m - 0.4).max(0.0);
        let forward = bits(self.seed, Stream::Spawn, number, TRIES + 1) & 1 == 0;
        let places = [traits.place, 1.0, -1.0].map(|place| place * most_m);
        places.into_iter().any(|offset_m| self.walker_at(number, edge, s_m, offset_m, forward))
    }

    fn walker_at(&mut self, number: u64, edge: u32, s_m: f32, offset_m: f32, forward: bool) -> bool {
        let id = self.next_id;
        let traits = walker_traits(self.seed, id);
        let place = self.ways.edge_place(edge, s_m);
        let (middle, along) = (place.beside(offset_m).truncate(), place.forward.truncate().normalize_or(Vec2::X));
        let (kind, size_m) = (traits.kind, traits.kind.size_m().truncate());
        let wheeled = (along, size_m * 0.5 + WHEELED_SPACE_M);
        let round = (Vec2::X, WALKER_M + WALKER_SPACE_M);
        let (axis, half) = if kind.is_wheeled_on_foot() { wheeled } else { round };
        if !self.take(Taken { middle, forward: axis, half }) {
            return false;
        }
        let random = bits(self.seed, Stream::Spawn, number, TRIES + 1);
        let ahead = if forward { place.forward } else { -place.forward };
        self.next_id += 1;
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
            bus: 0,
        });
        true
    }
}
