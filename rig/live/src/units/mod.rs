//! Both seats' control units: what the drivers' hands and feet do, as [`Controls`], once a tick.
//!
//! Nothing here reads the clock: [`Seats::poll`] is called once for every tick of the world.
//!
//! **The car drives only while both units are armed.** While one of them is not, the semantic
//! controls are those of braking to a stop with the steering held. The safety controls are neutral
//! then, so that a lost unit never looks like an intervention; after a takeover they brake and hold
//! the steering too, since they are what reaches the car. `Seating::is_unwatched` of a drive ends the run when the
//! safety driver's unit is lost: nobody watches over it then.

pub mod calibration;
pub mod carla;
mod device;
pub mod hardware;
pub mod keyboard;
pub mod layout;
mod mappings;
pub mod presets;
mod slot;
pub mod source;
pub mod status;
mod switches;
#[cfg(test)]
pub(crate) mod testing;
pub mod wizard;

use std::path::PathBuf;

use kernel::{Controls, Seat, TickInput};

use calibration::Calibration;
use device::{DeviceUnit, Make};
use hardware::Hardware;
pub use keyboard::Key;
use keyboard::Keyboard;
use slot::{Binding, Unit};
use source::{DeviceId, DeviceInfo, InputSource, RawEvent, Simulated};
pub use status::{UnitEvent, UnitEventKind, UnitState, UnitStatus};

use base::words;
pub use drivers::seat::{KEYBOARD, SeatChoice};

/// How hard a car without a driver brakes, fraction of the pedal.
const STOP_BRAKE: f32 = 0.6;
/// How a seat is given another unit.
const HOW_TO_CHOOSE: &str = "to change that: --semantic and --safety take auto, keyboard, bot, press (a button on the \
                             device) or a path such as /dev/input/event5; X swaps the seats between runs";
/// What there is to say when no device is there.
const PERMISSION: &str = "(on Linux one needs read and write permission on /dev/input/event*)";
/// The keyboard may be without a window for so long, as when it goes from one to the next.
const UNFOCUSED_TICKS: u32 = 30;
const SEATS: [Seat; 2] = [Seat::Semantic, Seat::Safety];

/// What the units need to know of the car; that of the tick before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CarState {
    /// Speed along the car's x axis, m/s.
    pub speed_mps: f32,
    /// Whether the safety driver has taken over (`Arbiter::intervention`).
    pub taken_over: bool,
}

/// What the units gave for one tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Polled {
    /// Controls of the semantic driver.
    pub semantic: Controls,
    /// Controls of the safety driver.
    pub safety: Controls,
    /// What happened to the units since the tick before.
    pub events: Vec<UnitEvent>,
    /// How the units are, semantic driver's first.
    pub status: [UnitStatus; 2],
}

impl Polled {
    /// What goes into the world.
    pub fn input(&self) -> TickInput {
        TickInput { semantic: self.semantic, safety: self.safety }
    }

    /// Whether both units are armed, without which the car does not drive.
    pub fn ready(&self) -> bool {
        self.status.iter().all(|s| s.state == UnitState::Armed)
    }
}

/// Both seats' control units.
#[derive(Debug)]
pub struct Seats {
    source: Box<dyn InputSource>,
    units: [Unit; 2],
    /// Devices that are there.
    devices: Vec<DeviceInfo>,
    calibrations: Vec<Calibration>,
    /// Steering that each seat gave last while it was armed.
    held_steer: [i16; 2],
    events: Vec<UnitEvent>,
    /// Ticks since no window of the rig has the keyboard.
    unfocused_ticks: Option<u32>,
    /// Why no devices can be looked for, if so.
    deaf: Option<String>,
}

impl Seats {
    /// Units for both seats, semantic driver's first, with the devices of this machine and their presets.
    pub fn new(choices: [SeatChoice; 2]) -> anyhow::Result<Self> {
        Self::calibrated(choices, &[])
    }

    /// As [`Seats::new`], with the calibrations in these files. An unreadable file is an error, and so
    /// are devices that cannot be reached when a seat needs one.
    pub fn calibrated(choices: [SeatChoice; 2], files: &[PathBuf]) -> anyhow::Result<Self> {
        let calibrations = files.iter().map(|file| calibration::read(file)).collect::<anyhow::Result<_>>()?;
        let any = |wish: fn(&SeatChoice) -> bool| choices.iter().any(wish);
        let (source, deaf): (Box<dyn InputSource>, _) = match Hardware::open() {
            Ok(hardware) => (Box::new(hardware), None),
            Err(error) if any(|c| matches!(c, SeatChoice::Press | SeatChoice::Device(_))) => return Err(error),
            Err(error) => (Box::new(Simulated::default()), Some(error.to_string())),
        };
        Ok(Self { deaf, ..Self::with_source(choices, calibrations, source) })
    }

    /// Units for both seats, with devices from a source. A device is read by the calibration that
    /// bears its name, else by a preset.
    pub fn with_source(
        choices: [SeatChoice; 2],
        calibrations: Vec<Calibration>,
        mut source: Box<dyn InputSource>,
    ) -> Self {
        let (mut devices, mut later) = (Vec::new(), Vec::new());
        while let Some(event) = source.next_event() {
            match event {
                RawEvent::Connected(device) => devices.push(device),
                other => later.push(other),
            }
        }
        let usable: Vec<_> = devices.iter().filter(|d| calibration_of(&calibrations, d).is_some()).cloned().collect();
        let is_named = choices.iter().any(|c| matches!(c, SeatChoice::Device(_) | SeatChoice::Press));
        let units = settle(choices, usable.len());
        let mut seats = Self {
            source,
            units,
            devices: Vec::new(),
            calibrations,
            held_steer: [0; 2],
            events: Vec::new(),
            unfocused_ticks: None,
            deaf: None,
        };
        devices.into_iter().map(RawEvent::Connected).for_each(|event| seats.take(event));
        if let ([only], false) = (&usable[..], is_named) {
            // Nobody has to say whose it is.
            seats.claim(only);
        }
        later.into_iter().for_each(|event| seats.take(event));
        seats
    }

    /// A key of any window went down or up.
    pub fn key(&mut self, key: Key, pressed: bool) {
        self.keyboards().for_each(|keyboard| keyboard.key(key, pressed));
    }

    /// All keys went up, as when a window loses the keyboard.
    pub fn release_keys(&mut self) {
        self.keyboards().for_each(Keyboard::release);
    }

    /// Whether a window of the rig has the keyboard. Without one, units on it count as lost after
    /// [`UNFOCUSED_TICKS`], and are back at once.
    pub fn focus(&mut self, is_ours: bool) {
        self.unfocused_ticks = if is_ours { None } else { self.unfocused_ticks.or(Some(0)) };
    }

    /// Steering of the safety driver beyond which it takes over, fraction of full steering: keys must
    /// pass it at any speed.
    pub fn set_takeover_steer(&mut self, fraction: f32) {
        self.keyboards().for_each(|keyboard| keyboard.set_takeover_steer(fraction));
    }

    /// Both units' gear is D.
    pub fn engage_forward(&mut self) {
        self.units.iter_mut().for_each(Unit::engage_forward);
    }

    fn watch_focus(&mut self) {
        self.unfocused_ticks = self.unfocused_ticks.map(|ticks| ticks.saturating_add(1));
        let has_keyboard = self.unfocused_ticks.is_none_or(|ticks| ticks < UNFOCUSED_TICKS);
        for (unit, seat) in self.units.iter_mut().zip(SEATS) {
            if let Unit::Keyboard { is_there, .. } = unit
                && *is_there != has_keyboard
            {
                *is_there = has_keyboard;
                let kind = if has_keyboard { UnitEventKind::Returned } else { UnitEventKind::Lost };
                self.events.push(UnitEvent { seat, kind, unit: KEYBOARD.into() });
            }
        }
    }

    /// What was found, what each seat uses, and how to change that, a line each.
    pub fn summary(&self) -> Vec<String> {
        let found = self.devices.iter().map(|d| found(&self.calibrations, d));
        let none = self.devices.is_empty().then(|| match &self.deaf {
            Some(reason) => format!("could not look for wheels and gamepads: {reason}"),
            None if self.units.iter().any(|unit| matches!(unit, Unit::Device(_))) => {
                format!("found no wheel or gamepad yet {PERMISSION}")
            }
            None => format!("found no wheel or gamepad {PERMISSION}; one plugged in now is found at the next start"),
        });
        let seats = SEATS.map(|seat| format!("{} driver: {}", words::seat(seat), self.units[seat as usize].summary()));
        found.chain(none).chain(seats).chain([String::from(HOW_TO_CHOOSE)]).collect()
    }

    /// The units of the two seats change places.
    pub fn swap(&mut self) {
        self.units.swap(0, 1);
        self.held_steer.swap(0, 1);
        for (unit, seat) in self.units.iter_mut().zip(SEATS) {
            unit.sit(seat);
        }
    }

    /// Paths of the devices in the seats, semantic driver's first, where they are armed.
    pub fn armed_devices(&self) -> [Option<&str>; 2] {
        self.units.each_ref().map(Unit::armed_device)
    }

    /// The devices that are there.
    pub fn devices(&self) -> &[DeviceInfo] {
        &self.devices
    }

    /// The controls of the next tick; moves wheels and pedals of the keyboard by one tick.
    pub fn poll(&mut self, car: CarState) -> Polled {
        while let Some(event) = self.source.next_event() {
            self.take(event);
        }
        self.watch_focus();
        let own = [0, 1].map(|seat| self.units[seat].tick(car.speed_mps));
        for (held, own) in self.held_steer.iter_mut().zip(own) {
            *held = own.map_or(*held, |controls| controls.steer);
        }
        let stop = self.held_steer.map(|steer| Controls { steer, ..Controls::from_fractions(0.0, 0.0, STOP_BRAKE) });
        let semantic = own[0].filter(|_| own[1].is_some()).unwrap_or(stop[0]);
        let safety = own[1].unwrap_or(if car.taken_over { stop[1] } else { Controls::default() });
        let status = SEATS.map(|seat| self.units[seat as usize].status());
        Polled { semantic, safety, events: std::mem::take(&mut self.events), status }
    }

    fn keyboards(&mut self) -> impl Iterator<Item = &mut Keyboard> {
        self.units.iter_mut().filter_map(|unit| match unit {
            Unit::Keyboard { keyboard, .. } => Some(keyboard),
            _ => None,
        })
    }

    fn take(&mut self, event: RawEvent) {
        match event {
            RawEvent::Connected(device) => self.connected(device),
            RawEvent::Lost(id) => self.lost(id),
            RawEvent::Axis { device, code, value } => {
                if let Some(seat) = self.seat_of(device) {
                    self.touch(seat, |unit| unit.axis(code, value));
                }
            }
            RawEvent::Button { device, code, pressed } => match self.seat_of(device) {
                Some(seat) => self.touch(seat, |unit| unit.button(code, pressed)),
                None if pressed => self.pressed_on(device),
                None => {}
            },
        }
    }

    fn connected(&mut self, device: DeviceInfo) {
        self.devices.retain(|d| d.id != device.id);
        self.devices.push(device.clone());
        let waiting = |wish: &dyn Fn(&Binding) -> bool| {
            let seats = SEATS.into_iter().filter(|seat| match &self.units[*seat as usize] {
                Unit::Device(binding) => binding.waits() && wish(binding),
                _ => false,
            });
            seats.collect::<Vec<_>>()
        };
        let exact = waiting(&|b| b.asks_for(&device) || b.misses(&device));
        let alike = waiting(&|b| b.misses_make(&device));
        // Of two equal wheels that are gone, only a button tells which one has come back.
        if let ([seat, ..], _) | ([], [seat]) = (&exact[..], &alike[..]) {
            self.bind(*seat, &device);
        }
    }

    /// A button of a device without a seat: its driver claims it.
    fn pressed_on(&mut self, id: DeviceId) {
        if let Some(device) = self.devices.iter().find(|d| d.id == id).cloned() {
            self.claim(&device);
        }
    }

    /// Gives a device to the seat that misses its make, else to the first that waits for any.
    fn claim(&mut self, device: &DeviceInfo) {
        let is_open = |binding: &mut Binding| binding.waits() && !binding.is_reserved();
        let waiting: Vec<Seat> = SEATS.into_iter().filter(|seat| self.binding(*seat).is_some_and(is_open)).collect();
        let missed = waiting.iter().find(|seat| self.binding(**seat).is_some_and(|b| b.misses_make(device)));
        if let Some(seat) = missed.or(waiting.first()) {
            self.bind(*seat, device);
        }
    }

    fn bind(&mut self, seat: Seat, device: &DeviceInfo) {
        let Some(calibration) = calibration_of(&self.calibrations, device) else { return };
        let is_known = presets::is_known_wheel(device) || self.calibrations.iter().any(|c| c.device == device.name);
        let make = if is_known { Make::Wheel } else { Make::Gamepad };
        let Some(binding) = self.binding(seat) else { return };
        let returned = binding.bind(device.clone(), DeviceUnit::new(calibration, make));
        let kind = if returned { UnitEventKind::Returned } else { UnitEventKind::Bound };
        self.events.push(UnitEvent { seat, kind, unit: device.name.clone() });
    }

    fn lost(&mut self, id: DeviceId) {
        let seat = self.seat_of(id);
        let Some(at) = self.devices.iter().position(|d| d.id == id) else { return };
        let unit = self.devices.remove(at).name;
        if let Some(seat) = seat {
            self.binding(seat).into_iter().for_each(Binding::lose);
            self.events.push(UnitEvent { seat, kind: UnitEventKind::Lost, unit });
        }
    }

    /// A driver moves something of the seat's device, which may arm it.
    fn touch(&mut self, seat: Seat, act: impl FnOnce(&mut DeviceUnit)) {
        let Some(unit) = self.binding(seat).and_then(Binding::unit) else { return };
        act(unit);
        if unit.arm() {
            let unit = self.units[seat as usize].status().unit;
            self.events.push(UnitEvent { seat, kind: UnitEventKind::Armed, unit });
        }
    }

    fn seat_of(&mut self, id: DeviceId) -> Option<Seat> {
        SEATS.into_iter().find(|seat| self.binding(*seat).is_some_and(|b| b.has(id)))
    }

    fn binding(&mut self, seat: Seat) -> Option<&mut Binding> {
        match &mut self.units[seat as usize] {
            Unit::Device(binding) => Some(binding),
            _ => None,
        }
    }
}

/// The calibration of a device: the one that bears its name, else its preset, else that of a gamepad
/// with its layout.
pub fn calibration_of(calibrations: &[Calibration], device: &DeviceInfo) -> Option<Calibration> {
    let own = calibrations.iter().find(|c| c.device == device.name).cloned();
    own.or_else(|| presets::preset(device))
}

/// A device that was found, and how it would be read, in words.
fn found(calibrations: &[Calibration], device: &DeviceInfo) -> String {
    let DeviceInfo { name, path, .. } = device;
    let read = match calibration_of(calibrations, device) {
        Some(_) if calibrations.iter().any(|c| c.device == *name) => "read by its calibration file".into(),
        Some(_) if presets::is_known_wheel(device) => "a wheel that is known".into(),
        Some(_) => "read as a gamepad: left stick steers, right trigger is throttle, left trigger brake".into(),
        None => format!(
            "of no use before aeye wheel calibrate --device {path} --out FILE.toml, \
             and --calibration FILE.toml here"
        ),
    };
    format!("found {name} at {path}, {read}")
}

/// The units of the seats when so many devices are there.
fn settle(choices: [SeatChoice; 2], devices: usize) -> [Unit; 2] {
    let named = choices.iter().filter(|c| matches!(c, SeatChoice::Device(_) | SeatChoice::Press)).count();
    let asking = choices.iter().filter(|c| **c == SeatChoice::Auto).count();
    // The devices that named choices leave over go to those who take what is there.
    let mut free = devices.saturating_sub(named).min(asking);
    let mut choices = choices.into_iter();
    SEATS.map(|seat| match choices.next().unwrap_or_default() {
        SeatChoice::Bot => Unit::Bot,
        SeatChoice::Device(path) => Unit::Device(Binding::new(Some(path))),
        SeatChoice::Press => Unit::Device(Binding::new(None)),
        SeatChoice::Auto if free > 0 => {
            free -= 1;
            Unit::Device(Binding::new(None))
        }
        SeatChoice::Auto | SeatChoice::Keyboard => Unit::Keyboard { keyboard: Keyboard::new(seat), is_there: true },
    })
}

#[cfg(test)]
mod tests;
