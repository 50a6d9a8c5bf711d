//! How well a live session kept real time: every tick's lateness, every picture's age.

use std::fmt;

use kernel::Seat;
use kernel::time::TICK_HZ;
use measures::stats::Spread;
use serde::Serialize;

/// What was measured while driving. Grows by 12 bytes a tick: 2.6 MB an hour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timings {
    /// How late each tick began, microseconds.
    lateness_us: Vec<u32>,
    /// Time driven by the clock, microseconds.
    driven_us: u64,
    /// By how much finished runs fell behind real time, microseconds.
    slowed_us: u64,
    /// From the tick of a frame to its picture on the screen, for each picture of the semantic driver
    /// and of the safety driver, microseconds.
    age_us: [Vec<u32>; 2],
    /// How often samples of sound came too late.
    sound_gaps: u64,
}

/// What a session came to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LiveFigures {
    /// Time driven by the clock, seconds.
    pub seconds: f64,
    /// Ticks driven.
    pub ticks: usize,
    /// 60 when the machine keeps up.
    pub ticks_per_second: f64,
    /// How late ticks began, milliseconds.
    pub lateness_ms: Spread,
    /// By how much simulated time fell behind, seconds. No tick is ever left out.
    pub slowed_s: f64,
    /// Pictures a second on the semantic driver's screen.
    pub semantic_fps: f64,
    /// Pictures a second on the safety driver's screen.
    pub safety_fps: f64,
    /// From the tick of a frame to its mask on the screen, milliseconds.
    pub mask_age_ms: Option<Spread>,
    /// From the tick of a frame to its image on the screen, milliseconds.
    pub image_age_ms: Option<Spread>,
    /// How often samples of what is heard came too late.
    pub sound_gaps: u64,
}

impl Timings {
    /// A tick began so late.
    pub fn tick(&mut self, late_us: u64) {
        self.lateness_us.push(saturated(late_us));
    }

    /// A picture came onto a driver's screen, so long after the tick it shows.
    pub fn shown(&mut self, seat: Seat, age_us: u64) {
        self.age_us[seat as usize].push(saturated(age_us));
    }

    /// So often samples of what is heard came too late.
    pub fn sound(&mut self, gaps: u64) {
        self.sound_gaps += gaps;
    }

    /// A run ended that took so long by the clock and fell so far behind it.
    pub fn run(&mut self, driven_us: u64, slowed_us: u64) {
        self.driven_us += driven_us;
        self.slowed_us += slowed_us;
    }

    /// What it comes to; `None` before the first run has ended.
    pub fn figures(&self) -> Option<LiveFigures> {
        let lateness_ms = spread_ms(&self.lateness_us)?;
        let seconds = self.driven_us as f64 / 1e6;
        let a_second = |count: usize| count as f64 / seconds;
        let [semantic, safety] = &self.age_us;
        (seconds > 0.0).then(|| LiveFigures {
            seconds,
            ticks: self.lateness_us.len(),
            ticks_per_second: a_second(self.lateness_us.len()),
            lateness_ms,
            slowed_s: self.slowed_us as f64 / 1e6,
            semantic_fps: a_second(semantic.len()),
            safety_fps: a_second(safety.len()),
            mask_age_ms: spread_ms(semantic),
            image_age_ms: spread_ms(safety),
            sound_gaps: self.sound_gaps,
        })
    }
}

/// Of times in microseconds, milliseconds.
fn spread_ms(times_us: &[u32]) -> Option<Spread> {
    Spread::of(times_us.iter().map(|us| f64::from(*us) / 1e3).collect())
}

impl fmt::Display for LiveFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seconds, ticks_per_second, lateness_ms, semantic_fps, safety_fps, .. } = self;
        let Spread { median, p999, .. } = lateness_ms;
        write!(f, "real time: {ticks_per_second:.2} ticks/s over {seconds:.0} s ")?;
        write!(f, "(late by {median:.1} ms median, {p999:.1} ms p99.9); {semantic_fps:.1} masks/s")?;
        if let Some(Spread { median, p99, .. }) = self.mask_age_ms {
            write!(f, " of age {median:.0} ms median, {p99:.0} ms p99")?;
        }
        write!(f, "; {safety_fps:.1} images/s")?;
        if self.sound_gaps > 0 { write!(f, "; {} gaps in the sound", self.sound_gaps) } else { Ok(()) }
    }
}

impl LiveFigures {
    /// What speaks against driving at these sizes with this checkpoint, a sentence each.
    pub fn shortfalls(&self) -> Vec<String> {
        let mut said = Vec::new();
        let (tick_hz, lateness) = (f64::from(TICK_HZ), self.lateness_ms.p999);
        if self.slowed_s > 0.0 {
            said.push(format!("simulated time fell behind by {:.2} s in {:.0} s", self.slowed_s, self.seconds));
        } else if lateness > MAX_LATENESS_MS {
            said.push(format!("one tick in a thousand is {lateness:.0} ms late or more, at {tick_hz} ticks a second"));
        }
        for (who, fps) in [("semantic", self.semantic_fps), ("safety", self.safety_fps)] {
            if fps < MIN_FPS {
                said.push(format!("the {who} driver sees {fps:.0} pictures a second, fewer than {MIN_FPS:.0}"));
            }
        }
        if let Some(Spread { median, p99, .. }) = self.mask_age_ms
            && (median > MAX_MASK_AGE_MS || p99 > MAX_MASK_AGE_P99_MS)
        {
            said.push(format!("masks are {median:.0} ms old (99 %: {p99:.0} ms) when they come onto the screen"));
        }
        said
    }
}

/// What a rig should keep: lateness of all ticks but one in a thousand, pictures a second, and the
/// age of masks, median and 99 %.
const MAX_LATENESS_MS: f64 = 50.0;
const MIN_FPS: f64 = 15.0;
const MAX_MASK_AGE_MS: f64 = 120.0;
const MAX_MASK_AGE_P99_MS: f64 = 250.0;

fn saturated(us: u64) -> u32 {
    u32::try_from(us).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_good_minute_has_no_shortfall_and_each_fault_is_said() {
        let minute = |late_us: u64, age_us: u64, frames: usize, slowed_us: u64| {
            let mut timings = Timings::default();
            (0..3600).for_each(|_| timings.tick(late_us));
            for seat in [Seat::Semantic, Seat::Safety] {
                (0..frames).for_each(|_| timings.shown(seat, age_us));
            }
            timings.run(60_000_000, slowed_us);
            timings.figures().expect("a run has ended")
        };
        let good = minute(1_000, 60_000, 1200, 0);
        assert_eq!(
            (good.ticks_per_second, good.safety_fps, good.mask_age_ms.map(|age| age.median)),
            (60.0, 20.0, Some(60.0))
        );
        assert!(good.shortfalls().is_empty());
        let faults = [
            (minute(1_000, 60_000, 1200, 1), "fell behind"),
            (minute(51_000, 60_000, 1200, 0), "late"),
            (minute(1_000, 60_000, 600, 0), "pictures a second"),
            (minute(1_000, 130_000, 1200, 0), "masks are"),
        ];
        for (figures, word) in faults {
            assert!(figures.shortfalls().iter().any(|said| said.contains(word)), "{word}: {figures:?}");
        }
        assert_eq!(Timings::default().figures(), None);
    }
}
