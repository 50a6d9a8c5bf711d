//! A wheel or gamepad as a control unit: arming, and raw values to controls.

use kernel::Controls;

use super::calibration::Calibration;
use super::keyboard::GEAR_CHANGE_MPS;
use super::switches::Switches;

/// Fraction of a pedal's travel, and of full steering, that arms it.
const PEDAL_MOVED: f32 = 0.5;
const WHEEL_MOVED: f32 = 0.2;
/// Within this of its rest a control counts as released; below every sensible threshold of a takeover.
const RELEASED: f32 = 0.05;

/// What a driver holds, which has other words for the same movements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Make {
    Wheel,
    Gamepad,
}

impl Make {
    /// How steering, throttle and brake are moved, and let go of.
    fn words(self) -> [[&'static str; 2]; 3] {
        match self {
            Self::Wheel => [
                ["turn the wheel", "centre the wheel"],
                ["press the accelerator", "release the accelerator"],
                ["press the brake", "release the brake"],
            ],
            Self::Gamepad => [
                ["move the left stick aside", "let go of the left stick"],
                ["pull the right trigger", "release the right trigger"],
                ["pull the left trigger", "release the left trigger"],
            ],
        }
    }
}

/// A device in a seat. It is armed once the wheel and each pedal have moved and all are released
/// again: pedals report garbage until they are first moved, and a pedal that is down at that moment
/// would act at once.
#[derive(Clone, Debug)]
pub(super) struct DeviceUnit {
    calibration: Calibration,
    make: Make,
    /// Raw values of wheel, accelerator and brake.
    raw: [i32; 3],
    moved: [bool; 3],
    armed: bool,
    pulled: bool,
    seen: bool,
    reverse: bool,
    switches: Switches,
    gear_asked: bool,
    /// "I see it" went down since the last tick.
    seen_asked: bool,
}

impl DeviceUnit {
    /// A device that nobody has touched yet.
    pub fn new(calibration: Calibration, make: Make) -> Self {
        let raw = [calibration.steering.rest, calibration.throttle.rest, calibration.brake.rest];
        Self {
            calibration,
            make,
            raw,
            moved: [false; 3],
            armed: false,
            pulled: false,
            seen: false,
            reverse: false,
            switches: Switches::default(),
            gear_asked: false,
            seen_asked: false,
        }
    }

    /// Forgets where everything stood: the device has to be armed again.
    pub fn disarm(&mut self) {
        *self = Self::new(self.calibration.clone(), self.make);
    }

    /// An axis moved.
    pub fn axis(&mut self, code: u16, value: i32) {
        self.moved_to(code, false, value);
    }

    fn moved_to(&mut self, code: u16, is_button: bool, value: i32) {
        let Calibration { steering, throttle, brake, .. } = &self.calibration;
        for (raw, axis) in self.raw.iter_mut().zip([steering, throttle, brake]) {
            if (axis.axis, axis.button) == (code, is_button) {
                *raw = value;
            }
        }
        let [steer, throttle, brake] = self.fractions();
        self.moved[0] |= steer.abs() >= WHEEL_MOVED;
        self.moved[1] |= throttle >= PEDAL_MOVED;
        self.moved[2] |= brake >= PEDAL_MOVED;
    }

    /// A button went down or up.
    pub fn button(&mut self, code: u16, pressed: bool) {
        let buttons = &self.calibration.buttons;
        let is = |button: Option<u16>| button == Some(code);
        if is(buttons.hand_brake) {
            self.pulled = pressed;
        }
        if is(buttons.seen) {
            self.seen = pressed;
            self.seen_asked |= pressed;
        }
        self.gear_asked |= pressed && is(buttons.reverse);
        for (button, flag) in buttons.switches() {
            if is(button) {
                self.switches.press(flag, pressed);
            }
        }
        self.moved_to(code, true, i32::from(pressed));
    }

    /// Arms the device if it may be armed; true if that happened now.
    pub fn arm(&mut self) -> bool {
        let now = !self.armed && self.to_do().is_empty();
        self.armed |= now;
        now
    }

    /// Whether its controls are its driver's.
    pub fn is_armed(&self) -> bool {
        self.armed
    }

    /// What its driver has still to do before it is armed.
    pub fn to_do(&self) -> Vec<&'static str> {
        if self.armed {
            return Vec::new();
        }
        let parts = self.moved.into_iter().zip(self.fractions()).zip(self.make.words());
        let to_do = parts.filter_map(|((moved, fraction), [move_it, release_it])| {
            let is_released = fraction.abs() <= RELEASED;
            (!moved).then_some(move_it).or((!is_released).then_some(release_it))
        });
        to_do.collect()
    }

    /// Gear D.
    pub fn engage_forward(&mut self) {
        (self.reverse, self.gear_asked) = (false, false);
    }

    /// The controls of the next tick, once it is armed.
    pub fn tick(&mut self, speed_mps: f32) -> Option<Controls> {
        let gear_asked = std::mem::take(&mut self.gear_asked);
        let seen = std::mem::take(&mut self.seen_asked) || self.seen;
        if !self.armed {
            return None;
        }
        self.reverse ^= gear_asked && speed_mps.abs() < GEAR_CHANGE_MPS;
        let [steer, throttle, brake] = self.fractions();
        let mut controls = Controls::from_fractions(steer, throttle, brake);
        for (on, flag) in
            [(self.pulled, Controls::HAND_BRAKE), (self.reverse, Controls::REVERSE), (seen, Controls::SEEN)]
        {
            controls.flags |= if on { flag } else { 0 };
        }
        controls.flags |= self.switches.tick(steer);
        Some(controls)
    }

    fn fractions(&self) -> [f32; 3] {
        let Calibration { throttle, brake, .. } = &self.calibration;
        [self.calibration.steer(self.raw[0]), throttle.pressed(self.raw[1]), brake.pressed(self.raw[2])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::presets::g29;
    use proptest::prelude::*;

    /// Codes of the G29's wheel, accelerator and brake.
    const AXES: [u16; 3] = [0, 2, 5];

    #[test]
    fn it_is_armed_when_all_has_moved_and_is_released() {
        let mut unit = DeviceUnit::new(g29(), Make::Wheel);
        assert_eq!(unit.to_do(), ["turn the wheel", "press the accelerator", "press the brake"]);
        for (code, value) in [(0, 0), (2, 0), (5, 0)] {
            unit.axis(code, value);
            assert!(!unit.arm() && unit.tick(0.0).is_none());
        }
        assert_eq!(unit.to_do(), ["centre the wheel", "release the accelerator", "release the brake"]);
        for (code, value) in [(0, 32_768), (2, 255)] {
            unit.axis(code, value);
            assert!(!unit.arm());
        }
        unit.axis(5, 255);
        assert!(unit.arm() && !unit.arm(), "it is armed once");
        unit.axis(2, 0);
        assert_eq!(unit.tick(0.0).map(|c| c.throttle), Some(65_535));
        unit.disarm();
        assert_eq!((unit.tick(0.0), unit.to_do().len()), (None, 3));
    }

    #[test]
    fn buttons_have_their_meaning() {
        let mut unit = armed();
        unit.button(0x120, true);
        unit.button(0x122, true);
        unit.button(0x121, true);
        assert_eq!(unit.tick(9.0).map(|c| c.flags), Some(Controls::HAND_BRAKE | Controls::SEEN));
        assert_eq!(unit.tick(0.0).map(|c| c.flags & Controls::REVERSE), Some(0), "asked at speed, and forgotten");
        unit.button(0x121, true);
        assert_eq!(unit.tick(0.0).map(|c| c.flags & Controls::REVERSE), Some(Controls::REVERSE));
    }

    #[test]
    fn a_wheel_has_buttons_for_indicators_horn_lights_and_wipers() {
        let mut unit = armed();
        let buttons = [0x125, 0x123, 0x128, 0x129];
        buttons.into_iter().for_each(|code| unit.button(code, true));
        let all = Controls::INDICATE_LEFT | Controls::SIGNALS;
        assert_eq!(unit.tick(9.0).map(|c| c.flags), Some(all));
        buttons.into_iter().for_each(|code| unit.button(code, false));
        unit.button(0x124, true);
        assert_eq!(
            unit.tick(9.0).map(|c| c.flags),
            Some(all & !Controls::INDICATE_LEFT & !Controls::HORN | Controls::INDICATE_RIGHT)
        );
    }

    fn armed() -> DeviceUnit {
        let mut unit = DeviceUnit::new(g29(), Make::Wheel);
        for (code, value) in [(0, 0), (2, 0), (5, 0), (0, 32_768), (2, 255), (5, 255)] {
            unit.axis(code, value);
        }
        assert!(unit.arm());
        unit
    }

    proptest! {
        #[test]
        fn any_raw_events_give_controls_in_range(
            events in prop::collection::vec((0usize..4, any::<i32>(), 0x11f_u16..0x12a, any::<bool>(), -20.0f32..20.0), 1..80),
        ) {
            let mut unit = armed();
            for (kind, value, button, pressed, speed_mps) in events {
                match AXES.get(kind) {
                    Some(code) => unit.axis(*code, value),
                    None => unit.button(button, pressed),
                }
                unit.arm();
                let controls = unit.tick(speed_mps).expect("it stays armed");
                prop_assert!(controls.steer >= -32_767);
            }
        }
    }
}
