//! Who sits where: the units of both seats, the bots, and what is to be said about them.

use std::path::PathBuf;
use std::sync::Arc;

use base::words::{self, SEATS};
use drivers::temper::Temper;
use kernel::Seat;
use replay::Provenance;

use super::run::Bots;
use crate::units::source::DeviceInfo;
use crate::units::{CarState, KEYBOARD, Polled, SeatChoice, Seats, UnitEvent, UnitEventKind, UnitState, UnitStatus};

/// Both seats of a session.
pub struct Seating {
    seats: Seats,
    /// What sits in the seats now, semantic driver's first.
    choices: [SeatChoice; 2],
    is_swapped: bool,
    status: Option<[UnitStatus; 2]>,
    devices: Vec<DeviceInfo>,
    setup: Arc<[String]>,
}

impl Seating {
    /// Takes the seats, with calibrations from files.
    pub fn new(choices: [SeatChoice; 2], calibrations: &[PathBuf]) -> anyhow::Result<Self> {
        Ok(Self::of(Seats::calibrated(choices.clone(), calibrations)?, choices))
    }

    /// With seats that are taken already, by what was chosen.
    pub fn of(seats: Seats, choices: [SeatChoice; 2]) -> Self {
        let (setup, devices) = (seats.summary().into(), seats.devices().to_vec());
        Self { seats, choices, is_swapped: false, status: None, devices, setup }
    }

    /// The units, for keys.
    pub fn seats(&mut self) -> &mut Seats {
        &mut self.seats
    }

    /// What the units give for the next tick, and whether there is something new to be said of them.
    pub fn poll(&mut self, car: CarState) -> (Polled, bool) {
        let polled = self.seats.poll(car);
        let is_new = self.status.as_ref() != Some(&polled.status) || self.devices != self.seats.devices();
        if is_new {
            self.status = Some(polled.status.clone());
            self.refresh();
        }
        (polled, is_new)
    }

    /// The units change seats, and so do the bots. Gives what is to be said about that.
    pub fn swap(&mut self) -> String {
        self.seats.swap();
        self.choices.swap(0, 1);
        self.is_swapped = !self.is_swapped;
        if let Some(status) = &mut self.status {
            status.swap(0, 1);
        }
        self.refresh();
        let [semantic, safety] = self.words();
        format!("the seats are swapped: semantic driver {semantic}, safety driver {safety}")
    }

    /// Whether the units have changed seats since the session began.
    pub fn is_swapped(&self) -> bool {
        self.is_swapped
    }

    /// What belongs to the people, first to whoever began as the semantic driver, by the seats that they have now.
    pub fn seated<T>(&self, people: [T; 2]) -> [T; 2] {
        let [first, second] = people;
        if self.is_swapped { [second, first] } else { [first, second] }
    }

    fn refresh(&mut self) {
        self.devices = self.seats.devices().to_vec();
        self.setup = self.seats.summary().into();
    }

    /// Paths of the devices in the seats, where they are armed.
    pub fn armed_devices(&self) -> [Option<&str>; 2] {
        self.seats.armed_devices()
    }

    /// What was found, what each seat uses, and how to change that, a line each.
    pub fn setup(&self) -> Arc<[String]> {
        self.setup.clone()
    }

    /// Bots for the seats that no one sits in, in the run of a seed.
    pub fn bots(&self, seed: u64) -> Bots {
        Bots::new(&self.choices, seed)
    }

    /// What a recording of the run of a seed says about the bots.
    pub fn tempers(&self, seed: u64) -> Provenance {
        let bots = [Seat::Semantic, Seat::Safety].into_iter().zip(&self.choices);
        Temper::entries(bots.filter(|(_, choice)| **choice == SeatChoice::Bot).map(|(seat, _)| seat), seed)
    }

    /// Both units in words, once they have been polled.
    pub fn words(&self) -> [String; 2] {
        let word = |status: &UnitStatus| match status.place.as_str() {
            "" => status.to_string(),
            place => format!("{} ({place}): {}", status.unit, status.trouble().unwrap_or_else(|| "armed".into())),
        };
        self.status.as_ref().map(|status| status.each_ref().map(word)).unwrap_or_default()
    }

    /// What the drivers have to do about their units before the car drives; none while both are armed.
    pub fn note(&self) -> Option<String> {
        let status = self.status.as_ref()?;
        let troubles: Vec<String> = status
            .iter()
            .zip(SEATS)
            .filter_map(|(s, seat)| Some(format!("{seat} driver's {}: {}", s.unit, s.trouble()?)))
            .collect();
        (!troubles.is_empty()).then(|| troubles.join("\n"))
    }

    /// Whether both units are armed.
    pub fn is_ready(&self) -> bool {
        self.status.as_ref().is_some_and(|status| status.iter().all(|s| s.state == UnitState::Armed))
    }

    /// What a recording says of the seats: each unit, its device's path or its keys, and whether the
    /// units have changed seats since the session began.
    pub fn provenance(&self) -> Provenance {
        let mut entries = Provenance::default();
        for (status, name) in self.status.iter().flatten().zip(SEATS) {
            entries.insert(name.into(), status.unit.clone());
            if !status.place.is_empty() {
                entries.insert(format!("{name}_at"), status.place.clone());
            }
        }
        entries.insert(study::SWAPPED.into(), self.is_swapped.to_string());
        entries
    }
}

/// What happened to a unit, in words.
pub fn event_text(event: &UnitEvent) -> String {
    let what = match event.kind {
        UnitEventKind::Bound => "is in use",
        UnitEventKind::Armed => "is armed",
        UnitEventKind::Lost => "is lost",
        UnitEventKind::Returned if event.unit == KEYBOARD => "is back",
        UnitEventKind::Returned => "is back, and has to be armed again",
    };
    format!("{} driver's {} {what}", words::seat(event.seat), event.unit)
}

/// The seat whose unit was lost just now.
pub fn lost(polled: &Polled) -> Option<Seat> {
    polled.events.iter().find(|e| e.kind == UnitEventKind::Lost).map(|e| e.seat)
}

/// Whether nobody watches over the car any more.
pub fn is_unwatched(polled: &Polled) -> bool {
    polled.events.iter().any(|e| e.seat == Seat::Safety && e.kind == UnitEventKind::Lost)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::source::{AxisRange, RawEvent, Simulated};
    use crate::units::testing::LAYOUT;

    fn gamepad(id: usize) -> RawEvent {
        RawEvent::Connected(DeviceInfo {
            id,
            path: format!("/dev/input/event{id}"),
            name: "plain pad".into(),
            vendor: 1,
            product: 2,
            axes: [0, 2, 5].map(|code| AxisRange { code, min: 0, max: 255 }).into(),
            buttons: vec![0x130],
            layout: Some(LAYOUT),
        })
    }

    fn seating(choices: [SeatChoice; 2], pads: usize) -> (Seating, Simulated) {
        let devices = Simulated::default();
        (0..pads).for_each(|id| devices.push(gamepad(id)));
        let seats = Seats::with_source(choices.clone(), Vec::new(), Box::new(devices.clone()));
        (Seating::of(seats, choices), devices)
    }

    fn arm(devices: &Simulated, device: usize) {
        for (code, moved, rest) in [(0, 250, 128), (5, 255, 0), (2, 255, 0)] {
            devices.push(RawEvent::Axis { device, code, value: moved });
            devices.push(RawEvent::Axis { device, code, value: rest });
        }
    }

    #[test]
    fn with_nothing_attached_it_says_so_and_what_the_keys_are() {
        let (mut seating, _) = seating(Default::default(), 0);
        seating.poll(CarState::default());
        let setup = seating.setup().join("\n");
        for words in [
            "found no wheel or gamepad",
            "semantic driver: keyboard (W throttle",
            "safety driver: keyboard (up throttle",
        ] {
            assert!(setup.contains(words), "{setup}");
        }
        assert!(setup.contains("--semantic and --safety") && setup.contains("X swaps"), "{setup}");
        assert_eq!((seating.is_ready(), seating.note()), (true, None));
    }

    #[test]
    fn one_gamepad_goes_to_the_semantic_driver_who_is_told_to_arm_it() {
        let (mut seating, devices) = seating(Default::default(), 1);
        seating.poll(CarState::default());
        let setup = seating.setup();
        assert!(setup[0].starts_with("found plain pad at /dev/input/event0, read as a gamepad: left stick steers"));
        assert_eq!(
            setup[1],
            "semantic driver: plain pad: to arm it, move the left stick aside, pull the right trigger, pull the left trigger"
        );
        assert!(setup[2].starts_with("safety driver: keyboard (up throttle"));
        assert!(seating.note().is_some_and(|n| n.starts_with("semantic driver's plain pad: to arm it")));
        arm(&devices, 0);
        assert!(seating.poll(CarState::default()).1 && seating.is_ready());
        assert_eq!(seating.note(), None);
        devices.push(RawEvent::Lost(0));
        seating.poll(CarState::default());
        assert!(seating.note().is_some_and(|n| n.contains("plug it in again")));
        assert!(seating.setup()[0].starts_with("found no wheel or gamepad"));
    }

    #[test]
    fn swapped_seats_are_in_the_words_and_in_the_recording() {
        let (mut seating, devices) = seating(["auto", "bot"].map(|c| c.parse().unwrap()), 1);
        arm(&devices, 0);
        let (polled, _) = seating.poll(CarState::default());
        assert!(polled.ready());
        assert_eq!(seating.armed_devices(), [Some("/dev/input/event0"), None]);
        let at = |s: &Seating, key: &str| s.provenance().get(key).cloned();
        assert_eq!(at(&seating, "semantic_at").as_deref(), Some("/dev/input/event0"));
        let said = seating.swap();
        assert!(
            said.ends_with("semantic driver bot: armed, safety driver plain pad (/dev/input/event0): armed"),
            "{said}"
        );
        assert_eq!((at(&seating, "safety").as_deref(), at(&seating, "semantic_at")), (Some("plain pad"), None));
        assert_eq!(at(&seating, "seats_swapped").as_deref(), Some("true"));
        devices.push(RawEvent::Axis { device: 0, code: 2, value: 255 });
        let (polled, _) = seating.poll(CarState::default());
        assert!(polled.ready() && polled.safety.brake == 65_535, "it stays armed and brakes for the other seat");
        devices.push(RawEvent::Lost(0));
        let (polled, _) = seating.poll(CarState::default());
        assert!(is_unwatched(&polled), "{polled:?}");
        assert_eq!(seating.armed_devices(), [None, None]);
        seating.swap();
        assert_eq!(at(&seating, "seats_swapped").as_deref(), Some("false"));
    }
}
