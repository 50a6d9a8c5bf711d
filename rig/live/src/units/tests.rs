//! Seats with simulated devices.

mod gamepads;

use proptest::prelude::*;

use super::testing::device;
use super::*;

/// Codes of wheel, accelerator and brake of a simulated wheel, as a gamepad's preset reads them.
const WHEEL: u16 = 0;
const THROTTLE: u16 = 5;
const BRAKE: u16 = 2;
const CENTRE: i32 = 32_768;

fn simulated(choices: [SeatChoice; 2]) -> (Seats, Simulated) {
    let devices = Simulated::default();
    for (id, path) in [(0, "/dev/input/event5"), (1, "/dev/input/event6")] {
        devices.push(RawEvent::Connected(device(id, path)));
    }
    (Seats::with_source(choices, Vec::new(), Box::new(devices.clone())), devices)
}

fn by_path() -> [SeatChoice; 2] {
    ["/dev/input/event5", "/dev/input/event6"].map(|path| path.parse().unwrap())
}

fn axis(devices: &Simulated, device: usize, code: u16, value: i32) {
    devices.push(RawEvent::Axis { device, code, value });
}

fn press(devices: &Simulated, device: usize) {
    devices.push(RawEvent::Button { device, code: 0x130, pressed: true });
    devices.push(RawEvent::Button { device, code: 0x130, pressed: false });
}

fn arm(devices: &Simulated, device: usize) {
    for (code, moved, rest) in [(WHEEL, 60_000, CENTRE), (THROTTLE, 255, 0), (BRAKE, 255, 0)] {
        axis(devices, device, code, moved);
        axis(devices, device, code, rest);
    }
}

fn kinds(polled: &Polled) -> Vec<(Seat, UnitEventKind)> {
    polled.events.iter().map(|e| (e.seat, e.kind)).collect()
}

#[test]
fn a_keyboard_without_a_window_is_a_lost_unit_and_the_gear_of_a_new_run_is_d() {
    let mut seats = Seats::new([SeatChoice::Keyboard, SeatChoice::Keyboard]).unwrap();
    seats.key(Key::W, true);
    seats.key(Key::R, true);
    let polled = (0..60).map(|_| seats.poll(CarState::default())).last().unwrap();
    assert!(polled.semantic.throttle > 60_000 && polled.semantic.has(Controls::REVERSE));
    seats.engage_forward();
    assert!(!seats.poll(CarState::default()).semantic.has(Controls::REVERSE));
    // From one window to the next.
    seats.focus(false);
    assert!((0..20).all(|_| seats.poll(CarState::default()).ready()));
    seats.focus(true);
    assert!((0..60).all(|_| seats.poll(CarState::default()).ready()));
    // To another program.
    seats.focus(false);
    let events: Vec<_> = (0..60).flat_map(|_| kinds(&seats.poll(CarState::default()))).collect();
    assert_eq!(events, [(Seat::Semantic, UnitEventKind::Lost), (Seat::Safety, UnitEventKind::Lost)]);
    let polled = seats.poll(CarState::default());
    assert!(!polled.ready() && polled.semantic.brake > 30_000 && polled.semantic.throttle == 0);
    assert_eq!(polled.safety, Controls::default(), "no intervention");
    seats.focus(true);
    let polled = seats.poll(CarState::default());
    assert!(polled.ready());
    assert_eq!(kinds(&polled), [(Seat::Semantic, UnitEventKind::Returned), (Seat::Safety, UnitEventKind::Returned)]);
}

#[test]
fn two_people_share_a_keyboard() {
    let mut seats = Seats::new([SeatChoice::Keyboard, SeatChoice::Keyboard]).unwrap();
    seats.key(Key::W, true);
    seats.key(Key::Down, true);
    let polled = (0..60).map(|_| seats.poll(CarState::default())).last().unwrap();
    assert!(polled.ready());
    assert_eq!((polled.semantic.throttle, polled.semantic.brake), (65535, 0));
    assert_eq!((polled.safety.throttle, polled.safety.brake), (0, 65535));
    seats.release_keys();
    let polled = (0..60).map(|_| seats.poll(CarState::default())).last().unwrap();
    assert_eq!(polled.input(), TickInput::default());
}

#[test]
fn a_bot_has_no_unit() {
    let choices = [SeatChoice::Bot, SeatChoice::Keyboard];
    let mut seats = Seats::with_source(choices, Vec::new(), Box::new(Simulated::default()));
    seats.key(Key::W, true);
    let polled = seats.poll(CarState::default());
    assert_eq!(polled.semantic, Controls::default());
    assert_eq!(polled.status[0].to_string(), "bot: armed");
    let summary = seats.summary();
    assert!(summary[0].starts_with("found no wheel or gamepad") && summary[1] == "semantic driver: bot");
    assert!(summary[2].starts_with("safety driver: keyboard (up throttle") && summary[3].contains("--safety"));
}

#[test]
fn the_car_is_held_until_both_units_are_armed() {
    let (mut seats, devices) = simulated(by_path());
    let polled = seats.poll(CarState::default());
    assert_eq!(kinds(&polled), [(Seat::Semantic, UnitEventKind::Bound), (Seat::Safety, UnitEventKind::Bound)]);
    assert!(polled.semantic.brake > 0 && polled.safety == Controls::default() && !polled.ready());
    assert!(polled.status[0].to_string().contains("aside, pull the right trigger"), "{}", polled.status[0]);

    arm(&devices, 0);
    axis(&devices, 0, THROTTLE, 255);
    let polled = seats.poll(CarState::default());
    assert_eq!(kinds(&polled), [(Seat::Semantic, UnitEventKind::Armed)]);
    assert!(polled.semantic.throttle == 0 && polled.semantic.brake > 0, "nobody watches over it yet");

    arm(&devices, 1);
    axis(&devices, 1, BRAKE, 51);
    let polled = seats.poll(CarState::default());
    assert!(polled.ready());
    assert_eq!((polled.semantic.throttle, polled.semantic.brake), (65_535, 0));
    assert_eq!(polled.safety.brake, 13_107);
}

#[test]
fn what_is_there_is_taken() {
    let mut one = Simulated::default();
    one.push(RawEvent::Connected(device(0, "/dev/input/event5")));
    let mut seats = Seats::with_source([SeatChoice::Auto, SeatChoice::Auto], Vec::new(), Box::new(one.clone()));
    arm(&one, 0);
    let polled = seats.poll(CarState::default());
    assert!(polled.ready());
    assert_eq!(polled.status.each_ref().map(|s| s.unit.as_str()), ["simulated wheel", "keyboard"]);

    one = Simulated::default();
    let mut seats = Seats::with_source([SeatChoice::Auto, SeatChoice::Auto], Vec::new(), Box::new(one));
    assert_eq!(seats.poll(CarState::default()).status.map(|s| s.unit), ["keyboard", "keyboard"]);
}

#[test]
fn a_button_claims_a_wheel_for_the_semantic_driver_first() {
    let (mut seats, devices) = simulated([SeatChoice::Auto, SeatChoice::Press]);
    let status = seats.poll(CarState::default()).status;
    assert_eq!(status[0].to_string(), "wheel or gamepad: waiting for the press of one of its buttons");
    assert!(seats.summary().concat().contains("press"));
    press(&devices, 1);
    press(&devices, 0);
    press(&devices, 1);
    arm(&devices, 1);
    let polled = seats.poll(CarState::default());
    assert_eq!(
        kinds(&polled),
        [
            (Seat::Semantic, UnitEventKind::Bound),
            (Seat::Safety, UnitEventKind::Bound),
            (Seat::Semantic, UnitEventKind::Armed)
        ]
    );
}

#[test]
fn a_button_claims_no_seat_that_waits_for_its_own_wheel() {
    let absent = "/dev/input/event9".parse().unwrap();
    let (mut seats, devices) = simulated([absent, SeatChoice::Press]);
    press(&devices, 0);
    assert_eq!(kinds(&seats.poll(CarState::default())), [(Seat::Safety, UnitEventKind::Bound)]);
    press(&devices, 1);
    assert_eq!(kinds(&seats.poll(CarState::default())), []);
    devices.push(RawEvent::Connected(device(2, "/dev/input/event9")));
    assert_eq!(kinds(&seats.poll(CarState::default())), [(Seat::Semantic, UnitEventKind::Bound)]);
}

#[test]
fn two_equal_wheels_that_come_back_elsewhere_are_claimed_by_a_button() {
    let (mut seats, devices) = simulated(by_path());
    (0..2).for_each(|id| devices.push(RawEvent::Lost(id)));
    devices.push(RawEvent::Connected(device(2, "/dev/input/event8")));
    let polled = seats.poll(CarState::default());
    assert_eq!(polled.status.map(|s| s.state), [UnitState::Lost, UnitState::Lost]);
    press(&devices, 2);
    // The other one is now the only one that is missing.
    devices.push(RawEvent::Connected(device(3, "/dev/input/event9")));
    let polled = seats.poll(CarState::default());
    assert_eq!(kinds(&polled), [(Seat::Semantic, UnitEventKind::Returned), (Seat::Safety, UnitEventKind::Returned)]);
}

#[test]
fn a_device_that_nothing_is_known_of_says_how_to_calibrate_it() {
    let odd = Simulated::default();
    let mut pedals = device(0, "/dev/input/event5");
    pedals.axes.truncate(1);
    odd.push(RawEvent::Connected(pedals));
    let seats = Seats::with_source(Default::default(), Vec::new(), Box::new(odd));
    let summary = seats.summary();
    assert!(summary[0].contains("aeye wheel calibrate --device /dev/input/event5"), "{summary:?}");
    assert!(summary[1].starts_with("semantic driver: keyboard"), "{summary:?}");
}

#[test]
fn halves_of_the_keyboard_keep_their_keys_when_the_seats_are_swapped() {
    let mut seats = Seats::with_source(Default::default(), Vec::new(), Box::new(Simulated::default()));
    seats.swap();
    seats.key(Key::W, true);
    let polled = (0..60).map(|_| seats.poll(CarState::default())).last().unwrap();
    assert_eq!((polled.semantic.throttle, polled.safety.throttle), (0, 65_535));
    assert_eq!(polled.status.each_ref().map(|s| s.place.as_str()), ["arrows", "W A S D"]);
}

#[test]
fn a_lost_safety_unit_is_no_intervention_and_stops_the_car() {
    let (mut seats, devices) = simulated(by_path());
    (0..2).for_each(|id| arm(&devices, id));
    axis(&devices, 0, THROTTLE, 255);
    axis(&devices, 1, WHEEL, 65_535);
    assert!(seats.poll(CarState::default()).ready());
    devices.push(RawEvent::Lost(1));
    let polled = seats.poll(CarState::default());
    assert_eq!((polled.safety, polled.semantic.throttle), (Controls::default(), 0));
    assert!(polled.semantic.brake_fraction() > 0.5);
    let taken = seats.poll(CarState { taken_over: true, ..CarState::default() });
    assert!(taken.safety.brake_fraction() > 0.5 && taken.safety.steer == 32_767, "the takeover goes on to a stop");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Both units are lost and come back at random moments of a drive; nothing of it is forgotten,
    /// and no unit that is away or not armed moves the car.
    #[test]
    fn loss_and_return_at_fifty_moments_are_safe_and_told(
        moments in prop::collection::vec((0usize..2, 1u32..40, any::<bool>(), any::<bool>()), 50),
        noise in prop::collection::vec((0usize..2, prop::sample::select(vec![WHEEL, THROTTLE, BRAKE]), any::<i32>()), 64),
    ) {
        let (mut seats, devices) = simulated(by_path());
        let (mut expected, mut told) = (Vec::new(), Vec::new());
        let (mut present, mut armed) = ([true; 2], [false; 2]);
        told.extend(kinds(&seats.poll(CarState::default())));
        expected.extend(SEATS.map(|seat| (seat, UnitEventKind::Bound)));
        let mut noise = noise.iter().cycle();
        for (id, ticks, rearm, taken_over) in moments {
            let (seat, path) = (SEATS[id], format!("/dev/input/event{}", 5 + id));
            if present[id] {
                devices.push(RawEvent::Lost(id));
                expected.push((seat, UnitEventKind::Lost));
                (present[id], armed[id]) = (false, false);
            } else {
                devices.push(RawEvent::Connected(device(id, &path)));
                expected.push((seat, UnitEventKind::Returned));
                present[id] = true;
                if rearm {
                    arm(&devices, id);
                    expected.push((seat, UnitEventKind::Armed));
                    armed[id] = true;
                }
            }
            for _ in 0..ticks {
                // Hands and feet of a driver whose unit is armed, and the late words of one that is gone.
                if let Some((id, code, value)) = noise.next().filter(|(id, ..)| armed[*id] || !present[*id]) {
                    axis(&devices, *id, *code, *value);
                }
                let polled = seats.poll(CarState { speed_mps: 9.0, taken_over });
                told.extend(kinds(&polled));
                prop_assert_eq!(polled.ready(), armed[0] && armed[1]);
                if !polled.ready() {
                    prop_assert!(polled.semantic.throttle == 0 && polled.semantic.brake_fraction() > 0.5);
                }
                if !armed[1] && !taken_over {
                    prop_assert_eq!(polled.safety, Controls::default());
                }
                if !armed[1] && taken_over {
                    prop_assert!(polled.safety.throttle == 0 && polled.safety.brake_fraction() > 0.5);
                }
                for controls in [polled.semantic, polled.safety] {
                    prop_assert!(controls.steer >= -32_767);
                }
            }
        }
        prop_assert_eq!(told, expected);
    }
}
