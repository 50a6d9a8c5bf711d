//! Traffic lights: a function of the tick, so nothing of them is state.
//!
//! Programme of CARLA: one approach of a junction at a time, green 10 s, yellow 3 s, then 2 s in
//! which all are red.

use crate::map_data::{LightGroupId, MapData};
use crate::rng::{self, Stream};
use crate::time::{Tick, seconds};

pub use crate::light::LightPhase;

/// Length of green.
pub const GREEN_TICKS: Tick = seconds(10);
/// Length of yellow.
pub const YELLOW_TICKS: Tick = seconds(3);
/// Length of the clearance in which all approaches are red.
pub const ALL_RED_TICKS: Tick = seconds(2);

const SLOT_TICKS: Tick = GREEN_TICKS + YELLOW_TICKS + ALL_RED_TICKS;

/// The phase of a light group at a tick, and the ticks until it changes.
pub fn phase(map: &MapData, seed: u64, group: LightGroupId, tick: Tick) -> (LightPhase, Tick) {
    let light = &map.light_groups[group as usize];
    let groups = map.junctions[light.junction as usize].light_groups.len().max(1) as Tick;
    let cycle = groups * SLOT_TICKS;
    let offset = Tick::from(rng::below(seed, Stream::Signal, u64::from(light.junction), 0, cycle as u32));
    let at = (tick + offset) % cycle;
    let start = Tick::from(light.place) * SLOT_TICKS;
    let into = (at + cycle - start) % cycle;
    if into < GREEN_TICKS {
        (LightPhase::Green, GREEN_TICKS - into)
    } else if into < GREEN_TICKS + YELLOW_TICKS {
        (LightPhase::Yellow, GREEN_TICKS + YELLOW_TICKS - into)
    } else {
        (LightPhase::Red, cycle - into)
    }
}
