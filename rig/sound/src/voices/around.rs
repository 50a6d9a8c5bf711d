//! Other road users: louder the nearer, from their side, and higher while they come nearer (Doppler).

use crate::dsp::{Filter, Glide, Noise, Phase};
use crate::heard::{Around, Size};

/// Speed of sound, m/s.
const SOUND_MPS: f32 = 343.0;
/// As loud as it gets from so near on, metres.
const NEAREST_M: f32 = 3.0;
/// Loudness of rolling and motor at so many m/s in a distance of [`NEAREST_M`].
const LEVEL: f32 = 0.16;
const AT_MPS: f32 = 14.0;
/// A motor that idles, as a share of that.
const IDLE: f32 = 0.12;
/// What is behind sounds duller, as a share of the frequencies.
const BEHIND: f32 = 0.6;
/// Who is no longer heard fades within this, and places follow within it, seconds.
const FOLLOWS_S: f32 = 0.08;
/// Fainter than this nobody is heard.
const SILENT: f32 = 1e-4;

/// Hertz of a motor without and for each m/s, of the tyres, and loudness.
fn timbre(size: Size) -> (f32, f32, f32, f32) {
    match size {
        Size::Bicycle => (0.0, 0.0, 900.0, 0.15),
        Size::Light => (55.0, 6.0, 420.0, 1.0),
        Size::Heavy => (32.0, 4.0, 260.0, 1.8),
    }
}

/// Everybody who is heard.
#[derive(Clone, Debug, Default)]
pub struct Others(Vec<Voice>);

impl Others {
    pub fn hear(&mut self, around: &[Around]) {
        self.0.iter_mut().for_each(|voice| voice.level.set(0.0));
        for other in around {
            let known = self.0.iter_mut().find(|voice| voice.id == other.id);
            match known {
                Some(voice) => voice.hear(other),
                None => {
                    let mut voice = Voice::new(other.id);
                    voice.hear(other);
                    self.0.push(voice);
                }
            }
        }
    }

    #[cfg(test)]
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The next sample on the left and on the right.
    pub fn next(&mut self, sample_hz: f32) -> [f32; 2] {
        let sum = self.0.iter_mut().fold([0.0; 2], |[left, right], voice| {
            let [l, r] = voice.next(sample_hz);
            [left + l, right + r]
        });
        self.0.retain(|voice| !voice.is_over);
        sum
    }
}

#[derive(Clone, Debug)]
struct Voice {
    id: u32,
    size: Size,
    level: Glide,
    /// 0 left, 1 right.
    side: Glide,
    speed_mps: Glide,
    /// By how much it sounds higher.
    higher: Glide,
    /// By how much it is duller.
    dull: Glide,
    noise: Noise,
    tyres: Filter,
    motor: Phase,
    has_sounded: bool,
    is_over: bool,
}

impl Voice {
    fn new(id: u32) -> Self {
        let [level, side, speed_mps, higher, dull] = [Glide::default(); 5];
        let (tyres, motor) = Default::default();
        Self {
            id,
            size: Size::Light,
            level,
            side,
            speed_mps,
            higher,
            dull,
            noise: Noise::new(id.wrapping_add(100)),
            tyres,
            motor,
            has_sounded: false,
            is_over: false,
        }
    }

    fn hear(&mut self, other: &Around) {
        self.size = other.size;
        let distance_m = other.forward_m.hypot(other.left_m).max(0.1);
        let moving = IDLE + (other.speed_mps / AT_MPS).powf(1.2);
        let idles = if other.size == Size::Bicycle { moving - IDLE } else { moving };
        self.level.set(LEVEL * timbre(other.size).3 * idles * NEAREST_M / distance_m.max(NEAREST_M));
        self.side.set(0.5 - 0.5 * other.left_m / distance_m);
        self.speed_mps.set(other.speed_mps);
        self.higher.set(SOUND_MPS / (SOUND_MPS - other.closing_mps.clamp(-100.0, 100.0)));
        self.dull.set(if other.forward_m < 0.0 { BEHIND } else { 1.0 });
    }

    fn next(&mut self, sample_hz: f32) -> [f32; 2] {
        // It is where it is from its first sample on, and comes into hearing from silence.
        let within_s = if self.has_sounded { FOLLOWS_S } else { 1.0 / sample_hz };
        self.has_sounded = true;
        let values = [&mut self.side, &mut self.speed_mps, &mut self.higher, &mut self.dull];
        let [side, speed_mps, higher, dull] = values.map(|value| value.next(within_s, sample_hz));
        let level = self.level.next(FOLLOWS_S, sample_hz);
        self.is_over = level < SILENT && self.level.target() < SILENT;
        let (idle_hz, up_hz, tyres_hz, _) = timbre(self.size);
        let tyres_hz = tyres_hz * higher * dull;
        let tyres = self.tyres.next(self.noise.next(), tyres_hz, 1.0, sample_hz).band;
        let phase = self.motor.next((idle_hz + up_hz * speed_mps) * higher, sample_hz);
        let motor =
            if idle_hz > 0.0 { phase.sin() + 0.5 * (2.0 * phase).sin() + 0.3 * (4.0 * phase).sin() } else { 0.0 };
        let sample = level * (tyres + 0.35 * dull * motor);
        // As loud in the middle as at the sides.
        let angle_rad = std::f32::consts::FRAC_PI_2 * side;
        [sample * angle_rad.cos(), sample * angle_rad.sin()]
    }
}
