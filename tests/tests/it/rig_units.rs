//! A drive with two simulated wheels: whatever happens to them is in the recording, and a wheel that
//! is lost stops the car without being an intervention.

use drivers::session::Session;
use kernel::time::Tick;
use kernel::{Controls, Seat, World};
use live::units::calibration::{Axis, Buttons, Calibration, Curve};
use live::units::source::{AxisRange, DeviceInfo, RawEvent, Simulated};
use live::units::{CarState, Polled, SeatChoice, Seats};
use proptest::prelude::*;
use replay::{Manifest, Note, NoteKind, Provenance, Recording, verify};
use tests::scenes::{Scene, follow_route, scene};

const NAME: &str = "simulated wheel";
const SEATS: [Seat; 2] = [Seat::Semantic, Seat::Safety];

/// Raw values are the kernel's own.
fn calibration() -> Calibration {
    let axis = |axis, min, max| Axis {
        axis,
        button: false,
        min,
        rest: 0,
        max,
        invert: false,
        dead_zone: 0.0,
        curve: Curve::Linear,
    };
    Calibration {
        device: NAME.into(),
        rotation_deg: 900.0,
        used_deg: 900.0,
        steering: axis(0, -32_767, 32_767),
        throttle: axis(1, 0, 65_535),
        brake: axis(2, 0, 65_535),
        buttons: Buttons::default(),
    }
}

fn wheel(id: usize) -> RawEvent {
    let axes = [(0, -32_767, 32_767), (1, 0, 65_535), (2, 0, 65_535)];
    RawEvent::Connected(DeviceInfo {
        id,
        path: format!("/dev/input/event{}", 20 + id),
        name: NAME.into(),
        vendor: 0,
        product: 0,
        axes: axes.map(|(code, min, max)| AxisRange { code, min, max }).into(),
        buttons: vec![0x120],
        layout: None,
    })
}

/// Two wheels in the seats of a car, and the recording of its drive.
struct Rig {
    devices: Simulated,
    seats: Seats,
    session: Session<Vec<u8>>,
    /// What must be in the recording.
    told: Vec<Note>,
}

impl Rig {
    fn new(scene: &Scene) -> Self {
        let devices = Simulated::default();
        (0..2).for_each(|id| devices.push(wheel(id)));
        let choices = [0, 1].map(|id| SeatChoice::Device(format!("/dev/input/event{}", 20 + id)));
        let seats = Seats::with_source(choices, vec![calibration()], Box::new(devices.clone()));
        let manifest = Manifest::new(&scene.scenario, &scene.network, None, Provenance::default());
        let session = Session::new(scene.world(), &manifest, Vec::new()).expect("a new log");
        let mut rig = Self { devices, seats, session, told: Vec::new() };
        (0..2).for_each(|id| rig.tell(id, NoteKind::UnitBound));
        rig
    }

    fn world(&self) -> &World {
        self.session.world()
    }

    fn tell(&mut self, id: usize, kind: NoteKind) {
        self.told.push(Note { tick: self.world().tick() + 1, kind, seat: Some(SEATS[id]) });
    }

    fn put(&self, device: usize, controls: Controls) {
        let values = [i32::from(controls.steer), controls.throttle.into(), controls.brake.into()];
        for (code, value) in (0..).zip(values) {
            self.devices.push(RawEvent::Axis { device, code, value });
        }
    }

    fn arm(&mut self, id: usize) {
        self.put(id, Controls::from_fractions(1.0, 1.0, 1.0));
        self.put(id, Controls::default());
        self.tell(id, NoteKind::UnitArmed);
    }

    fn lose(&mut self, id: usize) {
        self.devices.push(RawEvent::Lost(id));
        self.tell(id, NoteKind::UnitLost);
    }

    fn give_back(&mut self, id: usize) {
        self.devices.push(wheel(id));
        self.tell(id, NoteKind::UnitReturned);
    }

    /// The semantic driver follows the route; the safety driver watches.
    fn drive(&mut self, ticks: Tick) -> Option<Polled> {
        let mut last = None;
        for _ in 0..ticks {
            if last.as_ref().is_some_and(Polled::ready) {
                self.put(0, follow_route(self.world()).semantic);
            }
            let car = CarState {
                speed_mps: self.world().hud().speed_mps,
                taken_over: self.world().arbiter().intervention.is_some(),
            };
            let polled = self.seats.poll(car);
            polled
                .events
                .iter()
                .for_each(|e| self.session.note(e.note(self.session.world().tick() + 1)).expect("in order"));
            self.session.tick(&polled.input()).expect("the log grows");
            last = Some(polled);
        }
        last
    }

    fn speed_mps(&self) -> f32 {
        self.world().hud().speed_mps.abs()
    }

    /// Ends the drive: every note is in the recording, which simulates again to the same hashes.
    fn end(self, scene: &Scene) -> Recording {
        let told = self.told;
        let recording = Recording::from_bytes(&self.session.finish().expect("the log ends")).expect("a recording");
        assert_eq!(recording.log().notes, told);
        let report = verify(recording.log(), &scene.network).expect("a log that can be simulated");
        assert_eq!(report.divergence, None);
        recording
    }
}

fn quiet_city() -> Scene {
    scene("map = \"city\"\nseed = 7\n[traffic]\ncars = 0\nmotorcycles = 0\nbicycles = 0\npedestrians = 0\n")
}

#[test]
fn a_lost_wheel_stops_the_car_until_it_is_armed_again() {
    let scene = quiet_city();
    for lost in 0..2 {
        let mut rig = Rig::new(&scene);
        (0..2).for_each(|id| rig.arm(id));
        rig.drive(300);
        assert!(rig.speed_mps() > 4.0, "{} m/s", rig.speed_mps());
        rig.lose(lost);
        rig.drive(240);
        assert!(rig.speed_mps() < 0.1, "{} m/s after losing {lost}", rig.speed_mps());
        rig.give_back(lost);
        rig.drive(60);
        assert!(rig.speed_mps() < 0.1, "{} m/s before arming", rig.speed_mps());
        rig.arm(lost);
        rig.drive(240);
        assert!(rig.speed_mps() > 2.0, "{} m/s after arming", rig.speed_mps());
        assert_eq!(rig.world().arbiter().intervention, None);
        rig.end(&scene);
    }
}

#[test]
fn a_takeover_whose_wheel_is_lost_goes_on_to_standstill() {
    let scene = quiet_city();
    let mut rig = Rig::new(&scene);
    (0..2).for_each(|id| rig.arm(id));
    rig.drive(300);
    rig.put(1, Controls::from_fractions(-0.2, 0.0, 0.0));
    rig.drive(3);
    assert!(rig.world().arbiter().intervention.is_some());
    rig.lose(1);
    let polled = rig.drive(240).expect("ticks were driven");
    assert!(rig.speed_mps() < 0.1 && polled.safety.steer < -6_000, "{} m/s", rig.speed_mps());
    rig.end(&scene);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4))]

    #[test]
    fn loss_and_return_at_fifty_moments_are_in_the_recording(
        moments in prop::collection::vec((0usize..2, 1u64..50), 50),
    ) {
        let scene = quiet_city();
        let mut rig = Rig::new(&scene);
        (0..2).for_each(|id| rig.arm(id));
        let mut present = [true; 2];
        for (id, ticks) in moments {
            if present[id] {
                rig.lose(id);
            } else {
                rig.give_back(id);
                rig.arm(id);
            }
            present[id] = !present[id];
            rig.drive(ticks);
        }
        prop_assert_eq!(rig.world().arbiter().intervention, None);
        rig.end(&scene);
    }
}
