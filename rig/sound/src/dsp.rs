//! What voices are made of: values that glide, tones, noise, filters, and envelopes.

use std::f32::consts::{PI, TAU};

/// What is smaller is nothing: numbers that shrink for ever become slow to compute with.
const NOTHING: f32 = 1e-9;

fn audible(value: f32) -> f32 {
    if value.abs() < NOTHING { 0.0 } else { value }
}

/// A value that follows what it is set to, so that nothing clicks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Glide {
    now: f32,
    to: f32,
}

impl Glide {
    /// There from the start.
    pub fn at(value: f32) -> Self {
        Self { now: value, to: value }
    }

    /// Follows this from now on.
    pub fn set(&mut self, to: f32) {
        self.to = to;
    }

    /// What it follows.
    pub fn target(&self) -> f32 {
        self.to
    }

    /// The value one sample later; it goes most of the way in so many seconds.
    pub fn next(&mut self, within_s: f32, sample_hz: f32) -> f32 {
        let missing = self.to - self.now;
        self.now = if missing.abs() < NOTHING {
            self.to
        } else {
            self.now + missing * (1.0 / (within_s * sample_hz)).min(1.0)
        };
        self.now
    }
}

/// A phase that goes on whatever its frequency does.
#[derive(Clone, Copy, Debug, Default)]
pub struct Phase(f32);

impl Phase {
    /// The phase one sample later, radians in [0, 2 pi).
    pub fn next(&mut self, hz: f32, sample_hz: f32) -> f32 {
        self.0 = (self.0 + hz / sample_hz).fract();
        TAU * self.0
    }
}

/// White noise (xorshift, Marsaglia 2003).
#[derive(Clone, Copy, Debug)]
pub struct Noise(u32);

impl Noise {
    /// One of many.
    pub fn new(seed: u32) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9) | 1)
    }

    /// The next sample, [-1, 1].
    pub fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        (self.0 >> 8) as f32 / (1 << 23) as f32 - 1.0
    }
}

/// What a filter lets through.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bands {
    /// What is below its frequency.
    pub low: f32,
    /// What is around it.
    pub band: f32,
    /// What is above it.
    pub high: f32,
}

/// A state-variable filter whose frequency may change with every sample (trapezoidal integration, Simper 2013).
#[derive(Clone, Copy, Debug, Default)]
pub struct Filter {
    first: f32,
    second: f32,
}

impl Filter {
    /// Filters a sample around a frequency; `width` is the damping, 2 wide and near 0 narrow.
    pub fn next(&mut self, sample: f32, hz: f32, width: f32, sample_hz: f32) -> Bands {
        let g = (PI * (hz / sample_hz).min(0.45)).tan();
        let a1 = 1.0 / (1.0 + g * (g + width));
        let (a2, v3) = (g * a1, sample - self.second);
        let band = a1 * self.first + a2 * v3;
        let low = self.second + a2 * self.first + g * a2 * v3;
        self.first = audible(2.0 * band - self.first);
        self.second = audible(2.0 * low - self.second);
        Bands { low, band, high: sample - width * band - low }
    }
}

/// A level that falls after it was struck.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fall(f32);

impl Fall {
    /// Strikes it.
    pub fn strike(&mut self, level: f32) {
        self.0 = self.0.max(level);
    }

    /// The level one sample later, which falls to 37 % in so many seconds.
    pub fn next(&mut self, within_s: f32, sample_hz: f32) -> f32 {
        self.0 = audible(self.0 * (1.0 - 1.0 / (within_s * sample_hz)));
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HZ: f32 = 48_000.0;

    fn power(samples: impl Iterator<Item = f32>) -> f32 {
        let (sum, n) = samples.fold((0.0, 0.0), |(sum, n), s| (sum + s * s, n + 1.0));
        sum / n
    }

    #[test]
    fn a_filter_lets_through_what_is_on_its_side() {
        let through = |tone_hz: f32, pick: fn(Bands) -> f32| {
            let (mut phase, mut filter) = (Phase::default(), Filter::default());
            let all = (0..9600).map(|_| pick(filter.next(phase.next(tone_hz, HZ).sin(), 1000.0, 1.4, HZ)));
            power(all.skip(2400)) / 0.5
        };
        let [below, above] = [100.0, 10_000.0];
        assert!(through(below, |b| b.low) > 0.95 && through(above, |b| b.low) < 0.01);
        assert!(through(above, |b| b.high) > 0.9 && through(below, |b| b.high) < 0.01);
        assert!(through(1000.0, |b| b.band) > 10.0 * through(below, |b| b.band));
    }

    #[test]
    fn noise_has_no_mean_and_repeats_by_its_seed() {
        let of = |seed| {
            let mut noise = Noise::new(seed);
            (0..48_000).map(|_| noise.next()).collect::<Vec<_>>()
        };
        let noise = of(3);
        let mean = noise.iter().sum::<f32>() / noise.len() as f32;
        assert!(mean.abs() < 0.01 && noise.iter().all(|s| s.abs() <= 1.0), "{mean}");
        assert!((power(noise.iter().copied()) - 1.0 / 3.0).abs() < 0.01);
        assert!(of(3) == noise && of(4) != noise);
    }

    #[test]
    fn what_glides_arrives_and_what_is_struck_fades() {
        let mut glide = Glide::default();
        glide.set(2.0);
        let first = glide.next(0.1, HZ);
        let last = (0..48_000).map(|_| glide.next(0.1, HZ)).last().unwrap();
        assert!(first < 0.01 && (last - 2.0).abs() < 1e-3);
        let mut fall = Fall::default();
        fall.strike(1.0);
        let later = (0..4800).map(|_| fall.next(0.1, HZ)).last().unwrap();
        assert!((later - 0.368).abs() < 0.01, "{later}");
    }
}
