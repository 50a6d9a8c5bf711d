//! What is remembered of all traffic.

use super::vehicle::Vehicle;
use super::walker::Walker;
use crate::actor::ActorKind;
use crate::map_data::MapData;
use crate::state;

/// No road user is faster, m/s.
const FASTEST_MPS: f32 = 150.0;
/// Nor farther from its lane or way, metres.
const ASIDE_M: f32 = 100.0;

/// Nor drives more aslant, 1/100.
const MOST_DRIFT: u8 = 60;

state! {
    /// Steering state of all traffic. Ids are unique over both lists, ascending in each, and start
    /// at 1; vehicles come before people.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct TrafficState {
        /// Cars, lorries, buses, motorcycles and bicycles.
        pub vehicles: Vec<Vehicle>,
        /// People on foot.
        pub walkers: Vec<Walker>,
    }
}

impl TrafficState {
    /// Refuses a state that was never that of this map.
    pub(super) fn check(&self, map: &MapData) -> Result<(), String> {
        let ids = || self.vehicles.iter().map(|v| v.id).chain(self.walkers.iter().map(|w| w.id));
        if !ids().zip(ids().skip(1)).all(|(a, b)| a < b) || ids().next() == Some(0) {
            return Err("actors: expected ascending ids from 1".into());
        }
        for v in &self.vehicles {
            let lane = map.lanes.get(v.lane as usize).filter(|lane| (0.0..=lane.length_m).contains(&v.s_m));
            let before = map.lanes.len() > v.before as usize;
            let kind = !v.kind.is_on_foot();
            let drifts = [v.drift, v.drift_aim].iter().all(|drift| drift.unsigned_abs() <= MOST_DRIFT);
            let moves = (0.0..=FASTEST_MPS).contains(&v.speed_mps) && v.offset_m.abs() <= ASIDE_M;
            if lane.is_none() || !before || !kind || !moves || !drifts || v.flags & !Vehicle::ALL_FLAGS != 0 {
                return Err(format!("vehicle {}: expected a vehicle on a lane of map {}", v.id, map.name));
            }
        }
        let is_bus = |id: u16| self.vehicles.iter().any(|v| v.id == id && v.kind == ActorKind::Bus);
        if let Some(w) = self.walkers.iter().find(|w| (w.rides() || w.bus != 0) && !is_bus(w.bus)) {
            return Err(format!("walker {}: expected a bus, not {}", w.id, w.bus));
        }
        let on_map = |w: &&Walker| {
            let edge = map.walk_edges.get(w.edge as usize);
            let on_it = edge.is_some_and(|edge| (-ASIDE_M..=edge.length_m + ASIDE_M).contains(&w.s_m));
            on_it && (0.0..=FASTEST_MPS).contains(&w.speed_mps) && w.offset_m.abs() <= ASIDE_M
        };
        match self.walkers.iter().find(|w| !on_map(w)) {
            Some(w) => Err(format!("walker {}: expected a way of map {}", w.id, map.name)),
            None => Ok(()),
        }
    }
}
