//! A seat and what is in it.

use drivers::seat::KEYBOARD;
use kernel::{Controls, Seat};

use super::device::DeviceUnit;
use super::keyboard::Keyboard;
use super::source::{DeviceId, DeviceInfo};
use super::status::{UnitState, UnitStatus};

/// What moves the controls of a seat.
#[derive(Debug)]
pub(super) enum Unit {
    Bot,
    /// The keyboard, while a window of the rig has it.
    Keyboard {
        keyboard: Keyboard,
        is_there: bool,
    },
    Device(Binding),
}

/// A seat for a device.
#[derive(Debug, Default)]
pub(super) struct Binding {
    /// The device must be the one at this path; else the one on which a button is pressed.
    path: Option<String>,
    bound: Option<Box<Bound>>,
}

#[derive(Debug)]
struct Bound {
    info: DeviceInfo,
    unit: DeviceUnit,
    present: bool,
}

impl Binding {
    /// A seat that waits for the device at a path, or for any device whose button is pressed.
    pub fn new(path: Option<String>) -> Self {
        Self { path, bound: None }
    }

    /// Whether it has no device that is there.
    pub fn waits(&self) -> bool {
        self.bound.as_ref().is_none_or(|b| !b.present)
    }

    /// Whether it waits for the device at its path, which has not been there yet.
    pub fn is_reserved(&self) -> bool {
        self.path.is_some() && self.bound.is_none()
    }

    /// Whether its device is one with this number.
    pub fn has(&self, id: DeviceId) -> bool {
        self.bound.as_ref().is_some_and(|b| b.present && b.info.id == id)
    }

    /// Whether the seat asks for the device by its path, which may be a link such as those in
    /// `/dev/input/by-id`.
    pub fn asks_for(&self, device: &DeviceInfo) -> bool {
        let resolved = |path: &String| std::fs::canonicalize(path).is_ok_and(|p| p.to_str() == Some(&device.path));
        self.path.as_ref().is_some_and(|path| *path == device.path || resolved(path))
    }

    /// Whether the seat has lost a device of this make.
    pub fn misses_make(&self, device: &DeviceInfo) -> bool {
        self.bound.as_ref().is_some_and(|b| !b.present && b.info.same_make(device))
    }

    /// Whether the device that the seat has lost was of this make and at this path.
    pub fn misses(&self, device: &DeviceInfo) -> bool {
        self.misses_make(device) && self.bound.as_ref().is_some_and(|b| b.info.path == device.path)
    }

    /// Takes a device; true if the seat had lost one, which is back or replaced now.
    pub fn bind(&mut self, info: DeviceInfo, unit: DeviceUnit) -> bool {
        self.bound.replace(Box::new(Bound { info, unit, present: true })).is_some()
    }

    /// Its device is gone.
    pub fn lose(&mut self) {
        if let Some(bound) = &mut self.bound {
            bound.present = false;
            bound.unit.disarm();
        }
    }

    /// The device's unit, while it is there.
    pub fn unit(&mut self) -> Option<&mut DeviceUnit> {
        self.bound.as_mut().filter(|b| b.present).map(|b| &mut b.unit)
    }

    fn status(&self) -> UnitStatus {
        let Some(Bound { info, unit, present }) = self.bound.as_deref() else {
            let waits_for = self.path.clone().unwrap_or_else(|| "the press of one of its buttons".into());
            let state = UnitState::Waiting { waits_for };
            return UnitStatus { unit: "wheel or gamepad".into(), place: String::new(), state };
        };
        let to_do = unit.to_do();
        let state = match (present, to_do.is_empty()) {
            (false, _) => UnitState::Lost,
            (true, true) => UnitState::Armed,
            (true, false) => UnitState::Arming { to_do },
        };
        UnitStatus { unit: info.name.clone(), place: info.path.clone(), state }
    }
}

impl Unit {
    /// Its controls for the next tick, unless it is not armed.
    pub fn tick(&mut self, speed_mps: f32) -> Option<Controls> {
        match self {
            Self::Bot => Some(Controls::default()),
            Self::Keyboard { keyboard, is_there } => {
                let controls = keyboard.tick(speed_mps);
                is_there.then_some(controls)
            }
            Self::Device(binding) => binding.unit().and_then(|unit| unit.tick(speed_mps)),
        }
    }

    /// Path of its device, if it has one that is armed.
    pub fn armed_device(&self) -> Option<&str> {
        match self {
            Self::Device(Binding { bound: Some(bound), .. }) if bound.present && bound.unit.is_armed() => {
                Some(&bound.info.path)
            }
            _ => None,
        }
    }

    /// Drives another seat from now on.
    pub fn sit(&mut self, seat: Seat) {
        if let Self::Keyboard { keyboard, .. } = self {
            keyboard.sit(seat);
        }
    }

    /// Gear D.
    pub fn engage_forward(&mut self) {
        match self {
            Self::Bot => {}
            Self::Keyboard { keyboard, .. } => keyboard.engage_forward(),
            Self::Device(binding) => binding.unit().into_iter().for_each(DeviceUnit::engage_forward),
        }
    }

    /// What it is, with the keys of a keyboard.
    pub fn summary(&self) -> String {
        match self {
            Self::Keyboard { keyboard, .. } => format!("keyboard ({})", keyboard.keys()),
            Self::Bot => String::from("bot"),
            Self::Device(_) => self.status().to_string(),
        }
    }

    /// How it is.
    pub fn status(&self) -> UnitStatus {
        let armed =
            |unit: &str, place: &str| UnitStatus { unit: unit.into(), place: place.into(), state: UnitState::Armed };
        match self {
            Self::Bot => armed("bot", ""),
            Self::Keyboard { keyboard, is_there } => {
                let state = if *is_there { UnitState::Armed } else { UnitState::Unfocused };
                UnitStatus { state, ..armed(KEYBOARD, keyboard.name()) }
            }
            Self::Device(binding) => binding.status(),
        }
    }
}
