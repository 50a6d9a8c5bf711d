//! What is read from the log in many places.

use kernel::time::{TICK_HZ, Tick};
use kernel::{Controls, Seat, TickInput};
use replay::Log;

/// Whether "I see it" went down with the input of a tick.
pub fn is_pressed(log: &Log, seat: Seat, tick: Tick) -> bool {
    let is_down = |tick| log.input(tick).is_some_and(|input| controls(input, seat).has(Controls::SEEN));
    is_down(tick) && !is_down(tick - 1)
}

/// What a seat did.
pub fn controls(input: &TickInput, seat: Seat) -> &Controls {
    match seat {
        Seat::Semantic => &input.semantic,
        Seat::Safety => &input.safety,
    }
}

/// The last tick at which the semantic driver drives.
pub fn end_of_driving(log: &Log) -> Tick {
    log.intervention.map_or(log.last_tick(), |i| i.tick.clamp(log.first_tick(), log.last_tick()))
}

/// Ticks as milliseconds, rounded.
pub fn ms(ticks: Tick) -> u64 {
    (1000 * ticks + Tick::from(TICK_HZ) / 2) / Tick::from(TICK_HZ)
}
