//! What goes through the car: collisions and kerbs.

use crate::dsp::{Fall, Filter, Noise, Phase};
use crate::heard::Cue;

/// A collision is as loud as can be from so many m/s on.
const LOUDEST_MPS: f32 = 10.0;
const CRASH: f32 = 0.9;
const CRASH_S: f32 = 0.22;
const CRASH_HZ: f32 = 700.0;
/// The thud of body or wheel, hertz, at its begin and its end.
const THUD_HZ: [f32; 2] = [45.0, 95.0];
const THUD: f32 = 0.6;
const THUD_S: f32 = 0.12;
const KERB: f32 = 0.5;

#[derive(Clone, Debug)]
pub struct Impacts {
    crash: Fall,
    thud: Fall,
    noise: Noise,
    metal: Filter,
    body: Phase,
}

impl Default for Impacts {
    fn default() -> Self {
        let (crash, thud, metal, body) = Default::default();
        Self { crash, thud, noise: Noise::new(5), metal, body }
    }
}

impl Impacts {
    pub fn hear(&mut self, cues: &[Cue]) {
        for cue in cues {
            match cue {
                Cue::Impact(mps) => {
                    let level = (0.3 + 0.7 * mps / LOUDEST_MPS).min(1.0);
                    self.crash.strike(level);
                    self.thud.strike(level);
                }
                Cue::Kerb => self.thud.strike(KERB),
                Cue::Warning | Cue::Takeover | Cue::Ended => {}
            }
        }
    }

    pub fn next(&mut self, sample_hz: f32) -> f32 {
        let (crash, thud) = (self.crash.next(CRASH_S, sample_hz), self.thud.next(THUD_S, sample_hz));
        let metal = self.metal.next(self.noise.next(), CRASH_HZ, 1.4, sample_hz);
        let hz = THUD_HZ[0] + (THUD_HZ[1] - THUD_HZ[0]) * thud;
        CRASH * crash * (metal.band + 0.4 * metal.low) + THUD * thud * self.body.next(hz, sample_hz).sin()
    }
}
