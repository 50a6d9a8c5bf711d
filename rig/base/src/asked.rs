//! What may be asked for of pictures and times, whoever asks.

use kernel::time::{TICK_HZ, Tick};

use crate::failure::Usage;

/// Pixels of the greatest picture, 4096x4096: what every adapter draws and reads back in one piece.
pub const MOST_PIXELS: u32 = 1 << 24;
/// Most ticks of a time, half a year.
const MOST_TICKS: f64 = 1e9;

/// Whether pictures can have this size, pixels.
pub fn is_size((width, height): (u32, u32)) -> bool {
    let is_side = |side: u32| (8..=8192).contains(&side);
    is_side(width) && is_side(height) && width * height <= MOST_PIXELS
}

/// Refuses pictures that cannot have this size, pixels.
pub fn check_size(size: (u32, u32)) -> Result<(), Usage> {
    let (width, height) = size;
    if is_size(size) { Ok(()) } else { Err(Usage(format!("pictures of {width}x{height}; expected {}", sizes()))) }
}

/// What is expected of a size.
pub fn sizes() -> String {
    format!("sides of 8 to 8192 and at most {MOST_PIXELS} pixels")
}

/// Whether so many frames a second fall on ticks.
pub fn is_frame_rate(fps: u32) -> bool {
    fps > 0 && TICK_HZ.is_multiple_of(fps)
}

/// What is expected of frames a second.
pub fn frame_rates() -> String {
    format!("a divisor of {TICK_HZ}, as in 10")
}

/// Seconds of a run as ticks, the nearest; `None` before its start and beyond every run.
pub fn ticks(seconds: f64) -> Option<Tick> {
    let ticks = (seconds * f64::from(TICK_HZ)).round();
    (0.0..=MOST_TICKS).contains(&ticks).then_some(ticks as Tick)
}
