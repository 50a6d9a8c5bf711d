//! Calibrations from the `wheel_config.ini` of CARLA's steering-wheel example.

use super::calibration::{Axis, Buttons, Calibration, Curve};
use super::presets;
use super::source::DeviceInfo;

/// Hats, which the numbering of joystick axes leaves out.
const HATS: std::ops::RangeInclusive<u16> = 0x10..=0x17;
/// Buttons of joysticks, which are numbered before all others.
const FIRST_JOYSTICK_BUTTON: u16 = 0x120;
/// The axes of a G29, when there is no device to look at.
const G29_AXES: [u16; 4] = [0x00, 0x01, 0x02, 0x05];

/// Reads such a file. It numbers the axes and buttons of a device in their order; without a device
/// that of a G29 is meant. What is wrong is said in a sentence that names the line.
pub fn import(text: &str, device: Option<&DeviceInfo>) -> Result<Calibration, String> {
    let numbers = Numbers::read(text)?;
    let axis = |key: &str, from: Axis| {
        let (line, number) = numbers.required(key)?;
        let code = match device {
            Some(device) => device.axes.iter().map(|a| a.code).filter(|c| !HATS.contains(c)).nth(number),
            None => G29_AXES.get(number).copied(),
        };
        let code =
            code.ok_or_else(|| format!("line {line}: {key} is axis {number}, which the device does not have"))?;
        let mut axis = Axis { axis: code, curve: Curve::Carla, dead_zone: 0.0, ..from };
        if let Some(range) = device.and_then(|d| d.axis(code)) {
            presets::fit(&mut axis, range.min, range.max);
        }
        Ok::<_, String>(axis)
    };
    let button = |key: &str| numbers.find(key).map(|(line, number)| button(line, key, number, device)).transpose();
    let g29 = presets::g29();
    let calibration = Calibration {
        device: device.map_or(g29.device, |d| d.name.clone()),
        rotation_deg: g29.rotation_deg,
        used_deg: g29.rotation_deg,
        steering: axis("steering_wheel", g29.steering)?,
        throttle: axis("throttle", g29.throttle)?,
        brake: axis("brake", g29.brake)?,
        buttons: Buttons { hand_brake: button("handbrake")?, reverse: button("reverse")?, ..Buttons::default() },
    };
    calibration.problem().map_or(Ok(calibration), Err)
}

fn button(line: usize, key: &str, number: usize, device: Option<&DeviceInfo>) -> Result<u16, String> {
    let code = match device {
        Some(device) => {
            let (mut first, mut rest): (Vec<u16>, Vec<u16>) =
                device.buttons.iter().partition(|code| **code >= FIRST_JOYSTICK_BUTTON);
            first.sort_unstable();
            rest.sort_unstable();
            first.into_iter().chain(rest).nth(number)
        }
        None => u16::try_from(number).ok().and_then(|n| FIRST_JOYSTICK_BUTTON.checked_add(n)),
    };
    code.ok_or_else(|| format!("line {line}: {key} is button {number}, which the device does not have"))
}

/// As much of a text of the file as a sentence can hold.
fn shown(text: &str) -> String {
    text.chars().take(80).collect()
}

/// The lines of the file: line, key and number.
struct Numbers(Vec<(usize, String, usize)>);

impl Numbers {
    fn read(text: &str) -> Result<Self, String> {
        const KEYS: [&str; 6] = ["steering_wheel", "throttle", "brake", "clutch", "handbrake", "reverse"];
        let mut numbers = Vec::new();
        for (line, content) in (1..).zip(text.lines().map(str::trim)) {
            if content.is_empty() || content.starts_with(['[', '#', ';']) {
                continue;
            }
            let (key, value) = content
                .split_once(['=', ':'])
                .map(|(key, value)| (key.trim().to_lowercase(), value.trim()))
                .ok_or_else(|| format!("line {line}: {:?}, expected KEY = NUMBER", shown(content)))?;
            if !KEYS.contains(&key.as_str()) {
                let (key, keys) = (shown(&key), KEYS.join(", "));
                return Err(format!("line {line}: unknown key {key:?}, expected one of {keys}"));
            }
            let number = value.parse();
            let number = number.map_err(|_| format!("line {line}: {key} is {:?}, expected a number", shown(value)))?;
            numbers.push((line, key, number));
        }
        Ok(Self(numbers))
    }

    fn find(&self, key: &str) -> Option<(usize, usize)> {
        self.0.iter().find(|(_, k, _)| k == key).map(|(line, _, number)| (*line, *number))
    }

    fn required(&self, key: &str) -> Result<(usize, usize), String> {
        self.find(key).ok_or_else(|| format!("{key} is missing"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::testing::device;

    const FILE: &str =
        "[G29 Racing Wheel]\nsteering_wheel = 0\nclutch = 1\nthrottle = 2\nbrake = 3\nhandbrake = 4\nreverse = 5\n";

    #[test]
    fn the_file_of_carla_is_read() {
        let wheel = import(FILE, None).unwrap();
        assert_eq!([wheel.steering, wheel.throttle, wheel.brake].map(|a| a.axis), [0, 2, 5]);
        assert_eq!((wheel.buttons.hand_brake, wheel.buttons.reverse), (Some(0x124), Some(0x125)));
        assert_eq!((wheel.throttle.pressed(255), wheel.brake.pressed(0)), (0.0, 1.0));
        assert!((wheel.steer(49_152) - 0.55_f32.tan()).abs() < 1e-3, "CARLA's curve");
    }

    #[test]
    fn a_device_gives_codes_and_ends() {
        let mut pads = device(0, "/dev/input/event5");
        pads.axes.retain(|a| a.code != 1);
        pads.axes.iter_mut().filter(|a| a.code == 2).for_each(|a| a.max = 1023);
        pads.buttons = vec![0x2c0, 0x120, 0x11, 0x121];
        let wheel = import("steering_wheel=0\nthrottle=1\nbrake=2\nhandbrake=3\n", Some(&pads)).unwrap();
        assert_eq!((wheel.throttle.axis, wheel.throttle.rest, wheel.brake.axis), (2, 1023, 5));
        assert_eq!(wheel.buttons.hand_brake, Some(0x11));
        let beyond = import("steering_wheel=0\nthrottle=1\nbrake=3\n", Some(&pads)).unwrap_err();
        assert_eq!(beyond, "line 3: brake is axis 3, which the device does not have");
    }

    #[test]
    fn nonsense_is_refused_by_line() {
        let said = |from: &str, to: &str| import(&FILE.replacen(from, to, 1), None).unwrap_err();
        assert!(said("clutch = 1", "colour = 1").starts_with("line 3: unknown key \"colour\""));
        assert_eq!(said("brake = 3", "brake = x"), "line 5: brake is \"x\", expected a number");
        assert_eq!(said("throttle = 2\n", ""), "throttle is missing");
        assert!(said("brake = 3", "brake").contains("expected KEY = NUMBER"));
        assert!(said("throttle = 2", "throttle = 0").contains("axis 0 is the wheel's"));
        assert!(said("handbrake = 4", "handbrake = 99999999").contains("does not have"));
    }
}
