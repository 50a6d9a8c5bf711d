//! Stepping onto the road where there is no crosswalk.

use glam::{Vec2, Vec3};

use crate::geometry::direction;
use crate::map_data::{MapData, Prop, PropKind};
use crate::rng::{Stream, bits, unit};
use crate::time::TICK_HZ;

use super::actors::Actors;
use super::body::{Body, Obstacle, Surroundings};
use super::cover;
use super::hazard::Hazard;
use super::horn::{Horn, PEOPLE_ASIDE_M};
use super::manoeuvre::Manoeuvre;
use super::surprise;
use super::traits::WalkerTraits;
use super::vehicle::Vehicle;
use super::walker::{Walker, WalkerMode};
use super::ways::Ways;

/// Share of all jaywalking that happens just before the ego car, when somebody walks there.
const BEFORE_EGO: f32 = 0.5;
/// Share of it that happens, where there is somebody to do it, from behind a parked car or a bus at its stop (assumption).
const FROM_COVER: f32 = 0.3;
/// What draws that, as a key of random numbers.
const COVER_KEY: u64 = u64::MAX - 1;
/// Share of jaywalkers who run.
const RUNNERS: f32 = 0.25;
/// Speed of those, m/s.
const RUN_MPS: f32 = 2.8;
/// Candidates whose way is looked at in one tick.
const TRIES: usize = 8;
/// Half the width that somebody needs to get past what stands there, metres.
const WALKER_M: f32 = 0.35;
/// Braking that jaywalkers expect of vehicles, m/s², and after which time, s.
const BRAKE_MPS2: f32 = 3.5;
const REACTION_S: f32 = 0.7;
/// Distance that they keep from them, metres.
const NEAR_M: f32 = 2.0;
/// Whoever drives on may be so far aside, metres; twice that who changes lanes.
const LANE_M: f32 = 3.0;
/// Places on their way that are looked at.
const STRIDES: u32 = 8;
/// Roads narrower or wider than this between the middles of the sidewalks are not crossed, metres.
const ROAD_M: std::ops::Range<f32> = 4.0..32.0;

/// Where somebody who jaywalks arrives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Goal {
    /// From the middle of the way left behind, metres across.
    pub distance_m: f32,
    edge: u32,
    s_m: f32,
}

/// The walker who steps onto the road in this tick, if anybody does.
pub(super) fn starter(actors: &Actors, around: &Surroundings<'_>) -> Option<usize> {
    let (map, ways, walkers) = (actors.map(), &*actors.ways, &actors.state.walkers);
    let (seed, tick, ego) = (actors.seed, around.tick, &around.ego);
    if unit(seed, Stream::Jaywalk, 0, tick) >= actors.counts.jaywalks_per_min / (60 * TICK_HZ) as f32 {
        return None;
    }
    let seek_ego = unit(seed, Stream::Jaywalk, u64::MAX, tick) < BEFORE_EGO;
    let seek_cover = unit(seed, Stream::Jaywalk, COVER_KEY, tick) < FROM_COVER;
    let rank = |i: &usize| {
        let walker = &walkers[*i];
        let place = ways.walker_place(walker).beside(walker.offset_m);
        let far = !(seek_ego && is_before(ego, place));
        let is_hidden = |way: [Vec2; 2]| is_free(map, way[0], way[1]) && cover::hides(actors, walker, way);
        let open = seek_cover && !way_across(map, ways, walker).is_some_and(is_hidden);
        // Who goes alone leaves nobody behind.
        (far, open, !actors.groups.is_alone(*i), bits(seed, Stream::Jaywalk, u64::from(walker.id), tick))
    };
    let horn = Horn::of(around);
    let hears = |w: &Walker| horn.is_some_and(|h| h.is_for(ways.walker_place(w).position.truncate(), PEOPLE_ASIDE_M));
    let may = |i: &usize| {
        let walker = &walkers[*i];
        beside_road(map, walker) && !around.holds(walker.id) && !hears(walker)
    };
    let mut candidates: Vec<usize> = (0..walkers.len()).filter(may).collect();
    candidates.sort_by_cached_key(rank);
    let ego = Hazard::of(ego);
    candidates.into_iter().take(TRIES).find(|i| {
        let way = way_across(map, ways, &walkers[*i]);
        let pace_mps = pace(seed, &walkers[*i], &actors.walker_traits[*i]);
        way.is_some_and(|[from, to]| {
            is_free(map, from, to)
                && can_stop(&actors.state.vehicles, &actors.bodies, from, to)
                && surprise::leaves_time(&ego, [from, to], pace_mps)
        })
    })
}

/// Whether every vehicle in traffic can still stop before a way across the road. Of the ego car a
/// jaywalker thinks less ([`surprise`]).
pub(super) fn can_stop(vehicles: &[Vehicle], bodies: &[Body], from: Vec2, to: Vec2) -> bool {
    let passes = |body: &Body| {
        let (middle, axis) = (body.position.truncate(), (body.rotation * Vec3::X).truncate().normalize_or(Vec2::X));
        let local = |p: Vec2| Vec2::new((p - middle).dot(axis), axis.perp_dot(p - middle));
        let half = body.kind.size_m().truncate() * 0.5 + WALKER_M;
        !segment_meets_box(local(from), local(to), half)
    };
    let overruns = |(vehicle, body): (&Vehicle, &Body)| {
        // Who stays at a stop or kerb is passed closely.
        if cover::stays(vehicle) {
            return !passes(body);
        }
        let lanes_m = if vehicle.manoeuvre == Manoeuvre::Keep { LANE_M } else { 2.0 * LANE_M };
        let speed = body.velocity_mps.truncate().length();
        let forward = (body.rotation * Vec3::X).truncate().normalize_or(Vec2::X);
        let half_m = body.kind.size_m().x * 0.5;
        let stop_m = half_m + NEAR_M + speed * REACTION_S + speed * speed / (2.0 * BRAKE_MPS2);
        let place = body.position.truncate();
        (0..=STRIDES).any(|k| {
            let way = from.lerp(to, k as f32 / STRIDES as f32) - place;
            let (ahead_m, aside_m) = (way.dot(forward), forward.perp_dot(way).abs());
            // Straight ahead, or anywhere around where its lane may bend to.
            (aside_m < lanes_m && ahead_m > -half_m && ahead_m < stop_m) || way.length() < half_m + NEAR_M
        })
    };
    !vehicles.iter().zip(bodies).any(overruns)
}

fn beside_road(map: &MapData, walker: &Walker) -> bool {
    let edge = &map.walk_edges[walker.edge as usize];
    let inside = walker.s_m > 1.0 && walker.s_m < edge.length_m - 1.0;
    walker.mode == WalkerMode::Walk && edge.crosswalk.is_none() && edge.beside.is_some() && inside
}

/// Whether somebody who starts from `place` now gets in front of the ego car.
fn is_before(ego: &Obstacle, place: Vec3) -> bool {
    let velocity = ego.velocity_mps.truncate();
    let speed = velocity.length();
    if speed < 3.0 {
        return false;
    }
    let offset = (place - ego.position).truncate();
    let ahead_m = offset.dot(velocity) / speed;
    let aside_m = velocity.perp_dot(offset).abs() / speed;
    let arrives_s = ahead_m / speed;
    // At about 1.5 m/s: in the lane of the ego car when that is there, or up to two seconds before.
    let steps_s = aside_m / 1.5;
    ahead_m > 0.0 && aside_m < 14.0 && arrives_s > steps_s && arrives_s < steps_s + 2.0
}

/// From where to where a walker would cross the road.
pub(super) fn way_across(map: &MapData, ways: &Ways, walker: &Walker) -> Option<[Vec2; 2]> {
    let start = Walker { forward: road_is_left(map, ways, walker), ..*walker };
    let goal = goal(map, ways, &start)?;
    let place = ways.walker_place(&start);
    let sign = if start.forward { 1.0 } else { -1.0 };
    Some([place.beside(start.offset_m), place.beside(sign * goal.distance_m)].map(Vec3::truncate))
}

/// Whether no prop stands in a way.
pub(super) fn is_free(map: &MapData, from: Vec2, to: Vec2) -> bool {
    !map.props.iter().any(|prop| touches(prop, from, to))
}

/// Whether the road beside a walker's edge lies to the left of it.
pub(super) fn road_is_left(map: &MapData, ways: &Ways, walker: &Walker) -> bool {
    let place = ways.walker_place(walker);
    let Some(lane) = map.walk_edges[walker.edge as usize].beside else { return true };
    let offsets = map.lanes[lane as usize].points.iter().map(|p| (p.position - place.position).truncate());
    let nearest = offsets.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    nearest.is_some_and(|offset| offset.dot(place.left()) > 0.0)
}

/// The nearest sidewalk straight across the road, seen from a walker on its way there.
pub(super) fn goal(map: &MapData, ways: &Ways, walker: &Walker) -> Option<Goal> {
    let place = ways.walker_place(walker);
    let (origin, across) = (place.position.truncate(), place.left() * if walker.forward { 1.0 } else { -1.0 });
    let mut best: Option<Goal> = None;
    for &edge in &ways.edges[walker.edge as usize].facing {
        let (points, way) = (&map.walk_edges[edge as usize].points, &ways.edges[edge as usize]);
        for (i, pair) in points.windows(2).enumerate() {
            let Some((distance_m, t)) = meet(origin, across, pair[0].truncate(), pair[1].truncate()) else { continue };
            if ROAD_M.contains(&distance_m) && best.is_none_or(|b| distance_m < b.distance_m) {
                let s_m = way.s_m[i] + t * (way.s_m[i + 1] - way.s_m[i]);
                best = Some(Goal { distance_m, edge, s_m });
            }
        }
    }
    best
}

/// Where a ray meets a segment: distance along the ray, and fraction of the segment.
fn meet(origin: Vec2, along: Vec2, a: Vec2, b: Vec2) -> Option<(f32, f32)> {
    let (side, offset) = (b - a, a - origin);
    let area = along.perp_dot(side);
    if area.abs() < 1e-4 {
        return None;
    }
    let (distance, t) = (offset.perp_dot(side) / area, offset.perp_dot(along) / area);
    (distance > 0.0 && (0.0..=1.0).contains(&t)).then_some((distance, t))
}

/// Speed of somebody who crosses the road.
pub(super) fn pace(seed: u64, walker: &Walker, traits: &WalkerTraits) -> f32 {
    let runs = unit(seed, Stream::Jaywalk, u64::from(walker.id), !u64::from(walker.hops)) < RUNNERS;
    if runs { RUN_MPS } else { traits.speed_mps + 0.3 }
}

/// Puts a walker who has reached the other side on the way there.
pub(super) fn arrive(ways: &Ways, seed: u64, goal: &Goal, walker: &mut Walker) {
    let from = ways.walker_place(walker).beside(walker.offset_m).truncate();
    let place = ways.edge_place(goal.edge, goal.s_m);
    let offset = from - place.position.truncate();
    walker.edge = goal.edge;
    walker.s_m = goal.s_m + offset.dot(place.forward.truncate().normalize_or(Vec2::X));
    walker.offset_m = offset.dot(place.left());
    walker.hops = walker.hops.wrapping_add(1);
    walker.forward = bits(seed, Stream::Walk, u64::from(walker.id), u64::from(walker.hops)) & 1 == 0;
    walker.mode = WalkerMode::Walk;
    walker.wait_ticks = 0;
}

/// Whether a walker who goes from one point to another touches a prop.
fn touches(prop: &Prop, from: Vec2, to: Vec2) -> bool {
    let half = match prop.kind {
        PropKind::Tree | PropKind::Lamp | PropKind::Sign | PropKind::SignalPole => Vec2::splat(0.2),
        _ => prop.size.truncate() * 0.5,
    } + WALKER_M;
    let centre = prop.position.truncate();
    let reach = half.length() + 1.0;
    if (from.distance(centre) + to.distance(centre)) > from.distance(to) + 2.0 * reach {
        return false;
    }
    let axis = direction(prop.heading_rad);
    let local = |p: Vec2| Vec2::new((p - centre).dot(axis), axis.perp_dot(p - centre));
    segment_meets_box(local(from), local(to), half)
}

/// Whether a segment meets the box of half extent `half` around the origin (slab test).
fn segment_meets_box(from: Vec2, to: Vec2, half: Vec2) -> bool {
    let (mut enter, mut leave) = (0.0f32, 1.0f32);
    for axis in 0..2 {
        let (p, d) = (from[axis], to[axis] - from[axis]);
        if d.abs() < 1e-6 {
            if p.abs() > half[axis] {
                return false;
            }
            continue;
        }
        let (a, b) = ((-half[axis] - p) / d, (half[axis] - p) / d);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    enter <= leave
}
