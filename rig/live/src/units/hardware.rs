//! The devices of this machine. The only file that names the raw layer of gilrs, which gives every
//! event as it is: the one above it knows no wheels.

use std::collections::VecDeque;

use gilrs_core::{Error, EvCode, EventType, Gamepad, Gilrs};

use super::mappings::Mappings;
use super::source::{AxisRange, DeviceId, DeviceInfo, InputSource, RawEvent};

/// The devices of this machine.
#[derive(Debug)]
pub struct Hardware {
    gilrs: Gilrs,
    mappings: Mappings,
    /// Devices that were there at the start.
    found: VecDeque<RawEvent>,
}

impl Hardware {
    /// Looks for devices; a platform without any gives none.
    pub fn open() -> anyhow::Result<Self> {
        let gilrs = match Gilrs::new() {
            Ok(gilrs) | Err(Error::NotImplemented(gilrs)) => gilrs,
            Err(error) => anyhow::bail!("game devices: {error}"),
        };
        let mut hardware = Self { gilrs, mappings: Mappings::read(), found: VecDeque::new() };
        hardware.found = hardware.devices().into_iter().map(RawEvent::Connected).collect();
        Ok(hardware)
    }

    /// The devices that are there now.
    pub fn devices(&self) -> Vec<DeviceInfo> {
        (0..self.gilrs.last_gamepad_hint()).filter_map(|id| self.info(id)).collect()
    }

    fn info(&self, id: DeviceId) -> Option<DeviceInfo> {
        self.pad(id).map(|pad| info(pad, id, &self.mappings))
    }

    fn pad(&self, id: DeviceId) -> Option<&Gamepad> {
        self.gilrs.gamepad(id).filter(|pad| pad.is_connected())
    }

    /// A device was plugged in.
    fn connected(&mut self, id: DeviceId) -> Option<RawEvent> {
        let make = self.pad(id)?.uuid();
        self.mappings.meet(make);
        self.info(id).map(RawEvent::Connected)
    }
}

impl InputSource for Hardware {
    fn next_event(&mut self) -> Option<RawEvent> {
        if let Some(event) = self.found.pop_front() {
            return Some(event);
        }
        loop {
            let event = self.gilrs.next_event()?;
            let device = event.id;
            return Some(match event.event {
                EventType::AxisValueChanged(value, code) => RawEvent::Axis { device, code: number(code), value },
                EventType::ButtonPressed(code) => RawEvent::Button { device, code: number(code), pressed: true },
                EventType::ButtonReleased(code) => RawEvent::Button { device, code: number(code), pressed: false },
                EventType::Disconnected => RawEvent::Lost(device),
                EventType::Connected => match self.connected(device) {
                    Some(connected) => connected,
                    None => continue,
                },
                _ => continue,
            });
        }
    }
}

/// The kernel's code, without the kind of event that stands above it.
fn number(code: EvCode) -> u16 {
    code.into_u32() as u16
}

fn info(pad: &Gamepad, id: DeviceId, mappings: &Mappings) -> DeviceInfo {
    let axis = |code: &EvCode| {
        pad.axis_info(*code).map(|range| AxisRange { code: number(*code), min: range.min, max: range.max })
    };
    let mut axes: Vec<AxisRange> = pad.axes().iter().filter_map(axis).collect();
    axes.sort_by_key(|a| a.code);
    let [axis_codes, button_codes] = [pad.axes(), pad.buttons()].map(whole);
    DeviceInfo {
        id,
        path: path(pad, id),
        name: pad.name().to_owned(),
        vendor: pad.vendor_id().unwrap_or(0),
        product: pad.product_id().unwrap_or(0),
        axes,
        buttons: pad.buttons().iter().copied().map(number).collect(),
        layout: mappings.layout(pad.uuid(), &axis_codes, &button_codes),
    }
}

/// Codes with the kind of event.
fn whole(codes: &[EvCode]) -> Vec<u32> {
    codes.iter().map(|code| code.into_u32()).collect()
}

#[cfg(target_os = "linux")]
fn path(pad: &Gamepad, _: DeviceId) -> String {
    use gilrs_core::LinuxGamepadExt;
    pad.devpath().display().to_string()
}

/// Other systems have no path: the order of plugging in tells equal devices apart.
#[cfg(not(target_os = "linux"))]
fn path(_: &Gamepad, id: DeviceId) -> String {
    format!("device {id}")
}
