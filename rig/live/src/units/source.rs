//! Where raw events of devices come from.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use super::layout::Layout;

/// Number of a device, valid while it is connected.
pub type DeviceId = usize;

/// An axis of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisRange {
    /// Code of the axis; on Linux that of the kernel (0 is `ABS_X`).
    pub code: u16,
    /// Least raw value.
    pub min: i32,
    /// Greatest raw value.
    pub max: i32,
}

/// A wheel, a gamepad or anything else with axes and buttons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceInfo {
    /// Its number.
    pub id: DeviceId,
    /// Where the system keeps it, such as `/dev/input/event5`; tells two equal wheels apart.
    pub path: String,
    /// What it calls itself.
    pub name: String,
    /// USB vendor; 0 when unknown.
    pub vendor: u16,
    /// USB product; 0 when unknown.
    pub product: u16,
    /// Its axes by ascending code.
    pub axes: Vec<AxisRange>,
    /// Codes of its buttons.
    pub buttons: Vec<u16>,
    /// Where its elements are, if it is known as a gamepad.
    pub layout: Option<Layout>,
}

impl DeviceInfo {
    /// Whether two devices are of the same make, as a wheel that was plugged in again is.
    pub fn same_make(&self, other: &Self) -> bool {
        (self.vendor, self.product, &self.name) == (other.vendor, other.product, &other.name)
    }

    /// The axis with a code.
    pub fn axis(&self, code: u16) -> Option<&AxisRange> {
        self.axes.iter().find(|a| a.code == code)
    }
}

/// Something that a device did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RawEvent {
    /// It is there.
    Connected(DeviceInfo),
    /// It is gone.
    Lost(DeviceId),
    /// An axis moved.
    Axis {
        /// Which device.
        device: DeviceId,
        /// Code of the axis.
        code: u16,
        /// Raw value.
        value: i32,
    },
    /// A button went down or up.
    Button {
        /// Which device.
        device: DeviceId,
        /// Code of the button.
        code: u16,
        /// Whether it is down now.
        pressed: bool,
    },
}

/// A stream of raw events. Each device begins with [`RawEvent::Connected`].
pub trait InputSource: std::fmt::Debug + Send {
    /// The next event that has happened; never waits.
    fn next_event(&mut self) -> Option<RawEvent>;
}

/// Devices that are played by a program: whoever holds a clone says what they do.
#[derive(Clone, Debug, Default)]
pub struct Simulated(Arc<Mutex<VecDeque<RawEvent>>>);

impl Simulated {
    /// Lets a device do something.
    pub fn push(&self, event: RawEvent) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push_back(event);
    }
}

impl InputSource for Simulated {
    fn next_event(&mut self) -> Option<RawEvent> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).pop_front()
    }
}
