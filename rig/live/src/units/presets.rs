//! Calibrations of wheels that many people have, and one for all gamepads whose layout is known. The
//! axes of a device that is there bring their own ends.

use super::calibration::{Axis, Buttons, Calibration, Curve};
use super::layout::{Layout, Trigger};
use super::source::DeviceInfo;

// Codes of axes and buttons in the Linux kernel.
const ABS_X: u16 = 0x00;
const ABS_Y: u16 = 0x01;
const ABS_Z: u16 = 0x02;
const ABS_RZ: u16 = 0x05;
const BTN_TRIGGER: u16 = 0x120;
const BTN_THUMB: u16 = 0x121;
const BTN_THUMB2: u16 = 0x122;

/// Dead zone of a stick, which never rests exactly.
const STICK_DEAD_ZONE: f32 = 0.12;

/// A wheel by its USB numbers.
type Preset = (u16, u16, fn() -> Calibration);

const WHEELS: [Preset; 4] =
    [(0x046d, 0xc24f, g29), (0x046d, 0xc262, g920), (0x044f, 0xb677, t150), (0x044f, 0xb66e, t300)];

/// Logitech G29.
pub fn g29() -> Calibration {
    let wheel = wheel("Logitech G29 Driving Force Racing Wheel", 900.0, 255, ABS_Z, ABS_RZ);
    // Paddles, triangle, share and options.
    with_switches(wheel, [0x125, 0x124, 0x123, 0x128, 0x129])
}

/// Logitech G920.
pub fn g920() -> Calibration {
    let wheel = wheel("Logitech G920 Driving Force Racing Wheel", 900.0, 255, ABS_Y, ABS_Z);
    // Paddles, Y, menu and view.
    with_switches(wheel, [0x125, 0x124, 0x123, 0x126, 0x127])
}

/// Thrustmaster T150.
pub fn t150() -> Calibration {
    wheel("Thrustmaster T150RS", 1080.0, 1023, ABS_RZ, ABS_Y)
}

/// Thrustmaster T300.
pub fn t300() -> Calibration {
    wheel("Thrustmaster T300RS Racing wheel", 1080.0, 1023, ABS_Z, ABS_RZ)
}

/// Any gamepad: the left stick steers, the triggers are the pedals.
pub fn gamepad(layout: &Layout) -> Calibration {
    let axis = |axis, rest| Axis { button: false, max: 255, rest, ..Axis::of_button(axis) };
    let pedal = |trigger| match trigger {
        Trigger::Axis(code) => axis(code, 0),
        Trigger::Button(code) => Axis::of_button(code),
    };
    Calibration {
        device: "gamepad".into(),
        rotation_deg: 90.0,
        used_deg: 90.0,
        steering: Axis { dead_zone: STICK_DEAD_ZONE, curve: Curve::Square, ..axis(layout.left_stick_x, 128) },
        throttle: pedal(layout.right_trigger),
        brake: pedal(layout.left_trigger),
        buttons: Buttons {
            hand_brake: layout.south,
            reverse: layout.east,
            seen: layout.west,
            indicate_left: layout.shoulders[0],
            indicate_right: layout.shoulders[1],
            horn: layout.north,
            lights: layout.middle[1],
            wipers: layout.middle[0],
        },
    }
}

/// The same wheel with these buttons for the indicators (left, right), horn, lights and wipers.
fn with_switches(mut wheel: Calibration, buttons: [u16; 5]) -> Calibration {
    let [indicate_left, indicate_right, horn, lights, wipers] = buttons.map(Some);
    wheel.buttons = Buttons { indicate_left, indicate_right, horn, lights, wipers, ..wheel.buttons };
    wheel
}

/// A wheel whose pedals give their greatest value when released, as all of these do.
fn wheel(device: &str, rotation_deg: f32, pedal_max: i32, throttle: u16, brake: u16) -> Calibration {
    let pedal = |axis| Axis {
        axis,
        button: false,
        min: 0,
        rest: pedal_max,
        max: pedal_max,
        invert: true,
        dead_zone: 0.02,
        curve: Curve::Linear,
    };
    Calibration {
        device: device.into(),
        rotation_deg,
        used_deg: 540.0,
        steering: Axis { rest: 32_768, max: 65_535, invert: false, dead_zone: 0.0, ..pedal(ABS_X) },
        throttle: pedal(throttle),
        brake: pedal(brake),
        buttons: Buttons {
            hand_brake: Some(BTN_TRIGGER),
            reverse: Some(BTN_THUMB),
            seen: Some(BTN_THUMB2),
            ..Buttons::default()
        },
    }
}

/// The calibration of a device that nobody has calibrated: its preset, or that of a gamepad. `None`
/// when it is neither, or lacks one of the axes.
pub fn preset(device: &DeviceInfo) -> Option<Calibration> {
    let mut calibration = match known_wheel(device) {
        Some((_, _, wheel)) => wheel(),
        None => gamepad(device.layout.as_ref()?),
    };
    calibration.device.clone_from(&device.name);
    let Calibration { steering, throttle, brake, .. } = &mut calibration;
    for axis in [steering, throttle, brake].into_iter().filter(|axis| !axis.button) {
        let range = device.axis(axis.axis)?;
        fit(axis, range.min, range.max);
    }
    calibration.problem().is_none().then_some(calibration)
}

/// Whether a device is a wheel that has a preset of its own.
pub fn is_known_wheel(device: &DeviceInfo) -> bool {
    known_wheel(device).is_some()
}

fn known_wheel(device: &DeviceInfo) -> Option<&'static Preset> {
    WHEELS.iter().find(|(vendor, product, _)| (*vendor, *product) == (device.vendor, device.product))
}

/// Gives an axis other ends; its rest stays at the same end or in the middle.
pub(super) fn fit(axis: &mut Axis, min: i32, max: i32) {
    axis.rest = if axis.rest == axis.min {
        min
    } else if axis.rest == axis.max {
        max
    } else {
        // Of an even number of values the middle is the upper one, as the kernel centres wheels.
        ((i64::from(min) + i64::from(max) + 1) / 2) as i32
    };
    (axis.min, axis.max) = (min, max);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::testing::{LAYOUT, device};

    #[test]
    fn every_preset_is_sound() {
        for calibration in [g29(), g920(), t150(), t300(), gamepad(&LAYOUT)] {
            assert_eq!(calibration.problem(), None, "{}", calibration.device);
            let text = calibration.to_toml().unwrap();
            assert_eq!(Calibration::from_toml(&text), Ok(calibration));
        }
    }

    #[test]
    fn a_known_wheel_is_recognised_and_takes_the_ends_of_the_device() {
        let mut wheel = device(0, "/dev/input/event5");
        (wheel.vendor, wheel.product) = (0x046d, 0xc24f);
        wheel.axes.iter_mut().find(|a| a.code == ABS_RZ).unwrap().max = 1023;
        let calibration = preset(&wheel).unwrap();
        assert_eq!((calibration.brake.rest, calibration.throttle.rest), (1023, 255));
        assert_eq!(calibration.brake.pressed(0), 1.0);
    }

    #[test]
    fn a_known_wheel_is_no_gamepad_whatever_its_layout() {
        let mut wheel = device(0, "/dev/input/event5");
        (wheel.vendor, wheel.product) = (0x046d, 0xc24f);
        assert!(wheel.layout.is_some());
        assert_eq!(preset(&wheel).unwrap().rotation_deg, 900.0);
    }

    #[test]
    fn a_gamepad_is_read_by_its_layout() {
        let mut pad = device(0, "/dev/input/event5");
        let brake = Trigger::Button(0x136);
        pad.layout = Some(Layout { left_stick_x: 5, right_trigger: Trigger::Axis(1), left_trigger: brake, ..LAYOUT });
        let calibration = preset(&pad).unwrap();
        assert_eq!((calibration.steering.axis, calibration.steering.rest), (5, 128));
        assert_eq!((calibration.throttle.axis, calibration.throttle.rest, calibration.throttle.max), (1, 0, 255));
        assert_eq!(calibration.brake, Axis::of_button(0x136));
        assert_eq!(calibration.buttons.hand_brake, Some(0x130));
    }

    #[test]
    fn a_device_without_the_axes_or_a_layout_has_no_preset() {
        let mut pedals = device(0, "/dev/input/event5");
        assert_eq!(preset(&pedals).unwrap().steering.dead_zone, STICK_DEAD_ZONE);
        pedals.axes.retain(|a| a.code != ABS_X);
        assert_eq!(preset(&pedals), None);
        let unknown = DeviceInfo { layout: None, ..device(0, "/dev/input/event5") };
        assert_eq!(preset(&unknown), None);
    }
}
