//! Time is counted in ticks; every rate divides the tick rate exactly.

/// A tick number. Tick 0 is the state before the first [`crate::TickInput`].
pub type Tick = u64;

/// Simulation rate in ticks a second.
pub const TICK_HZ: u32 = 60;
/// Length of one tick in seconds.
pub const TICK_S: f32 = 1.0 / TICK_HZ as f32;
/// Frames a second in the clip of a corner case (paper, section 3).
pub const CLIP_FPS: u32 = 10;
/// Length of the clip of a corner case in seconds (paper, section 3).
pub const CLIP_S: u32 = 3;
/// Ticks from one clip frame to the next.
pub const CLIP_STRIDE_TICKS: Tick = (TICK_HZ / CLIP_FPS) as Tick;
/// Frames in the clip of a corner case.
pub const CLIP_FRAMES: u32 = CLIP_S * CLIP_FPS;
/// Ticks in the clip of a corner case; also the time until a run is armed.
pub const CLIP_TICKS: Tick = (CLIP_S * TICK_HZ) as Tick;
/// Frames a second in the natural dataset (paper, section 4).
pub const DATASET_FPS: u32 = 1;
/// Ticks from one dataset frame to the next.
pub const DATASET_STRIDE_TICKS: Tick = (TICK_HZ / DATASET_FPS) as Tick;
/// Ticks from one keyframe to the next, unless the ego touches another actor.
pub const KEYFRAME_TICKS: Tick = 12 * TICK_HZ as Tick;

const _: () = {
    assert!(TICK_HZ.is_multiple_of(CLIP_FPS));
    assert!(TICK_HZ.is_multiple_of(DATASET_FPS));
    assert!(CLIP_FRAMES == 30);
    assert!(50 * CLIP_FRAMES == 1500);
    assert!(KEYFRAME_TICKS.is_multiple_of(TICK_HZ as Tick));
};

/// Seconds as ticks.
pub const fn seconds(s: u32) -> Tick {
    (s * TICK_HZ) as Tick
}
