//! Who crosses at a crosswalk, and when.

use glam::Vec2;

use crate::light::LightPhase;
use crate::map_data::{LaneId, MapData, Place};
use crate::rng::{Stream, unit};
use crate::time::{TICK_HZ, Tick};

use super::hazard::Hazard;
use super::horn::{Horn, PEOPLE_ASIDE_M};
use super::lists::{Entry, Lists};
use super::surprise;
use super::vehicle::Vehicle;
use super::walker::Walker;
use super::ways::Ways;

/// Vehicles stop for people who reach their lane within this time, s.
const APPROACH_S: f32 = 4.0;
/// Slower than this, across the lanes, somebody stands on a crosswalk, m/s.
const STANDS_MPS: f32 = 0.2;
/// Share of those who step onto a crosswalk without lights and without looking.
const CARELESS: f32 = 0.06;
/// Vehicles slower than this let people go, m/s.
const CREEP_MPS: f32 = 1.2;
/// Braking that careless people expect of vehicles, m/s².
const CARELESS_BRAKE_MPS2: f32 = 3.5;
/// Until a driver sees that somebody careless has stepped out, s.
const CARELESS_SEEN_S: f32 = 0.5;
/// Time that people want to have left when the vehicle arrives, s.
const SPARE_S: f32 = 0.5;
/// Vehicles that have stood for this long heed those who wait no more, s, who then let them go, if they stand so near, metres.
pub(super) const HEED_S: u8 = 15;
const LET_GO_M: std::ops::Range<f32> = -1.0..6.0;
/// Vehicles farther away than this are not waited for, metres.
const WATCH_M: f32 = 45.0;

/// Somebody on a crosswalk, or at the kerb of one without lights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Claim {
    pub crosswalk: u32,
    pub position: Vec2,
    pub velocity: Vec2,
    pub waiting: bool,
}

/// Whether people on a crosswalk, or `heeds_waiting` also those who wait at it, keep a vehicle from going
/// over it; `place` is where its lane meets the crosswalk. `claims` are sorted by crosswalk.
pub(super) fn is_claimed(claims: &[Claim], crosswalk: u32, heeds_waiting: bool, place: impl Fn() -> Place) -> bool {
    let first = claims.partition_point(|c| c.crosswalk < crosswalk);
    let mut on_it = claims[first..].iter().take_while(|c| c.crosswalk == crosswalk);
    on_it.any(|claim| if claim.waiting { heeds_waiting } else { crosses(claim, &place()) })
}

fn crosses(claim: &Claim, place: &Place) -> bool {
    let left = place.left();
    let at_m = (claim.position - place.position.truncate()).dot(left);
    let speed = claim.velocity.dot(left);
    // Who stands at the kerb is in nobody's way.
    let reach_m = place.half_width_m + if speed.abs() > STANDS_MPS { 0.7 } else { 0.35 };
    let comes = at_m * speed < 0.0 && at_m.abs() < reach_m + speed.abs() * APPROACH_S;
    at_m.abs() < reach_m || comes
}

/// What people look at before they cross.
#[derive(Clone, Copy)]
pub(super) struct Gaps<'a> {
    pub map: &'a MapData,
    pub ways: &'a Ways,
    pub seed: u64,
    pub lists: &'a Lists,
    pub vehicles: &'a [Vehicle],
    pub lights: &'a [(LightPhase, Tick)],
    /// The ego car and loose actors.
    pub free: &'a [Hazard],
    pub horn: Option<Horn>,
}

impl Gaps<'_> {
    /// Whether a walker at `position` starts over a crosswalk that takes it `time_s` to cross.
    pub fn may_cross(&self, crosswalk: u32, walker: &Walker, position: Vec2, time_s: f32) -> bool {
        // Who hears a horn waits.
        if self.horn.is_some_and(|horn| horn.is_for(position, PEOPLE_ASIDE_M)) {
            return false;
        }
        let lights = &self.ways.crosswalk_lights[crosswalk as usize];
        let needed = ((time_s + 1.0) * TICK_HZ as f32) as Tick;
        let red = |group: &u32| {
            let (phase, left) = self.lights[*group as usize];
            phase == LightPhase::Red && left > needed
        };
        if !lights.iter().all(red) || (lights.is_empty() && self.lets_go(crosswalk)) {
            return false;
        }
        let careless = unit(self.seed, Stream::Walk, u64::from(walker.id), !u64::from(walker.hops)) < CARELESS;
        let dares = || self.can_stop(crosswalk) && self.leaves_time_on(crosswalk, position, time_s);
        (careless && lights.is_empty() && dares()) || self.is_clear(crosswalk, position, time_s)
    }

    /// Whether the ego car can still stop before a way that somebody goes from now on, metres, m/s ([`surprise`]).
    pub fn leaves_time(&self, way: [Vec2; 2], pace_mps: f32) -> bool {
        let mut ego = self.free.iter().filter(|hazard| hazard.is_ego());
        ego.all(|ego| surprise::leaves_time(ego, way, pace_mps))
    }

    /// The same of somebody careless on a crosswalk, who does not look for more than that.
    fn leaves_time_on(&self, crosswalk: u32, from: Vec2, time_s: f32) -> bool {
        let ends = self.map.crosswalks[crosswalk as usize].ends.map(|end| end.truncate());
        let to = if from.distance(ends[0]) > from.distance(ends[1]) { ends[0] } else { ends[1] };
        let pace_mps = (ends[0].distance(ends[1]) / time_s.max(0.1)).max(0.1);
        self.leaves_time([from, to], pace_mps)
    }

    /// Whether every vehicle on the lanes of a crosswalk can still stop before it.
    fn can_stop(&self, crosswalk: u32) -> bool {
        let crossed = &self.map.crosswalks[crosswalk as usize];
        crossed.lanes.iter().all(|&(lane, s_m)| !self.overruns(lane, s_m, crossed.half_width_m, 0))
    }

    /// Whether a vehicle on `lane` or the lanes before it is on the crosswalk at `s_m`, or cannot stop before it.
    fn overruns(&self, lane: LaneId, s_m: f32, half_width_m: f32, depth: u32) -> bool {
        let early = self.lists.on(lane).iter().any(|entry| {
            let gap_m = s_m - half_width_m - entry.s_m - entry.half_m;
            let gone = entry.s_m - entry.half_m > s_m + half_width_m;
            let stops_m = entry.speed_mps * (CARELESS_SEEN_S + entry.speed_mps / (2.0 * CARELESS_BRAKE_MPS2));
            !gone && gap_m < stops_m + 1.5
        });
        let further =
            |p: &LaneId| self.overruns(*p, s_m + self.map.lanes[*p as usize].length_m, half_width_m, depth + 1);
        early || (depth < 2 && s_m < WATCH_M && self.map.lanes[lane as usize].predecessors.iter().any(further))
    }

    /// Whether a vehicle that has stood before a crosswalk for long is let go by those who are not on it yet: in a stream of
    /// people it would never get over.
    fn lets_go(&self, crosswalk: u32) -> bool {
        let crossed = &self.map.crosswalks[crosswalk as usize];
        crossed.lanes.iter().any(|&(lane, s_m)| {
            self.lists.on(lane).iter().any(|entry| {
                let gap_m = s_m - crossed.half_width_m - entry.s_m - entry.half_m;
                let stands = entry.speed_mps < CREEP_MPS && LET_GO_M.contains(&gap_m);
                stands && self.vehicles[entry.vehicle as usize].stuck_s >= HEED_S
            })
        })
    }

    /// Whether a vehicle stands on a crosswalk, so that nobody can cross whoever waits for them.
    pub fn is_blocked(&self, crosswalk: u32) -> bool {
        let crossed = &self.map.crosswalks[crosswalk as usize];
        let stands = |lane: LaneId, s_m: f32| {
            let on_it = |e: &Entry| (e.s_m - s_m).abs() < e.half_m + crossed.half_width_m && e.speed_mps < 0.5;
            self.lists.on(lane).iter().any(on_it)
        };
        crossed.lanes.iter().any(|&(lane, s_m)| stands(lane, s_m))
    }

    /// Whether nothing arrives before the crosswalk is crossed.
    fn is_clear(&self, crosswalk: u32, from: Vec2, time_s: f32) -> bool {
        let crossed = &self.map.crosswalks[crosswalk as usize];
        let held = !self.ways.crosswalk_lights[crosswalk as usize].is_empty();
        // Vehicles on lanes with a red light stay behind it.
        let watched = |lane: LaneId| !(held && self.map.lanes[lane as usize].stop.is_some());
        let lanes_clear = crossed
            .lanes
            .iter()
            .filter(|(lane, _)| watched(*lane))
            .all(|&(lane, s_m)| !self.arrives(lane, s_m, crossed.half_width_m, time_s, 0));
        let middle = (crossed.ends[0] + crossed.ends[1]).truncate() * 0.5;
        let reach_m = middle.distance(from) + 1.0;
        lanes_clear && !self.free.iter().any(|h| heads_for(h, middle, reach_m, time_s))
    }

    /// Whether a vehicle on `lane` or the lanes before it is at `s_m`, or arrives there within `time_s`.
    fn arrives(&self, lane: LaneId, s_m: f32, half_width_m: f32, time_s: f32, depth: u32) -> bool {
        let early = self.lists.on(lane).iter().any(|entry| {
            let gap_m = s_m - half_width_m - entry.s_m - entry.half_m;
            let gone = entry.s_m - entry.half_m > s_m + half_width_m;
            let on_it = gap_m < 0.0 && !gone;
            let comes = entry.speed_mps > CREEP_MPS && time_s > 0.0 && gap_m < entry.speed_mps * (time_s + SPARE_S);
            !gone && (on_it || (comes && gap_m < WATCH_M))
        });
        let before = &self.map.lanes[lane as usize].predecessors;
        let further = |p: &LaneId| {
            let s_m = s_m + self.map.lanes[*p as usize].length_m;
            self.arrives(*p, s_m, half_width_m, time_s, depth + 1)
        };
        early || (depth < 2 && s_m < WATCH_M && before.iter().any(further))
    }
}

/// Whether something free will be within `reach_m` of `middle` in less than `time_s`.
fn heads_for(hazard: &Hazard, middle: Vec2, reach_m: f32, time_s: f32) -> bool {
    let (offset, speed) = (middle - hazard.position.truncate(), hazard.velocity.length());
    if speed < CREEP_MPS {
        return offset.length() < hazard.half.x && hazard.half.x > 1.0;
    }
    let direction = hazard.velocity / speed;
    let ahead_m = offset.dot(direction);
    let aside_m = direction.perp_dot(offset).abs();
    ahead_m > 0.0 && aside_m < reach_m && ahead_m - reach_m < speed * (time_s + SPARE_S) && ahead_m < WATCH_M
}
