//! Which vehicles are on which lane, rebuilt each tick in memory that is kept.

use crate::map_data::{LaneId, MapData};

use super::links::Onward;
use super::sideways::reaches_into;
use super::traits::Driver;
use super::vehicle::Vehicle;

/// A vehicle's place on a lane. One that reaches over an end stands on both lanes, its middle
/// before the start or beyond the end of the one; so does one that changes lanes, until it has left the one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Entry {
    pub lane: LaneId,
    pub s_m: f32,
    pub half_m: f32,
    pub speed_mps: f32,
    /// Index of the vehicle.
    pub vehicle: u32,
    pub id: u16,
}

impl Entry {
    /// Whether it comes before another on the same lane.
    fn is_before(&self, other: &Self) -> bool {
        self.s_m.total_cmp(&other.s_m).then(self.id.cmp(&other.id)).is_lt()
    }
}

/// A lane's stretch of the entries.
#[derive(Clone, Copy, Debug, Default)]
struct Span {
    first: u32,
    count: u32,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    /// As they were found.
    found: Vec<Entry>,
    /// By lane, and on each by ascending place.
    entries: Vec<Entry>,
    spans: Vec<Span>,
    /// Lanes with entries.
    busy: Vec<LaneId>,
}

impl Lists {
    /// Vehicles on a lane by ascending place.
    pub fn on(&self, lane: LaneId) -> &[Entry] {
        let Span { first, count } = self.spans[lane as usize];
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
        self.found.clear();
        for (i, vehicle) in vehicles.iter().enumerate() {
            if present(vehicle) {
                self.add(map, i, vehicle, &drivers[i], &next_lane);
            }
        }
        self.spans.resize(map.lanes.len(), Span::default());
        self.make_room();
        for entry in &self.found {
            let span = &mut self.spans[entry.lane as usize];
            insert(&mut self.entries[span.first as usize..], span.count as usize, *entry);
            span.count += 1;
        }
    }

    /// Gives every lane a stretch as long as its entries are many.
    fn make_room(&mut self) {
        for lane in self.busy.drain(..) {
            self.spans[lane as usize] = Span::default();
        }
        for entry in &self.found {
            let span = &mut self.spans[entry.lane as usize];
            if span.count == 0 {
                self.busy.push(entry.lane);
            }
            span.count += 1;
        }
        let mut first = 0;
        for &lane in &self.busy {
            let span = &mut self.spans[lane as usize];
            (span.first, first, span.count) = (first, first + span.count, 0);
        }
        self.entries.resize(self.found.len(), Entry::default());
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
        self.found.push(entry);
        if let Some(left) = reaches_into(map, vehicle, driver) {
            self.found.push(Entry { lane: left.lane, s_m: left.s_m, ..entry });
        }
        if vehicle.s_m < half_m {
            for &before in &lane.predecessors {
                let s_m = vehicle.s_m + map.lanes[before as usize].length_m;
                self.found.push(Entry { lane: before, s_m, ..entry });
            }
        }
        if vehicle.s_m + half_m > lane.length_m {
            let reach = |next: Onward| Entry { lane: next.lane, s_m: vehicle.s_m - lane.length_m + next.at_m, ..entry };
            self.found.extend(next_lane(vehicle).map(reach));
        }
    }
}

/// Puts an entry among the first `count`, which are in order: a lane holds few.
fn insert(entries: &mut [Entry], count: usize, entry: Entry) {
    let mut at = count;
    while at > 0 && entry.is_before(&entries[at - 1]) {
        entries[at] = entries[at - 1];
        at -= 1;
    }
    entries[at] = entry;
}
