//! Where the ego car is asked to drive: seeded random turns, drawn as the car gets there.

use glam::Vec3;

use crate::ego;
use crate::events::{Hud, RouteArrow};
use crate::map::{LaneId, LaneKind, LightGroupId, Projection, RoadNetwork, Turn};
use crate::rng::{self, Stream};
use crate::scenario::Scenario;
use crate::signals::LightPhase;
use crate::{ops, state};

/// The route is known at least this far ahead, metres (less before a dead end).
pub const HORIZON_M: f32 = 250.0;
/// How far from the edge of its lane the car may be until the route is planned anew, metres.
const STRAY_M: f32 = 0.6;
/// Lanes that lead where the car heads are looked for within this from their edges, metres: over the lanes for the other
/// direction, on which it may be. Where there are none the nearest one is taken, but not before the car is so far from
/// the edge of its own.
const LOST_M: f32 = 8.0;
/// Radius in which a new lane is looked for, metres.
const SEARCH_M: f32 = 50.0;
/// Distance of the place that the HUD's arrow points to, metres.
const ARROW_M: f32 = 12.0;
/// The HUD shows a light within this, metres.
const LIGHT_M: f32 = 50.0;
/// And from farther away where people have to be able to see it: the least sight distances of the MUTCD (2009, table
/// 4D-2: 82 m at 48 km/h, 165 m at 80 km/h) are the way in this time, s, and that of braking by so much, m/s².
const READ_S: f32 = 3.8;
const READ_BRAKE_MPS2: f32 = 3.05;
/// Then the line is not farther to the side than this angle, radians: 30 degrees.
const SIGHT_RAD: f32 = core::f32::consts::FRAC_PI_6;
/// From the middle of the car to its front bumper, metres.
const NOSE_M: f32 = ego::FRONT_M - ego::CENTRE_M.x;

state! {
    /// The route and the car's place on it.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Route {
        /// Lanes from the one under the car on; never empty.
        pub lanes: Vec<LaneId>,
        /// Where the middle of the car is on the first lane, metres from its start.
        pub s_m: f32,
        /// Turns drawn so far.
        pub drawn: u32,
    }
}

/// A light's stop line ahead on the route.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightAhead {
    /// The lane with the line.
    pub lane: LaneId,
    /// The light.
    pub group: LightGroupId,
    /// From the car's front bumper to the line, metres.
    pub distance_m: f32,
}

impl Route {
    /// A route along some lanes, and then on; it starts on the first of them.
    pub fn along(network: &RoadNetwork, seed: u64, lanes: Vec<LaneId>, s_m: f32) -> Self {
        let mut route = Self { lanes, s_m, drawn: 0 };
        route.extend(network, seed);
        route
    }

    /// Follows the car to `middle`. True when the car had left the route and it was planned anew.
    pub fn follow(&mut self, network: &RoadNetwork, seed: u64, middle: Vec3, heading_rad: f32) -> bool {
        let mut here = network.project(self.lanes[0], middle);
        while let Some(&next) = self.lanes.get(1) {
            let there = network.project(next, middle);
            if here.s_m < network.lanes[here.lane as usize].length_m || there.distance_m > here.distance_m {
                break;
            }
            self.lanes.remove(0);
            here = there;
        }
        self.s_m = here.s_m;
        let stray = here.distance_m - network.lane_point(here.lane, here.s_m).half_width_m;
        let strayed = stray > STRAY_M && self.plan_anew(network, middle, heading_rad, stray);
        self.extend(network, seed);
        strayed
    }

    /// Goes on from the nearest lane that leads where the car heads, if that is nearer than its own, so that it may leave
    /// its lane for the one of the other direction and come back; else from the nearest one of all.
    fn plan_anew(&mut self, network: &RoadNetwork, middle: Vec3, heading_rad: f32, stray_m: f32) -> bool {
        let beyond_m = |p: &Projection| p.distance_m - network.lane_point(p.lane, p.s_m).half_width_m;
        let found = match network.nearest_leading(middle, heading_rad, LOST_M) {
            Some(place) => Some(place).filter(|place| beyond_m(place) < stray_m),
            None if stray_m < LOST_M => None,
            None => network.nearest_lane(middle, LaneKind::Driving, Some(heading_rad), SEARCH_M),
        };
        let Some(place) = found.filter(|place| place.lane != self.lanes[0]) else { return false };
        self.lanes.clear();
        self.lanes.push(place.lane);
        self.s_m = place.s_m;
        true
    }

    fn extend(&mut self, network: &RoadNetwork, seed: u64) {
        let length = |lane: LaneId| network.lanes[lane as usize].length_m;
        let mut known_m = self.known_m(network);
        while known_m < HORIZON_M {
            let choices = network.ways().onward(self.last());
            if choices.is_empty() {
                break;
            }
            let pick = rng::below(seed, Stream::Route, u64::from(self.drawn), 0, choices.len() as u32);
            self.drawn = self.drawn.wrapping_add(1);
            let next = choices[pick as usize];
            self.lanes.push(next.lane);
            known_m += (length(next.lane) - next.at_m).max(0.1);
        }
    }

    fn last(&self) -> LaneId {
        self.lanes[self.lanes.len() - 1]
    }

    /// Metres from the middle of the car to where the route is not known any more.
    fn known_m(&self, network: &RoadNetwork) -> f32 {
        self.stretches(network).last().map_or(0.0, |(lane, start)| start + network.lanes[lane as usize].length_m)
    }

    /// Metres from the front of the car to where the road ends; `None` where that is not in sight.
    pub fn ends_in_m(&self, network: &RoadNetwork) -> Option<f32> {
        network.ways().onward(self.last()).is_empty().then(|| self.known_m(network) - NOSE_M)
    }

    /// Each lane of the route with the distance from the middle of the car to its start, metres;
    /// negative for the lane under the car.
    fn stretches<'a>(&'a self, network: &'a RoadNetwork) -> impl Iterator<Item = (LaneId, f32)> + 'a {
        self.lanes.iter().scan((None, -self.s_m), |(before, end_m), &lane| {
            // Who comes from a lane that ends beside this one is not at its start.
            let start_m = *end_m - before.map_or(0.0, |before| network.ways().enters_at_m(before, lane));
            (*before, *end_m) = (Some(lane), start_m + network.lanes[lane as usize].length_m);
            Some((lane, start_m))
        })
    }

    /// The next traffic light's line that the front of the car has not passed.
    pub fn light_ahead(&self, network: &RoadNetwork) -> Option<LightAhead> {
        let next = self.lanes.iter().skip(1).map(Some).chain([None]);
        self.stretches(network).zip(next).find_map(|((lane, start), next)| {
            let stop = network.lanes[lane as usize].stop?;
            let group = network.light_between(lane, *next.unwrap_or(&lane))?;
            let distance_m = start + stop.s_m - NOSE_M;
            (distance_m >= 0.0).then_some(LightAhead { lane, group, distance_m })
        })
    }

    /// Whether the front of the car has passed the line of `light`, which was ahead before.
    pub fn passed(&self, network: &RoadNetwork, light: &LightAhead) -> bool {
        let line = self.stretches(network).find(|(lane, _)| *lane == light.lane);
        let stop = network.lanes[light.lane as usize].stop;
        match (line, stop) {
            (Some((_, start)), Some(stop)) => start + stop.s_m - NOSE_M < 0.0,
            _ => true,
        }
    }

    /// The place of the route `ahead_m` before the middle of the car.
    fn point(&self, network: &RoadNetwork, ahead_m: f32) -> Vec3 {
        let holds = |(lane, start): &(LaneId, f32)| ahead_m < start + network.lanes[*lane as usize].length_m;
        let (lane, start) = self
            .stretches(network)
            .find(holds)
            .or_else(|| self.stretches(network).last())
            .unwrap_or((self.lanes[0], -self.s_m));
        network.lane_point(lane, ahead_m - start).position
    }

    /// The middle of the route from the car on, points about 1 m apart.
    pub fn ahead(&self, network: &RoadNetwork, distance_m: f32) -> Vec<Vec3> {
        let steps = ops::floor(distance_m.clamp(0.0, self.known_m(network).max(0.0))) as u32;
        (0..=steps).map(|step| self.point(network, step as f32)).collect()
    }

    /// The speed limit under the car, m/s, at most the rules' own.
    pub fn limit_mps(&self, network: &RoadNetwork, scenario: &Scenario) -> f32 {
        network.lanes[self.lanes[0] as usize].speed_limit_mps.min(scenario.rules.max_speed_kmh / 3.6)
    }

    /// What the HUD shows to a driver at `middle`.
    pub fn hud(
        &self,
        network: &RoadNetwork,
        scenario: &Scenario,
        shown: impl Fn(LightGroupId) -> LightPhase,
        car: &ego::Ego,
    ) -> Hud {
        let limit_mps = self.limit_mps(network, scenario);
        let read_m = limit_mps * READ_S + limit_mps * limit_mps / (2.0 * READ_BRAKE_MPS2);
        let is_read = |light: &LightAhead| {
            light.distance_m <= LIGHT_M || light.distance_m <= read_m && self.is_in_sight(network, light, car)
        };
        let light = self.light_ahead(network).filter(is_read);
        Hud {
            speed_mps: car.speed_mps(),
            limit_mps,
            light: light.map(|light| shown(light.group)),
            light_distance_m: light.map_or(0, |light| light.distance_m as u16),
            arrow: self.arrow(network, car),
        }
    }

    /// Whether a light is that of the next junction and the way there about straight on.
    fn is_in_sight(&self, network: &RoadNetwork, light: &LightAhead, car: &ego::Ego) -> bool {
        let mut before = self.lanes.iter().take_while(|lane| **lane != light.lane);
        let next = before.all(|lane| network.lanes[*lane as usize].junction.is_none());
        let to = self.point(network, light.distance_m + NOSE_M) - car.middle();
        next && ops::wrap_angle(ops::atan2(to.y, to.x) - car.heading_rad()).abs() <= SIGHT_RAD
    }

    fn arrow(&self, network: &RoadNetwork, car: &ego::Ego) -> RouteArrow {
        let junction = self.stretches(network).find(|(lane, _)| network.lanes[*lane as usize].junction.is_some());
        let (turn, distance_m) = junction.map_or((Turn::Straight, HORIZON_M), |(lane, start)| {
            (network.lanes[lane as usize].turn, (start - NOSE_M).max(0.0))
        });
        let to = self.point(network, ARROW_M) - car.middle();
        let bearing_rad = ops::wrap_angle(car.heading_rad() - ops::atan2(to.y, to.x));
        let bearing_deg = 5 * ops::round(bearing_rad.to_degrees() / 5.0) as i16;
        RouteArrow { turn, distance_m: distance_m as u16, bearing_deg }
    }
}

#[cfg(test)]
mod tests;
