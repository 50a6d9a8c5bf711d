//! Traffic lights: a function of the tick, so nothing of them is state but what a story holds.
//!
//! Every junction goes through its programme again and again, from a moment that is drawn.

use crate::map_data::{LightGroupId, MapData};
use crate::rng::{self, Stream};
use crate::state;
use crate::time::Tick;

pub use crate::light::LightPhase;

/// A light that is held does not change by itself, ticks.
const HELD_TICKS: Tick = 1 << 40;

state! {
    /// A light that a story holds at a phase.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct HeldLight {
        /// The light.
        pub group: LightGroupId,
        /// What it shows.
        pub phase: LightPhase,
    }
}

/// As [`phase`], where some lights are held; by ascending group.
pub fn shown(map: &MapData, seed: u64, held: &[HeldLight], group: LightGroupId, tick: Tick) -> (LightPhase, Tick) {
    match held.binary_search_by_key(&group, |light| light.group) {
        Ok(at) => (held[at].phase, HELD_TICKS),
        Err(_) => phase(map, seed, group, tick),
    }
}

/// The phase of a light group at a tick, and the ticks until it changes.
pub fn phase(map: &MapData, seed: u64, group: LightGroupId, tick: Tick) -> (LightPhase, Tick) {
    let light = &map.light_groups[group as usize];
    let cycle_ticks = map.junctions[light.junction as usize].cycle_ticks.max(1);
    let offset = rng::below(seed, Stream::Signal, u64::from(light.junction), 0, cycle_ticks);
    let [cycle, offset, from, green, yellow] =
        [cycle_ticks, offset, light.green_from_ticks, light.green_ticks, light.yellow_ticks].map(Tick::from);
    let into = (tick + offset + cycle - from % cycle) % cycle;
    if into < green {
        (LightPhase::Green, green - into)
    } else if into < green + yellow {
        (LightPhase::Yellow, green + yellow - into)
    } else {
        (LightPhase::Red, cycle - into)
    }
}
