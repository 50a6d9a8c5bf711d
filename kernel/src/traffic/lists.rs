//! Which vehicles are on which lane, rebuilt each tick in memory that is kept.

use crate::map_data::{LaneId, MapData};

use super::links::Onward;
use super::sideways::reaches_into;
use super::traits::Driver;
use super::vehicle::Vehicle;

/// A vehicle's place on a lane. One that reaches over an end stands on both lanes, its middle
/// before the start or beyond the end of the one; so does one that changes lanes, until it has left the one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub lane: LaneId,
    pub s_m: f32,
    pub half_m: f32,
    pub speed_mps: f32,
    /// Index of the vehicle.
    pub vehicle: u32,
    pub id: u16,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    entries: Vec<Entry>,
    /// For each lane, its first entry and the number of them.
    spans: Vec<(u32, u32)>,
}

impl Lists {
    /// Vehicles on a lane by ascending place.
    pub fn on(&self, lane: LaneId) -> &[Entry] {
        let (first, count) = self.spans[lane as usize];
        &self.entries[first as usize..(first + count) as usize]
    }

    /// Takes the vehicles that are `present`; `next_lane` tells where one goes on.
    pub fn rebuild(
        &mut self,
        map: &MapData,
        vehicles: &[Vehicle],
        drivers: &[Driver],
        next_lane: impl Fn(&Vehicle) -> Option<Onward>,
        present: impl Fn(&Vehicle) -> bool,
    ) {
        for entry in self.entries.drain(..) {
            self.spans[entry.lane as usize] = (0, 0);
        }
        self.spans.resize(map.lanes.len(), (0, 0));
        for (i, vehicle) in vehicles.iter().enumerate() {
            if present(vehicle) {
                self.add(map, i, vehicle, &drivers[i], &next_lane);
            }
        }
        let key = |e: &Entry| (e.lane, e.s_m, e.id);
        self.entries.sort_unstable_by(|a, b| {
            let ((l, s, i), (m, t, j)) = (key(a), key(b));
            l.cmp(&m).then(s.total_cmp(&t)).then(i.cmp(&j))
        });
        for (i, entry) in self.entries.iter().enumerate() {
            let span = &mut self.spans[entry.lane as usize];
            *span = if span.1 == 0 { (i as u32, 1) } else { (span.0, span.1 + 1) };
        }
    }

    fn add(
        &mut self,
        map: &MapData,
        index: usize,
        vehicle: &Vehicle,
        driver: &Driver,
        next_lane: &impl Fn(&Vehicle) -> Option<Onward>,
    ) {
        let half_m = driver.size_m.x * 0.5;
        let lane = &map.lanes[vehicle.lane as usize];
        let entry = Entry {
            lane: vehicle.lane,
            s_m: vehicle.s_m,
            half_m,
            speed_mps: vehicle.speed_mps,
            vehicle: index as u32,
            id: vehicle.id,
        };
        self.entries.push(entry);
        if let Some(left) = reaches_into(map, vehicle, driver) {
            self.entries.push(Entry { lane: left.lane, s_m: left.s_m, ..entry });
        }
        if vehicle.s_m < half_m {
            for &before in &lane.predecessors {
                let s_m = vehicle.s_m + map.lanes[before as usize].length_m;
                self.entries.push(Entry { lane: before, s_m, ..entry });
            }
        }
        if vehicle.s_m + half_m > lane.length_m {
            let reach = |next: Onward| Entry { lane: next.lane, s_m: vehicle.s_m - lane.length_m + next.at_m, ..entry };
            self.entries.extend(next_lane(vehicle).map(reach));
        }
    }
}
