//! Stateless random numbers: a counter-based hash of (seed, stream, entity, tick).
//!
//! There is no generator state to save and no order of calls to keep. The mixer is the finaliser of
//! SplitMix64 (Steele et al. 2014), applied once for each word of the key.

use crate::time::Tick;

/// What a random number is for; equal keys in different streams are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Stream {
    /// Where actors start and what they are.
    Spawn = 1,
    /// Which way a vehicle turns at a junction.
    Turn = 2,
    /// Where a pedestrian walks next, and whether it crosses.
    Walk = 3,
    /// When and where a pedestrian jaywalks.
    Jaywalk = 4,
    /// The route of the ego car.
    Route = 5,
    /// Differences between individuals (desired speed, headway, looks).
    Trait = 6,
    /// Offsets of signal programmes.
    Signal = 7,
    /// Reserved for drivers outside the kernel (reaction times of bots).
    Driver = 8,
    /// Weather and counts of a default scenario.
    Scenario = 9,
    /// What stands beside the roads of a map.
    Dressing = 10,
    /// Who lets whom into its lane.
    Courtesy = 20,
    /// Mistakes of people at the wheel.
    Lapse = 14,
    /// Doors of parked cars.
    Door = 21,
    /// Who rides in a bus, and how far.
    Ride = 22,
}

fn mix(z: u64) -> u64 {
    let z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 64 random bits for a key.
pub fn bits(seed: u64, stream: Stream, entity: u64, tick: Tick) -> u64 {
    mix(mix(mix(mix(seed) ^ stream as u64) ^ entity) ^ tick)
}

/// A random number in [0, 1) with 24 bits of resolution.
pub fn unit(seed: u64, stream: Stream, entity: u64, tick: Tick) -> f32 {
    (bits(seed, stream, entity, tick) >> 40) as f32 / (1u32 << 24) as f32
}

/// A random integer in [0, n); 0 when `n` is 0.
pub fn below(seed: u64, stream: Stream, entity: u64, tick: Tick, n: u32) -> u32 {
    ((u128::from(bits(seed, stream, entity, tick)) * u128::from(n)) >> 64) as u32
}
