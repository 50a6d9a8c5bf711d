//! Finds out what the axes and buttons of a device mean by asking its driver to move them.

use std::collections::BTreeMap;

use anyhow::{Context, bail, ensure};

use super::calibration::{Axis, Buttons, Calibration, Curve};
use super::source::{DeviceInfo, InputSource, RawEvent};

/// Least part of an axis's travel that counts as moved on purpose.
const MOVED: f64 = 0.3;
/// Dead zone of pedals, which seldom come back to the very end.
const PEDAL_DEAD_ZONE: f32 = 0.02;

/// Whom the wizard asks.
pub trait Console {
    /// Shows a question and gives the line that answers it. `meanwhile` must be called again and
    /// again until there is an answer.
    fn ask(&mut self, question: &str, meanwhile: &mut dyn FnMut()) -> anyhow::Result<String>;
}

/// Asks for every movement and gives the calibration of the device.
pub fn calibrate(
    source: &mut dyn InputSource,
    device: &DeviceInfo,
    console: &mut dyn Console,
) -> anyhow::Result<Calibration> {
    let mut wizard = Wizard { source, device, console, axes: BTreeMap::new(), button: None };
    wizard.ask("Move the wheel and each pedal once through their whole travel, release all, and press Enter.")?;
    let rest = wizard.values();
    wizard.ask("Turn the wheel to the left, hold it there, and press Enter.")?;
    let mut steering = wizard.moved(&rest, None)?;
    // What was found is where "left" is.
    steering.invert = !steering.invert;
    let throttle = wizard.pedal("accelerator", &rest, &steering)?;
    let brake = wizard.pedal("brake", &rest, &steering)?;
    let calibration = Calibration {
        device: device.name.clone(),
        rotation_deg: wizard.number("How many degrees does the wheel turn from stop to stop?", 900.0)?,
        used_deg: wizard.number("How many of them are to be full steering, from left to right?", 540.0)?,
        steering,
        throttle,
        brake,
        buttons: Buttons {
            hand_brake: wizard.button("the hand brake")?,
            reverse: wizard.button("changing into reverse and back")?,
            seen: wizard.button("\"I see the hazard\"")?,
            indicate_left: wizard.button("the left indicator")?,
            indicate_right: wizard.button("the right indicator")?,
            horn: wizard.button("the horn")?,
            lights: wizard.button("the headlights")?,
            wipers: wizard.button("the wipers")?,
        },
    };
    if let Some(problem) = calibration.problem() {
        bail!("{problem}; calibrate again and follow each step");
    }
    Ok(calibration)
}

/// Raw values that an axis has had.
#[derive(Clone, Copy)]
struct Seen {
    min: i32,
    max: i32,
    now: i32,
}

struct Wizard<'a> {
    source: &'a mut dyn InputSource,
    device: &'a DeviceInfo,
    console: &'a mut dyn Console,
    axes: BTreeMap<u16, Seen>,
    button: Option<u16>,
}

impl Wizard<'_> {
    fn ask(&mut self, question: &str) -> anyhow::Result<String> {
        let Self { source, device, console, axes, button } = self;
        let mut lost = false;
        let mut listen = || {
            while let Some(event) = source.next_event() {
                match event {
                    RawEvent::Axis { device: id, code, value } if id == device.id => {
                        let seen = axes.entry(code).or_insert(Seen { min: value, max: value, now: value });
                        *seen = Seen { min: seen.min.min(value), max: seen.max.max(value), now: value };
                    }
                    RawEvent::Button { device: id, code, pressed: true } if id == device.id => *button = Some(code),
                    RawEvent::Lost(id) => lost |= id == device.id,
                    _ => {}
                }
            }
        };
        let answer = console.ask(question, &mut listen)?;
        listen();
        ensure!(!lost, "{}: was unplugged", device.name);
        Ok(answer)
    }

    fn values(&self) -> BTreeMap<u16, i32> {
        self.axes.iter().map(|(code, seen)| (*code, seen.now)).collect()
    }

    /// The axis that is farthest from its rest now, inverted if it is held towards its least value.
    fn moved(&self, rest: &BTreeMap<u16, i32>, except: Option<u16>) -> anyhow::Result<Axis> {
        let far = |(code, seen): (&u16, &Seen)| {
            let rest = *rest.get(code)?;
            let travel = f64::from(seen.max) - f64::from(seen.min);
            let moved = f64::from(seen.now) - f64::from(rest);
            let axis = Axis {
                axis: *code,
                button: false,
                min: seen.min,
                rest,
                max: seen.max,
                invert: moved < 0.0,
                dead_zone: 0.0,
                curve: Curve::Linear,
            };
            (travel > 0.0).then(|| (moved.abs() / travel, axis))
        };
        let others = self.axes.iter().filter(|(code, _)| Some(**code) != except);
        let farthest = others.filter_map(far).max_by(|a, b| a.0.total_cmp(&b.0));
        let (_, axis) = farthest
            .filter(|(moved, _)| *moved >= MOVED)
            .with_context(|| format!("{}: nothing moved; calibrate again and follow each step", self.device.name))?;
        Ok(axis)
    }

    fn pedal(&mut self, name: &str, rest: &BTreeMap<u16, i32>, steering: &Axis) -> anyhow::Result<Axis> {
        self.ask(&format!("Press the {name} fully, hold it there, and press Enter."))?;
        let axis = self.moved(rest, Some(steering.axis))?;
        Ok(Axis { dead_zone: PEDAL_DEAD_ZONE, ..axis })
    }

    fn number(&mut self, question: &str, usual: f32) -> anyhow::Result<f32> {
        let answer = self.ask(&format!("{question} [{usual}]"))?;
        match answer.trim() {
            "" => Ok(usual),
            text => text.parse().with_context(|| format!("{text:?}: expected a number of degrees")),
        }
    }

    fn button(&mut self, name: &str) -> anyhow::Result<Option<u16>> {
        self.button = None;
        self.ask(&format!("Press the button for {name}, then Enter; Enter alone for none."))?;
        Ok(self.button)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::source::Simulated;
    use crate::units::testing::device;

    /// Answers with prepared lines, moving the device before each.
    struct Script<'a>(&'a Simulated, std::vec::IntoIter<(Vec<(u16, i32)>, &'static str)>);

    impl Console for Script<'_> {
        fn ask(&mut self, question: &str, meanwhile: &mut dyn FnMut()) -> anyhow::Result<String> {
            let (moves, answer) = self.1.next().with_context(|| format!("no answer to {question}"))?;
            for (code, value) in moves {
                let axis = RawEvent::Axis { device: 0, code, value };
                let button = RawEvent::Button { device: 0, code, pressed: value > 0 };
                self.0.push(if code < 0x100 { axis } else { button });
                meanwhile();
            }
            Ok(answer.to_owned())
        }
    }

    fn run(answers: Vec<(Vec<(u16, i32)>, &'static str)>) -> anyhow::Result<Calibration> {
        let mut devices = Simulated::default();
        let handle = devices.clone();
        calibrate(&mut devices, &device(0, "/dev/input/event5"), &mut Script(&handle, answers.into_iter()))
    }

    /// Wheel, accelerator and brake of a G29 through their travel, and back to rest.
    fn travel() -> Vec<(u16, i32)> {
        vec![(0, 0), (0, 65_535), (0, 32_700), (2, 0), (2, 255), (5, 0), (5, 255)]
    }

    #[test]
    fn a_wheel_is_found_out_by_moving_it() {
        let answers = vec![
            (travel(), ""),
            (vec![(0, 100)], ""),
            (vec![(0, 32_900), (2, 5)], ""),
            (vec![(2, 254), (5, 0)], ""),
            (vec![(5, 255)], "1080"),
            (vec![], ""),
            (vec![(0x121, 1), (0x121, 0)], ""),
            (vec![], ""),
            (vec![(0x123, 1)], ""),
            (vec![(0x125, 1)], ""),
            (vec![(0x124, 1)], ""),
            (vec![(0x126, 1)], ""),
            (vec![], ""),
            (vec![(0x128, 1)], ""),
        ];
        let wheel = run(answers).unwrap();
        assert_eq!([wheel.steering, wheel.throttle, wheel.brake].map(|a| a.axis), [0, 2, 5]);
        assert_eq!((wheel.rotation_deg, wheel.used_deg), (1080.0, 540.0));
        assert_eq!([0, 32_700, 65_535].map(|raw| wheel.steer(raw)), [-1.0, 0.0, 1.0]);
        assert_eq!((wheel.throttle.pressed(255), wheel.throttle.pressed(0), wheel.brake.pressed(0)), (0.0, 1.0, 1.0));
        let buttons = Buttons {
            hand_brake: Some(0x121),
            reverse: None,
            seen: Some(0x123),
            indicate_left: Some(0x125),
            indicate_right: Some(0x124),
            horn: Some(0x126),
            lights: None,
            wipers: Some(0x128),
        };
        assert_eq!(wheel.buttons, buttons);
    }

    #[test]
    fn a_driver_who_moves_nothing_is_told() {
        let said = run(vec![(travel(), ""), (vec![], "")]).unwrap_err().to_string();
        assert!(said.contains("nothing moved"), "{said}");
    }

    #[test]
    fn combined_pedals_are_found_on_one_axis() {
        let both = vec![(0, 0), (0, 65_535), (0, 32_700), (1, 0), (1, 255), (1, 128)];
        let pedals = [(vec![(0, 32_700), (1, 0)], ""), (vec![(1, 255)], "")];
        let mut answers = vec![(both, ""), (vec![(0, 100)], "")];
        answers.extend(pedals);
        answers.extend((0..10).map(|_| (vec![], "")));
        let wheel = run(answers).unwrap();
        assert_eq!((wheel.throttle.axis, wheel.brake.axis), (1, 1));
        assert_eq!((wheel.throttle.pressed(0), wheel.brake.pressed(0)), (1.0, 0.0));
    }
}
