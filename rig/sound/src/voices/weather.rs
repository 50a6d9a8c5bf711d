//! Wind around the car, and rain on it.

use crate::dsp::{Fall, Filter, Glide, Noise, Phase};
use crate::heard::Heard;

/// Loudness of the wind of driving at so many m/s; it grows with the square of speed. Weather's own wind counts as so many.
const DRIVING: f32 = 0.12;
const AT_MPS: f32 = 33.0;
const STORM_MPS: f32 = 16.0;
const WIND_HZ: f32 = 160.0;
const WIND_UP_HZ: f32 = 9.0;
/// How wind comes and goes, hertz.
const GUSTS_HZ: [f32; 2] = [0.17, 0.41];
/// Rain: a hiss, and so many drops a second that are heard one by one.
const RAIN: f32 = 0.035;
const RAIN_HZ: f32 = 1800.0;
const DROPS_PER_S: f32 = 60.0;
const DROP: f32 = 0.12;
const DROP_HZ: f32 = 1300.0;
const DROP_S: f32 = 0.006;

const FOLLOWS_S: f32 = 0.25;

#[derive(Clone, Debug)]
pub struct Outside {
    speed_mps: Glide,
    wind: Glide,
    rain: Glide,
    noise: Noise,
    chance: Noise,
    air: Filter,
    hiss: Filter,
    gusts: [Phase; 2],
    drop: Fall,
    splash: Filter,
}

impl Default for Outside {
    fn default() -> Self {
        let [speed_mps, wind, rain] = [Glide::default(); 3];
        let [air, hiss, splash] = [Filter::default(); 3];
        let [noise, chance] = [2, 3].map(Noise::new);
        let (gusts, drop) = Default::default();
        Self { speed_mps, wind, rain, noise, chance, air, hiss, gusts, drop, splash }
    }
}

impl Outside {
    pub fn hear(&mut self, heard: &Heard) {
        self.speed_mps.set(heard.speed_mps);
        self.wind.set(heard.wind);
        self.rain.set(heard.rain);
    }

    pub fn next(&mut self, sample_hz: f32) -> f32 {
        let gusts = self.gusts.iter_mut().zip(GUSTS_HZ).map(|(phase, hz)| phase.next(hz, sample_hz).sin()).sum::<f32>();
        let own_mps = STORM_MPS * self.wind.next(FOLLOWS_S, sample_hz) * (0.6 + 0.2 * gusts);
        let air_mps = self.speed_mps.next(FOLLOWS_S, sample_hz) + own_mps;
        let noise = self.noise.next();
        let loud = (air_mps / AT_MPS) * (air_mps / AT_MPS);
        let wind = self.air.next(noise, WIND_HZ + WIND_UP_HZ * air_mps, 1.0, sample_hz).low;
        let rain = self.rain.next(FOLLOWS_S, sample_hz);
        let hiss = self.hiss.next(noise, RAIN_HZ, 1.4, sample_hz).high;
        if 0.5 * (self.chance.next() + 1.0) * sample_hz < rain * DROPS_PER_S {
            self.drop.strike(1.0);
        }
        let drop = self.drop.next(DROP_S, sample_hz);
        let splash = self.splash.next(noise * drop, DROP_HZ, 0.8, sample_hz).band;
        2.0 * DRIVING * loud * wind + rain * (RAIN * hiss + DROP * splash)
    }
}
