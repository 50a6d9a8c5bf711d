//! Tyres: they roll, hiss on water, and squeal at the limit of their grip.

use crate::dsp::{Filter, Glide, Noise, Phase};
use crate::heard::Heard;

/// Loudness of rolling at so many m/s; it grows with the power 1.5 of speed (about 30 dB a decade of power).
const ROLLING: f32 = 0.1;
const AT_MPS: f32 = 14.0;
/// Where rolling sounds, hertz, and how much higher for each m/s.
const ROLLING_HZ: f32 = 220.0;
const ROLLING_UP_HZ: f32 = 12.0;
/// Hiss of water.
const HISS: f32 = 0.06;
const HISS_HZ: f32 = 2800.0;
/// Tyres squeal from so many m/s^2 on, fully at so many more.
const SQUEALS_FROM_MPS2: f32 = 5.5;
const SQUEALS_WITHIN_MPS2: f32 = 2.5;
const SQUEAL: f32 = 0.08;
const SQUEAL_HZ: f32 = 760.0;

const FOLLOWS_S: f32 = 0.06;

#[derive(Clone, Debug)]
pub struct Road {
    speed_mps: Glide,
    wet: Glide,
    squeal: Glide,
    noise: Noise,
    rolling: Filter,
    hiss: Filter,
    phase: Phase,
    wobble: Phase,
}

impl Default for Road {
    fn default() -> Self {
        let [speed_mps, wet, squeal] = [Glide::default(); 3];
        let [rolling, hiss] = [Filter::default(); 2];
        let [phase, wobble] = [Phase::default(); 2];
        Self { speed_mps, wet, squeal, noise: Noise::new(1), rolling, hiss, phase, wobble }
    }
}

impl Road {
    pub fn hear(&mut self, heard: &Heard) {
        self.speed_mps.set(heard.speed_mps);
        self.wet.set(heard.wet);
        let squeals = ((heard.grip_mps2 - SQUEALS_FROM_MPS2) / SQUEALS_WITHIN_MPS2).clamp(0.0, 1.0);
        // Water squeals less.
        self.squeal.set(squeals * (1.0 - 0.8 * heard.wet) * heard.speed_mps.min(1.0));
    }

    pub fn next(&mut self, sample_hz: f32) -> f32 {
        let speed_mps = self.speed_mps.next(FOLLOWS_S, sample_hz);
        let loud = (speed_mps / AT_MPS).powf(1.5);
        let noise = self.noise.next();
        let rolling = self.rolling.next(noise, ROLLING_HZ + ROLLING_UP_HZ * speed_mps, 1.2, sample_hz).band;
        let hiss = self.hiss.next(noise, HISS_HZ, 1.4, sample_hz).high * self.wet.next(FOLLOWS_S, sample_hz);
        let wobble = self.wobble.next(23.0, sample_hz).sin();
        let squeal = self.phase.next(SQUEAL_HZ + 30.0 * wobble, sample_hz).sin();
        let squeals = self.squeal.next(FOLLOWS_S, sample_hz);
        loud * (ROLLING * rolling + HISS * hiss) + SQUEAL * squeals * squeal * (1.0 + 0.3 * wobble)
    }
}
