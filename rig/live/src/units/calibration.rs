//! What the raw values of a device mean.

use std::path::Path;

use anyhow::anyhow;
use base::files::{self, most};
use base::json::Typed;
use base::toml_text;
use kernel::Controls;
use serde::{Deserialize, Serialize};

/// How a fraction of the travel becomes a fraction of the control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Curve {
    /// In proportion.
    #[default]
    Linear,
    /// With the square: fine near the rest position.
    Square,
    /// As CARLA's steering-wheel example.
    Carla,
    /// As CARLA's, with the steering less direct.
    CarlaGentle,
}

impl Curve {
    /// Of the wheel, from 0 to 1 on either side.
    fn steering(self, x: f64) -> f64 {
        match self {
            Self::Linear => x,
            Self::Square => x * x,
            Self::Carla => (1.1 * x).tan(),
            Self::CarlaGentle => (0.8 * x).tan(),
        }
    }

    /// Of a pedal, from 0 to 1. CARLA's formula is of a = 1 (released) to -1.
    fn pedal(self, x: f64) -> f64 {
        match self {
            Self::Linear => x,
            Self::Square => x * x,
            Self::Carla | Self::CarlaGentle => {
                let a = 1.0 - 2.0 * x;
                1.6 + (2.05 * (1.4 - 0.7 * a).log10() - 1.2) / 0.92
            }
        }
    }
}

/// An axis of a device and what its raw values mean.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Code of the axis.
    pub axis: u16,
    /// It is a button in the place of a pedal, whose raw values are 0 and 1; `axis` is its code.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub button: bool,
    /// Raw value at one end.
    pub min: i32,
    /// Raw value when nobody touches it.
    pub rest: i32,
    /// Raw value at the other end.
    pub max: i32,
    /// Of the wheel: greater values steer to the left. Of a pedal: it is pressed towards `min`.
    #[serde(default)]
    pub invert: bool,
    /// Fraction of the travel around `rest` that counts as rest, 0 to 0.5.
    #[serde(default)]
    pub dead_zone: f32,
    /// How travel becomes control.
    #[serde(default)]
    pub curve: Curve,
}

impl Axis {
    /// A button in the place of a pedal.
    pub fn of_button(code: u16) -> Self {
        let curve = Curve::Linear;
        Self { axis: code, button: true, min: 0, rest: 0, max: 1, invert: false, dead_zone: 0.0, curve }
    }

    /// Whether both are the same axis or button of a device.
    fn is_where(&self, other: &Self) -> bool {
        (self.axis, self.button) == (other.axis, other.button)
    }

    /// Travel from rest to the end towards `min` (negative) or `max` (positive), -1 to 1, with the
    /// dead zone taken out.
    fn travel(&self, raw: i32) -> f64 {
        let from_rest = f64::from(raw) - f64::from(self.rest);
        let end = if raw < self.rest { self.min } else { self.max };
        let whole = (f64::from(end) - f64::from(self.rest)).abs();
        let travel = if whole > 0.0 { (from_rest / whole).clamp(-1.0, 1.0) } else { 0.0 };
        let dead = f64::from(self.dead_zone);
        travel.signum() * ((travel.abs() - dead) / (1.0 - dead)).max(0.0)
    }

    /// How far the pedal is pressed, 0 to 1.
    pub fn pressed(&self, raw: i32) -> f32 {
        let travel = if self.invert { -self.travel(raw) } else { self.travel(raw) };
        if travel > 0.0 { self.curve.pedal(travel).clamp(0.0, 1.0) as f32 } else { 0.0 }
    }

    /// Steering, -1 (left) to 1. `reach` is how many times the full steering fits into the travel.
    fn steer(&self, raw: i32, reach: f64) -> f32 {
        let travel = if self.invert { -self.travel(raw) } else { self.travel(raw) };
        let steer = self.curve.steering((travel.abs() * reach).min(1.0)).min(1.0);
        (travel.signum() * steer) as f32
    }

    /// What is wrong with it.
    fn problem(&self, name: &str) -> Option<String> {
        let Self { min, rest, max, dead_zone, .. } = *self;
        if min >= max || !(min..=max).contains(&rest) {
            return Some(format!(
                "{name}: min {min}, rest {rest}, max {max}, expected min <= rest <= max and min < max"
            ));
        }
        if self.button && (min, rest, max) != (0, 0, 1) {
            return Some(format!("{name}: a button has min 0, rest 0 and max 1"));
        }
        if !(0.0..=0.5).contains(&dead_zone) {
            return Some(format!("{name}: dead_zone is {dead_zone}, expected 0 to 0.5"));
        }
        None
    }
}

/// Buttons with a meaning, by code.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Buttons {
    /// Pulls the hand brake while it is held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hand_brake: Option<u16>,
    /// Changes between forward and reverse.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reverse: Option<u16>,
    /// "I see the hazard".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seen: Option<u16>,
    /// Switches the left indicator on and off; with the right one held, the hazard lights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub indicate_left: Option<u16>,
    /// Switches the right indicator on and off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub indicate_right: Option<u16>,
    /// Sounds the horn while it is held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horn: Option<u16>,
    /// Switches the headlights on and off; in the dark they are on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lights: Option<u16>,
    /// Switches the wipers on and off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wipers: Option<u16>,
}

impl Buttons {
    /// The buttons of switches, each with its flag of [`Controls`].
    pub(super) fn switches(&self) -> [(Option<u16>, u8); 5] {
        [
            (self.indicate_left, Controls::INDICATE_LEFT),
            (self.indicate_right, Controls::INDICATE_RIGHT),
            (self.horn, Controls::HORN),
            (self.lights, Controls::LIGHTS),
            (self.wipers, Controls::WIPERS),
        ]
    }
}

/// What the raw values of a device mean. Pedals that share an axis ("combined pedals") have their
/// rest in its middle, and one of them is inverted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Name of the devices that it is for.
    pub device: String,
    /// How far the wheel turns from stop to stop, degrees.
    pub rotation_deg: f32,
    /// How much of that is full steering from left to right, degrees; at most `rotation_deg`.
    pub used_deg: f32,
    /// The wheel.
    pub steering: Axis,
    /// The accelerator.
    pub throttle: Axis,
    /// The brake.
    pub brake: Axis,
    /// The buttons.
    #[serde(default)]
    pub buttons: Buttons,
}

/// What `aeye wheel calibrate` and `import` print.
impl Typed for Calibration {
    const TYPE: &'static str = "aeye.wheel.calibration";
}

impl Calibration {
    /// Reads a calibration; what is wrong is said in a sentence that names the line or the section.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        let read: Self = toml_text::read(text)?;
        match read.problem() {
            Some(problem) => Err(problem),
            None => Ok(read),
        }
    }

    /// The text that [`Calibration::from_toml`] reads.
    pub fn to_toml(&self) -> anyhow::Result<String> {
        Ok(toml::to_string(self)?)
    }

    /// Steering of a raw value, -1 (left) to 1.
    pub fn steer(&self, raw: i32) -> f32 {
        self.steering.steer(raw, f64::from(self.rotation_deg) / f64::from(self.used_deg))
    }

    /// What is wrong with it.
    pub fn problem(&self) -> Option<String> {
        let axes = [("steering", &self.steering), ("throttle", &self.throttle), ("brake", &self.brake)];
        if let Some(problem) = axes.iter().find_map(|(name, axis)| axis.problem(name)) {
            return Some(problem);
        }
        let Self { rotation_deg, used_deg, throttle, brake, steering, .. } = self;
        if !(30.0..=3600.0).contains(rotation_deg) || !(30.0..=*rotation_deg).contains(used_deg) {
            return Some(format!(
                "rotation_deg is {rotation_deg} and used_deg {used_deg}, expected 30 <= used_deg <= rotation_deg <= 3600"
            ));
        }
        if steering.button {
            return Some(String::from("steering: a button steers to one side only, expected an axis"));
        }
        if steering.rest == steering.min || steering.rest == steering.max {
            return Some(String::from("steering: the rest is at an end, expected it between min and max"));
        }
        for (name, pedal) in [("throttle", throttle), ("brake", brake)] {
            let end = if pedal.invert { pedal.min } else { pedal.max };
            if pedal.rest == end {
                return Some(format!("{name}: the rest is where the pedal is fully pressed; is invert wrong?"));
            }
            if pedal.is_where(steering) {
                return Some(format!("{name}: axis {} is the wheel's", pedal.axis));
            }
        }
        let opposite = throttle.invert != brake.invert && throttle.rest == brake.rest;
        (throttle.is_where(brake) && !opposite)
            .then(|| String::from("pedals that share an axis need the same rest, and invert = true for one of them"))
    }
}

/// Reads a calibration's file.
pub fn read(path: &Path) -> anyhow::Result<Calibration> {
    let text = files::read_text(path, most::TEXT)?;
    Calibration::from_toml(&text).map_err(|problem| anyhow!("{}: {problem}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::presets;

    fn g29() -> Calibration {
        presets::g29()
    }

    #[test]
    fn ends_and_rest_are_exact() {
        for curve in [Curve::Linear, Curve::Square, Curve::Carla, Curve::CarlaGentle] {
            let mut wheel = g29();
            (wheel.steering.curve, wheel.throttle.curve) = (curve, curve);
            wheel.used_deg = wheel.rotation_deg;
            let steer = [0, 32_768, 65_535].map(|raw| wheel.steer(raw));
            assert_eq!(steer, [-1.0, 0.0, 1.0], "{curve:?}");
            let pressed = [255, 0].map(|raw| wheel.throttle.pressed(raw));
            assert_eq!(pressed, [0.0, 1.0], "{curve:?}");
            let path: Vec<f32> = (0..=255).rev().map(|raw| wheel.throttle.pressed(raw)).collect();
            assert!(path.is_sorted(), "{curve:?}");
        }
    }

    #[test]
    fn half_the_rotation_may_be_full_steering() {
        let mut wheel = g29();
        (wheel.used_deg, wheel.steering.dead_zone) = (450.0, 0.0);
        assert_eq!(wheel.steer(32_768 + 16_400), 1.0);
        assert!((wheel.steer(32_768 - 8_192) + 0.5).abs() < 0.001);
    }

    #[test]
    fn a_dead_zone_is_rest_and_the_ends_stay() {
        let mut wheel = g29();
        (wheel.steering.dead_zone, wheel.used_deg) = (0.1, wheel.rotation_deg);
        assert_eq!((wheel.steer(35_000), wheel.steer(65_535)), (0.0, 1.0));
        assert!(wheel.steer(40_000) > 0.0);
    }

    #[test]
    fn combined_pedals_share_an_axis() {
        let pedal = Axis {
            axis: 1,
            button: false,
            min: 0,
            rest: 128,
            max: 255,
            invert: false,
            dead_zone: 0.0,
            curve: Curve::Linear,
        };
        let mut wheel = g29();
        (wheel.throttle, wheel.brake) = (Axis { invert: true, ..pedal }, pedal);
        assert_eq!(wheel.problem(), None);
        let both = |raw| (wheel.throttle.pressed(raw), wheel.brake.pressed(raw));
        assert_eq!([both(0), both(128), both(255)], [(1.0, 0.0), (0.0, 0.0), (0.0, 1.0)]);
        wheel.brake.invert = true;
        assert!(wheel.problem().is_some_and(|p| p.contains("share an axis")));
    }

    #[test]
    fn a_button_is_a_pedal_and_steers_nothing() {
        let mut pad = g29();
        (pad.throttle, pad.brake) = (Axis::of_button(5), Axis::of_button(2));
        assert_eq!(pad.problem(), None, "codes of buttons are no codes of axes");
        assert_eq!([0, 1].map(|raw| pad.throttle.pressed(raw)), [0.0, 1.0]);
        assert_eq!(Calibration::from_toml(&pad.to_toml().unwrap()), Ok(pad.clone()));
        assert!(!g29().to_toml().unwrap().contains("button ="));
        pad.brake.axis = 5;
        assert!(pad.problem().is_some_and(|p| p.contains("share an axis")));
        pad.brake = Axis { max: 255, ..Axis::of_button(2) };
        assert!(pad.problem().is_some_and(|p| p.starts_with("brake: a button has min 0")));
        (pad.brake, pad.steering.button) = (Axis::of_button(2), true);
        (pad.steering.min, pad.steering.rest, pad.steering.max) = (0, 0, 1);
        assert!(pad.problem().is_some_and(|p| p.starts_with("steering: a button")));
    }

    #[test]
    fn text_comes_back_and_nonsense_is_refused_by_place() {
        let text = g29().to_toml().unwrap();
        assert_eq!(Calibration::from_toml(&text), Ok(g29()));
        let said = |from: &str, to: &str| {
            assert!(text.contains(from), "{from} in {text}");
            Calibration::from_toml(&text.replacen(from, to, 1)).unwrap_err()
        };
        let unknown = said("rotation_deg", "colour = 3\nrotation_deg");
        assert!(unknown.starts_with("line 2: ") && unknown.contains("`colour`"), "{unknown}");
        assert!(said("rotation_deg = 900.0", "").contains("rotation_deg"));
        assert!(said("used_deg = 540.0", "used_deg = 1e9").contains("used_deg"));
        assert!(said("max = 65535", "max = -5").starts_with("steering: min 0"));
        assert!(said("dead_zone = 0.0", "dead_zone = nan").contains("dead_zone"));
        assert!(said("curve = \"linear\"", "curve = \"wavy\"").contains("wavy"));
        assert!(said("invert = true", "invert = false").starts_with("throttle: the rest is where"));
    }
}
