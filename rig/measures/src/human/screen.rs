//! How old the mask on the semantic driver's screen was, at every tick at which the car moves: a log
//! holds a new mask only when it differs from the one before, so that age means nothing at standstill.

use kernel::time::{TICK_HZ, Tick};
use replay::{Log, MaskShown};
use serde::Serialize;

use crate::stats::Spread;

/// Length of a tick in real time, microseconds.
const TICK_US: f64 = 1e6 / TICK_HZ as f64;

/// Age of the mask on the screen, over all ticks that have one and at which the car moves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScreenAge {
    /// From the tick that it is a picture of to the tick whose controls were given with it in view.
    pub ticks: Spread,
    /// The same in wall-clock time; live drives only.
    pub ms: Option<Spread>,
    /// From capture to screen, once for each mask of the drive; live drives only.
    pub frame_to_screen_ms: Option<Spread>,
}

/// That of a log; `moving` says for each tick after the first whether the car moves, up to where the
/// measure ends. `None` where there is no such tick with a mask.
pub fn age(log: &Log, moving: &[bool]) -> Option<ScreenAge> {
    let clock = WallClock::of(log);
    let shown = |tick: Tick| Some((tick, log.mask_at(tick)?));
    let ticks = (log.first_tick() + 1..).zip(moving).filter_map(|(tick, moves)| moves.then_some(tick));
    let seen: Vec<(Tick, &MaskShown)> = ticks.filter_map(shown).collect();
    let ticks = Spread::of(seen.iter().map(|(tick, mask)| mask.age_at(*tick) as f64).collect())?;
    let ms = |tick: Tick, mask: &MaskShown| Some((clock.us(tick)? - clock.us(mask.tick_of_frame)?) / 1e3);
    let latency_ms = |mask: &MaskShown| {
        let times = mask.times.filter(|_| mask.tick_of_frame > log.first_tick())?;
        Some(times.present_us.saturating_sub(times.capture_us) as f64 / 1e3)
    };
    Some(ScreenAge {
        ticks,
        ms: Spread::of(seen.iter().filter_map(|(tick, mask)| ms(*tick, mask)).collect()),
        frame_to_screen_ms: Spread::of(log.masks.iter().filter_map(latency_ms).collect()),
    })
}

/// When the ticks of a live drive happened: at the capture of each frame, and evenly in between. The
/// frame of the first tick says nothing, since it waits for the start.
struct WallClock {
    captures: Vec<(Tick, f64)>,
}

impl WallClock {
    fn of(log: &Log) -> Self {
        let live = log.masks.iter().filter(|mask| mask.tick_of_frame > log.first_tick());
        let mut captures: Vec<(Tick, f64)> =
            live.filter_map(|mask| Some((mask.tick_of_frame, mask.times?.capture_us as f64))).collect();
        captures.dedup_by_key(|(tick, _)| *tick);
        Self { captures }
    }

    /// Microseconds since the session began; `None` in simulated drives.
    fn us(&self, tick: Tick) -> Option<f64> {
        let next = self.captures.partition_point(|(t, _)| *t < tick);
        let after = self.captures.get(next);
        let before = next.checked_sub(1).map(|at| &self.captures[at]);
        let since = |a: Tick, b: Tick| b as f64 - a as f64;
        match (before, after) {
            (Some((t0, us0)), Some((t1, us1))) => Some(us0 + (us1 - us0) * since(*t0, tick) / since(*t0, *t1)),
            (Some((t, us)), None) | (None, Some((t, us))) => Some(us + TICK_US * since(*t, tick)),
            (None, None) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_between_captures_are_spread_evenly() {
        let clock = WallClock { captures: vec![(10, 1000.0), (20, 3000.0)] };
        let us = [5, 10, 15, 20, 26].map(|tick| clock.us(tick).expect("a time").round());
        assert_eq!(us, [1000.0 - 83_333.0, 1000.0, 2000.0, 3000.0, 103_000.0]);
        assert_eq!(WallClock { captures: Vec::new() }.us(5), None);
    }
}
