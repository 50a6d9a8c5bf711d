//! What a driver's hands and feet give, as integers.

use crate::{state, state_enum};

state_enum! {
    /// One of the two seats.
    pub enum Seat {
        /// The driver who sees only the predicted mask.
        Semantic = 0,
        /// The driver who sees the real image and always has priority.
        Safety = 1,
    }
}

state! {
    /// The position of one control unit at one tick.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Controls {
        /// Steering wheel, -32767 (full left) to 32767 (full right).
        pub steer: i16,
        /// Accelerator, 0 (released) to 65535 (fully pressed).
        pub throttle: u16,
        /// Brake, 0 (released) to 65535 (fully pressed).
        pub brake: u16,
        /// Bit set of the `Controls::*` flags.
        pub flags: u8,
    }
}

impl Controls {
    /// Hand brake pulled.
    pub const HAND_BRAKE: u8 = 1;
    /// Reverse gear engaged.
    pub const REVERSE: u8 = 2;
    /// The "I see the hazard" button.
    pub const SEEN: u8 = 4;
    /// Indicates to the left.
    pub const INDICATE_LEFT: u8 = 8;
    /// Indicates to the right; together with the left one the hazard lights.
    pub const INDICATE_RIGHT: u8 = 16;
    /// Sounds the horn.
    pub const HORN: u8 = 32;
    /// Headlights on.
    pub const LIGHTS: u8 = 64;
    /// Wipers on.
    pub const WIPERS: u8 = 128;
    /// What belongs to the steering wheel.
    pub const INDICATORS: u8 = Self::INDICATE_LEFT | Self::INDICATE_RIGHT;
    /// What belongs to whoever has the pedals, beside hand brake and gear.
    pub const SIGNALS: u8 = Self::HORN | Self::LIGHTS | Self::WIPERS;
    /// Every flag with a meaning: all bits of a byte.
    pub const ALL_FLAGS: u8 = u8::MAX;

    /// From fractions: steer in [-1, 1] positive to the right, pedals in [0, 1]; values beyond are
    /// clamped and NaN counts as 0.
    pub fn from_fractions(steer: f32, throttle: f32, brake: f32) -> Self {
        let unit = |v: f32, lo: f32| if v.is_nan() { 0.0 } else { v.clamp(lo, 1.0) };
        Self {
            steer: libm::roundf(unit(steer, -1.0) * 32767.0) as i16,
            throttle: libm::roundf(unit(throttle, 0.0) * 65535.0) as u16,
            brake: libm::roundf(unit(brake, 0.0) * 65535.0) as u16,
            flags: 0,
        }
    }

    /// Steering as a fraction, [-1, 1], positive to the right.
    pub fn steer_fraction(&self) -> f32 {
        f32::from(self.steer.max(-32767)) / 32767.0
    }

    /// Accelerator as a fraction, [0, 1].
    pub fn throttle_fraction(&self) -> f32 {
        f32::from(self.throttle) / 65535.0
    }

    /// Brake as a fraction, [0, 1].
    pub fn brake_fraction(&self) -> f32 {
        f32::from(self.brake) / 65535.0
    }

    /// Whether all bits of `flag` are set.
    pub fn has(&self, flag: u8) -> bool {
        self.flags & flag == flag
    }
}

state! {
    /// Everything that enters the world in one tick.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct TickInput {
        /// Controls of the semantic driver.
        pub semantic: Controls,
        /// Controls of the safety driver.
        pub safety: Controls,
    }
}
