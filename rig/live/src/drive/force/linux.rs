//! Force feedback of Linux. The only file that names evdev.

use std::io;

use evdev::{
    Device, FFCondition, FFEffect, FFEffectCode, FFEffectData, FFEffectKind, FFEnvelope, FFReplay, FFTrigger,
    FFWaveform,
};

use super::actuator::Actuator;
use super::effects::Effects;

/// A push or rumble ends by itself after so long, ms, should nobody end it.
const LONGEST_MS: u16 = 1000;
/// Period of the vibration that stands for rumble on wheels, ms.
const RUMBLE_PERIOD_MS: u16 = 40;
/// Directions in the units of Linux: a quarter is 0x4000, counter-clockwise from down; this is right.
const RIGHT: u16 = 0xC000;
const NO_ENVELOPE: FFEnvelope = FFEnvelope { attack_length: 0, attack_level: 0, fade_length: 0, fade_level: 0 };
const NO_FORCE: FFCondition = FFCondition {
    right_saturation: 0,
    left_saturation: 0,
    right_coefficient: 0,
    left_coefficient: 0,
    deadband: 0,
    center: 0,
};

/// The motors of a device.
pub struct Motors {
    device: Device,
    spring: Spring,
    push: Option<Playing>,
    rumble: Option<Playing>,
    now: Effects,
}

/// What pulls the wheel towards its centre: an effect, or what many wheels have built in.
enum Spring {
    None,
    Effect(Playing),
    BuiltIn,
}

/// An effect of the device, uploaded when it is first felt.
struct Playing {
    kind: fn(f32) -> FFEffectKind,
    effect: Option<FFEffect>,
    /// 0: until it is ended.
    longest_ms: u16,
    is_on: bool,
}

impl Motors {
    /// Opens a device that can do at least one of the effects.
    pub fn open(path: &str) -> io::Result<Self> {
        let mut device = Device::open(path)?;
        let codes = device.supported_ff().map(|codes| codes.iter().collect::<Vec<_>>()).unwrap_or_default();
        let has = |code| codes.contains(&code);
        let spring = match (has(FFEffectCode::FF_SPRING), has(FFEffectCode::FF_AUTOCENTER)) {
            (true, _) => Spring::Effect(Playing::new(spring, 0)),
            (false, true) => Spring::BuiltIn,
            (false, false) => Spring::None,
        };
        let push = has(FFEffectCode::FF_CONSTANT).then(|| Playing::new(push, LONGEST_MS));
        let rumble = match (has(FFEffectCode::FF_RUMBLE), has(FFEffectCode::FF_SINE)) {
            (true, _) => Some(Playing::new(rumble, LONGEST_MS)),
            (false, true) => Some(Playing::new(vibration, LONGEST_MS)),
            (false, false) => None,
        };
        if matches!(spring, Spring::None) && push.is_none() && rumble.is_none() {
            return Err(io::Error::new(io::ErrorKind::Unsupported, "the device has none"));
        }
        if has(FFEffectCode::FF_GAIN) {
            device.set_ff_gain(u16::MAX)?;
        }
        if has(FFEffectCode::FF_AUTOCENTER) {
            device.set_ff_autocenter(0)?;
        }
        Ok(Self { device, spring, push, rumble, now: Effects::default() })
    }
}

impl Actuator for Motors {
    fn apply(&mut self, effects: &Effects) -> io::Result<()> {
        let Self { device, spring, push, rumble, now } = self;
        if effects.spring != now.spring {
            match spring {
                Spring::None => {}
                Spring::Effect(playing) => playing.set(device, effects.spring)?,
                Spring::BuiltIn => device.set_ff_autocenter(unsigned(effects.spring))?,
            }
        }
        // These end by themselves, lest they stay should the program hang; each order renews them.
        for (playing, force, before) in [(push, effects.push, now.push), (rumble, effects.rumble, now.rumble)] {
            if let (Some(playing), true) = (playing, force != 0.0 || before != 0.0) {
                playing.set(device, force)?;
            }
        }
        *now = *effects;
        Ok(())
    }
}

impl Playing {
    fn new(kind: fn(f32) -> FFEffectKind, longest_ms: u16) -> Self {
        Self { kind, effect: None, longest_ms, is_on: false }
    }

    fn set(&mut self, device: &mut Device, force: f32) -> io::Result<()> {
        let data = FFEffectData {
            direction: RIGHT,
            trigger: FFTrigger::default(),
            replay: FFReplay { length: self.longest_ms, delay: 0 },
            kind: (self.kind)(force),
        };
        let was_on = std::mem::replace(&mut self.is_on, force != 0.0);
        let goes_on = was_on && self.longest_ms == 0;
        match &mut self.effect {
            Some(effect) if force == 0.0 => effect.stop(),
            Some(effect) if goes_on => effect.update(data),
            Some(effect) => effect.update(data).and_then(|()| effect.play(1)),
            None if force == 0.0 => Ok(()),
            None => self.effect.insert(device.upload_ff_effect(data)?).play(1),
        }
    }
}

fn spring(force: f32) -> FFEffectKind {
    let saturation = unsigned(force);
    let coefficient = signed(force);
    let steering = FFCondition {
        right_saturation: saturation,
        left_saturation: saturation,
        right_coefficient: coefficient,
        left_coefficient: coefficient,
        ..NO_FORCE
    };
    FFEffectKind::Spring { condition: [steering, NO_FORCE] }
}

fn push(force: f32) -> FFEffectKind {
    FFEffectKind::Constant { level: signed(force), envelope: NO_ENVELOPE }
}

fn rumble(force: f32) -> FFEffectKind {
    let magnitude = unsigned(force);
    FFEffectKind::Rumble { strong_magnitude: magnitude, weak_magnitude: magnitude }
}

fn vibration(force: f32) -> FFEffectKind {
    FFEffectKind::Periodic {
        waveform: FFWaveform::Sine,
        period: RUMBLE_PERIOD_MS,
        magnitude: signed(force),
        offset: 0,
        phase: 0,
        envelope: NO_ENVELOPE,
    }
}

fn unsigned(force: f32) -> u16 {
    (force.clamp(0.0, 1.0) * f32::from(u16::MAX)) as u16
}

fn signed(force: f32) -> i16 {
    (force.clamp(-1.0, 1.0) * f32::from(i16::MAX)) as i16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_fill_the_ranges_of_linux_and_no_more() {
        assert_eq!([0.0, 1.0, 2.0, -1.0].map(unsigned), [0, 65_535, 65_535, 0]);
        assert_eq!([0.0, 1.0, -1.0, -9.0].map(signed), [0, 32_767, -32_767, -32_767]);
        assert_eq!(push(-0.5), FFEffectKind::Constant { level: -16_383, envelope: NO_ENVELOPE });
        let FFEffectKind::Spring { condition: [steering, other] } = spring(0.25) else { panic!("a spring") };
        assert_eq!((steering.right_saturation, steering.left_coefficient, other), (16_383, 8_191, NO_FORCE));
    }

    #[test]
    fn what_is_no_device_is_an_error() {
        assert!(Motors::open("/dev/null").is_err());
        assert!(Motors::open("/nonexistent").is_err());
    }
}
