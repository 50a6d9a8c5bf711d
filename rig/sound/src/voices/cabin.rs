//! What is switched on in the car: the relay of the indicators, the wipers, the horn.

use crate::dsp::{Fall, Filter, Glide, Noise, Phase};
use crate::heard::Heard;

/// Flashes a second, of which half is on (UN Regulation 48: 60 to 120 a minute).
const FLASHES_HZ: f32 = 1.5;
/// The relay's clicks when the lamp comes on and goes off, hertz.
const CLICK_HZ: [f32; 2] = [2100.0, 1500.0];
const CLICK: f32 = 0.25;
const CLICK_S: f32 = 0.004;
/// A wipe to one side, seconds, and its sound.
const WIPE_S: f32 = 0.7;
const WIPE: f32 = 0.03;
const WIPE_HZ: f32 = 900.0;
/// The two tones of a horn, hertz, and their overtones.
const HORN_HZ: [f32; 2] = [420.0, 504.0];
const OVERTONES: u8 = 6;
const HORN: f32 = 0.12;
const HORN_S: f32 = 0.015;

#[derive(Clone, Debug)]
pub struct Cabin {
    indicates: bool,
    wipes: bool,
    since_flash_s: f32,
    is_lit: bool,
    click: Fall,
    relay: Filter,
    wiped_s: f32,
    blade: Filter,
    noise: Noise,
    horn: Glide,
    tones: [Phase; HORN_HZ.len()],
}

impl Default for Cabin {
    fn default() -> Self {
        let [relay, blade] = [Filter::default(); 2];
        Self {
            indicates: false,
            wipes: false,
            since_flash_s: 0.0,
            is_lit: false,
            click: Fall::default(),
            relay,
            wiped_s: 0.0,
            blade,
            noise: Noise::new(4),
            horn: Glide::default(),
            tones: Default::default(),
        }
    }
}

impl Cabin {
    pub fn hear(&mut self, heard: &Heard) {
        if heard.indicates && !self.indicates {
            // The first flash comes at once.
            (self.since_flash_s, self.is_lit) = (0.5 / FLASHES_HZ, false);
        }
        (self.indicates, self.wipes) = (heard.indicates, heard.wipes);
        self.horn.set(f32::from(u8::from(heard.horn)));
    }

    pub fn next(&mut self, sample_hz: f32) -> f32 {
        self.relay(sample_hz) + self.wiper(sample_hz) + self.horn(sample_hz)
    }

    fn relay(&mut self, sample_hz: f32) -> f32 {
        self.since_flash_s += 1.0 / sample_hz;
        if (self.indicates || self.is_lit) && self.since_flash_s >= 0.5 / FLASHES_HZ {
            (self.since_flash_s, self.is_lit) = (0.0, !self.is_lit);
            self.click.strike(1.0);
        }
        let struck = self.noise.next() * self.click.next(CLICK_S, sample_hz);
        CLICK * self.relay.next(struck, CLICK_HZ[usize::from(!self.is_lit)], 0.3, sample_hz).band
    }

    /// A wipe that began goes on to its end.
    fn wiper(&mut self, sample_hz: f32) -> f32 {
        if !self.wipes && self.wiped_s == 0.0 {
            return 0.0;
        }
        self.wiped_s += 1.0 / sample_hz;
        let share = self.wiped_s / WIPE_S;
        if share >= 2.0 {
            self.wiped_s = 0.0;
        }
        let moving = (std::f32::consts::PI * share).sin().abs();
        let hz = WIPE_HZ * if share < 1.0 { 1.0 } else { 0.8 };
        WIPE * moving * self.blade.next(self.noise.next(), hz, 0.6, sample_hz).band
    }

    fn horn(&mut self, sample_hz: f32) -> f32 {
        let level = self.horn.next(HORN_S, sample_hz);
        if level < 1e-4 {
            return 0.0;
        }
        let tone = |phase: f32| (1..=OVERTONES).map(|n| (f32::from(n) * phase).sin() / f32::from(n)).sum::<f32>();
        let tones = self.tones.iter_mut().zip(HORN_HZ).map(|(phase, hz)| tone(phase.next(hz, sample_hz)));
        HORN * level * tones.sum::<f32>()
    }
}
