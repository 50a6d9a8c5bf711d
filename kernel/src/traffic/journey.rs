//! A vehicle's way over the lanes: to its goal, and from there on to the next.

use crate::map_data::LaneId;
use crate::rng::{self, Stream};

use super::links::Onward;
use super::routes::Class;
use super::vehicle::Vehicle;
use super::ways::Ways;

/// A vehicle's way to its present goal, and from there on.
#[derive(Clone, Copy)]
pub(super) struct Journey<'a> {
    ways: &'a Ways,
    seed: u64,
    id: u16,
    class: Class,
    /// Journeys before this one.
    pub trips: u16,
    /// Seconds from the start of each lane.
    seconds: &'a [f32],
}

impl<'a> Journey<'a> {
    /// That of a vehicle.
    pub fn of(ways: &'a Ways, seed: u64, vehicle: &Vehicle) -> Self {
        let class = Class::of(vehicle.kind);
        let start = Self { ways, seed, id: vehicle.id, class, trips: vehicle.trips, seconds: &[] };
        Self { seconds: start.table(), ..start }
    }

    fn table(&self) -> &'a [f32] {
        let routes = &self.ways.routes;
        let goal = rng::below(self.seed, Stream::Turn, u64::from(self.id), u64::from(self.trips), routes.goals as u32);
        let first = goal as usize * routes.lanes;
        routes.seconds[self.class as usize].get(first..first + routes.lanes).unwrap_or(&[])
    }

    /// Where it goes on at the end of a lane.
    pub fn next_lane(&self, lane: LaneId) -> Option<Onward> {
        let way = &self.ways.lanes[lane as usize];
        let onward = if self.class == Class::Long { &way.onward_wide } else { &way.onward };
        match onward.as_slice() {
            [] => None,
            [only] => Some(*only),
            many => {
                let astray = || {
                    let which = u64::from(self.trips) << 32 | u64::from(lane);
                    many[rng::below(self.seed, Stream::Turn, u64::from(self.id), which, many.len() as u32) as usize]
                };
                Some(self.best(many).unwrap_or_else(astray))
            }
        }
    }

    /// Enters a lane: at the goal, or where no way leads there, the next journey begins.
    pub fn enter(&mut self, lane: LaneId) {
        let seconds = self.seconds(lane);
        if seconds <= 0.0 || !seconds.is_finite() {
            self.trips = self.trips.wrapping_add(1);
            self.seconds = self.table();
        }
    }

    /// Seconds from the start of a lane to the goal; 0 on it, infinite where no way leads there.
    pub fn seconds(&self, lane: LaneId) -> f32 {
        self.seconds.get(lane as usize).copied().unwrap_or(f32::INFINITY)
    }

    /// The quickest way on, if one leads to the goal.
    fn best(&self, onward: &[Onward]) -> Option<Onward> {
        let best = onward.iter().min_by(|a, b| self.seconds(a.lane).total_cmp(&self.seconds(b.lane)))?;
        Some(*best).filter(|best| self.seconds(best.lane).is_finite())
    }
}
