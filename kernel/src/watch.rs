//! Watches over the ego car: what begins in a tick becomes an event.

use crate::ego::Ego;
use crate::events::{Event, EventKind};
use crate::map::{LaneKind, RoadNetwork};
use crate::physics::Touched;
use crate::time::Tick;
use crate::{ops, state};

/// How far beyond the limit the car may be until it speeds, m/s.
const SPEEDING_MPS: f32 = 3.0 / 3.6;
/// Speed from which driving against a lane counts, m/s.
const WRONG_WAY_MPS: f32 = 1.0;
/// Ticks between two looks at the direction of the lane.
const WRONG_WAY_TICKS: Tick = 6;

state! {
    /// What was going on in the last tick, so that only its beginning is an event.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct Watch {
        /// Actors that the ego car touches, by ascending id.
        pub touching: Vec<u32>,
        /// It touches scenery.
        pub touching_scenery: bool,
        /// It is faster than the limit.
        pub speeding: bool,
        /// A wheel is off the road.
        pub off_road: bool,
        /// It drives against the direction of its lane.
        pub wrong_way: bool,
        /// Someone holds the "I see it" button.
        pub seen: bool,
    }
}

/// Collects the events of one tick.
pub struct Log<'a> {
    /// Where they go.
    pub events: &'a mut Vec<Event>,
    /// Speed of the ego car, m/s.
    pub speed_mps: f32,
}

impl Log<'_> {
    /// An event of the ego car alone.
    pub fn note(&mut self, kind: EventKind) {
        self.with(kind, 0);
    }

    /// An event with an actor.
    pub fn with(&mut self, kind: EventKind, actor: u32) {
        self.events.push(Event { kind, actor, speed_mps: self.speed_mps });
    }

    /// Notes what begins: `was` becomes `is`.
    fn edge(&mut self, kind: EventKind, was: &mut bool, is: bool) {
        if is && !*was {
            self.note(kind);
        }
        *was = is;
    }
}

impl Watch {
    /// Notes a press of the "I see it" button of either seat.
    pub fn buttons(&mut self, pressed: bool, log: &mut Log<'_>) {
        log.edge(EventKind::Seen, &mut self.seen, pressed);
    }

    /// Notes collisions; true when one began. Contact begins with an impulse and lasts until the
    /// bodies part.
    pub fn contacts(&mut self, touched: &Touched, log: &mut Log<'_>) -> bool {
        let before = log.events.len();
        let was = |id: &u32| self.touching.binary_search(id).is_ok();
        let now = touched.actors.iter().filter(|(id, pushed)| *pushed || was(id)).map(|(id, _)| *id);
        let now: Vec<u32> = now.collect();
        for id in now.iter().filter(|id| !was(id)) {
            log.with(EventKind::CollisionActor, *id);
        }
        self.touching = now;
        let scenery = touched.scenery.is_some_and(|pushed| pushed || self.touching_scenery);
        log.edge(EventKind::CollisionScenery, &mut self.touching_scenery, scenery);
        log.events.len() > before
    }

    /// Notes breaches of the rules of the road.
    pub fn rules(&mut self, limit_mps: f32, off_road: bool, wrong_way: Option<bool>, log: &mut Log<'_>) {
        let margin = if self.speeding { 0.0 } else { SPEEDING_MPS };
        let speeding = log.speed_mps > limit_mps + margin;
        log.edge(EventKind::Speeding, &mut self.speeding, speeding);
        log.edge(EventKind::OffRoad, &mut self.off_road, off_road);
        let wrong_way = wrong_way.unwrap_or(self.wrong_way);
        log.edge(EventKind::WrongWay, &mut self.wrong_way, wrong_way);
    }
}

/// Whether the car drives against every lane under it; `None` in ticks without a look.
pub fn wrong_way(network: &RoadNetwork, car: &Ego, tick: Tick) -> Option<bool> {
    if !tick.is_multiple_of(WRONG_WAY_TICKS) {
        return None;
    }
    if car.speed_mps() < WRONG_WAY_MPS {
        return Some(false);
    }
    let under = network.lanes_at(car.middle(), LaneKind::Driving);
    let heading = car.heading_rad();
    let against = |lane, s_m| ops::cos(network.lane_point(lane, s_m).heading_rad - heading) < -0.5;
    let in_junction = |lane: u32| network.lanes[lane as usize].junction.is_some();
    Some(!under.is_empty() && under.iter().all(|p| against(p.lane, p.s_m) && !in_junction(p.lane)))
}
