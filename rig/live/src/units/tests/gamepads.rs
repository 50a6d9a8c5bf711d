//! Gamepads that only SDL's mappings know, from plugging in to driving.

use super::*;
use crate::units::layout::{Layout, Trigger};
use crate::units::presets::g29;
use crate::units::source::AxisRange;

const PATH: &str = "/dev/input/event7";
/// Where this pad has what others have at 0, 5 and 2.
const STICK: u16 = 3;
const RIGHT: u16 = 16;
const LEFT: u16 = 17;
/// Its buttons, and its triggers where they are buttons.
const SOUTH: u16 = 0x121;
const EAST: u16 = 0x122;
const WEST: u16 = 0x123;
const NORTH: u16 = 0x120;
const SHOULDERS: [u16; 2] = [0x124, 0x125];
const MIDDLE: [u16; 2] = [0x128, 0x129];
const TRIGGERS: [u16; 2] = [0x127, 0x126];

/// A pad whose elements are elsewhere than those of others.
fn pad(id: usize, [right_trigger, left_trigger]: [Trigger; 2]) -> DeviceInfo {
    let axis = |code, min, max| AxisRange { code, min, max };
    let [south, east, west, north] = [SOUTH, EAST, WEST, NORTH].map(Some);
    let [shoulders, middle] = [SHOULDERS, MIDDLE].map(|codes| codes.map(Some));
    DeviceInfo {
        name: "odd pad".into(),
        axes: vec![axis(STICK, -100, 100), axis(RIGHT, 0, 1023), axis(LEFT, 0, 1023)],
        layout: Some(Layout {
            left_stick_x: STICK,
            right_trigger,
            left_trigger,
            south,
            east,
            west,
            north,
            shoulders,
            middle,
        }),
        ..device(id, PATH)
    }
}

fn with_axes(id: usize) -> DeviceInfo {
    pad(id, [RIGHT, LEFT].map(Trigger::Axis))
}

fn with_buttons(id: usize) -> DeviceInfo {
    pad(id, TRIGGERS.map(Trigger::Button))
}

/// The semantic driver's device, beside a bot.
fn seats(device: &DeviceInfo, calibrations: Vec<Calibration>) -> (Seats, Simulated) {
    let devices = Simulated::default();
    devices.push(RawEvent::Connected(device.clone()));
    let choices = [SeatChoice::Device(PATH.into()), SeatChoice::Bot];
    (Seats::with_source(choices, calibrations, Box::new(devices.clone())), devices)
}

fn button(devices: &Simulated, device: usize, code: u16, pressed: bool) {
    devices.push(RawEvent::Button { device, code, pressed });
}

fn pull_and_release_buttons(devices: &Simulated, device: usize) {
    for code in TRIGGERS {
        button(devices, device, code, true);
        button(devices, device, code, false);
    }
}

fn semantic(seats: &mut Seats) -> Controls {
    let polled = seats.poll(CarState::default());
    assert!(polled.ready(), "{:?}", polled.status);
    polled.semantic
}

#[test]
fn a_pad_that_only_sdl_knows_is_armed_and_drives() {
    let (mut seats, devices) = seats(&with_axes(0), Vec::new());
    assert!(
        seats.summary()[0]
            .ends_with("read as a gamepad: left stick steers, right trigger is throttle, left trigger brake")
    );
    for (code, value) in [(0, 60_000), (5, 255), (2, 255)] {
        axis(&devices, 0, code, value);
    }
    let status = seats.poll(CarState::default()).status;
    assert!(status[0].to_string().contains("move the left stick aside, pull the right trigger, pull the left trigger"));
    for (code, moved) in [(STICK, 100), (RIGHT, 1023), (LEFT, 1023)] {
        axis(&devices, 0, code, moved);
        axis(&devices, 0, code, 0);
    }
    assert_eq!(semantic(&mut seats), Controls::default());
    axis(&devices, 0, STICK, -100);
    axis(&devices, 0, RIGHT, 1023);
    let controls = semantic(&mut seats);
    assert_eq!((controls.steer, controls.throttle, controls.brake), (-32_767, 65_535, 0));
    axis(&devices, 0, LEFT, 1023);
    [SOUTH, EAST, WEST].into_iter().for_each(|code| button(&devices, 0, code, true));
    let controls = semantic(&mut seats);
    assert_eq!((controls.brake, controls.flags), (65_535, Controls::HAND_BRAKE | Controls::REVERSE | Controls::SEEN));
    [NORTH, MIDDLE[0], MIDDLE[1], SHOULDERS[0], SHOULDERS[1]]
        .into_iter()
        .for_each(|code| button(&devices, 0, code, true));
    assert_eq!(semantic(&mut seats).flags, Controls::ALL_FLAGS);
}

#[test]
fn triggers_that_are_buttons_arm_a_pad_and_are_its_pedals() {
    let (mut seats, devices) = seats(&with_buttons(0), Vec::new());
    axis(&devices, 0, STICK, 100);
    axis(&devices, 0, STICK, 0);
    button(&devices, 0, TRIGGERS[0], true);
    button(&devices, 0, TRIGGERS[1], true);
    button(&devices, 0, TRIGGERS[1], false);
    let polled = seats.poll(CarState::default());
    assert_eq!(polled.status[0].to_string(), "odd pad: to arm it, release the right trigger");
    assert!(polled.semantic.throttle == 0 && polled.semantic.brake > 0);
    button(&devices, 0, TRIGGERS[0], false);
    let polled = seats.poll(CarState::default());
    assert!(polled.ready() && kinds(&polled) == [(Seat::Semantic, UnitEventKind::Armed)]);
    // An axis with the code of a button, as other systems number them, is something else.
    axis(&devices, 0, TRIGGERS[1], 1);
    button(&devices, 0, TRIGGERS[0], true);
    let controls = semantic(&mut seats);
    assert_eq!((controls.throttle, controls.brake), (65_535, 0));
    button(&devices, 0, TRIGGERS[0], false);
    button(&devices, 0, TRIGGERS[1], true);
    let controls = semantic(&mut seats);
    assert_eq!((controls.throttle, controls.brake), (0, 65_535));
}

#[test]
fn a_pad_that_is_lost_with_a_trigger_pulled_comes_back_released_and_unarmed() {
    let (mut seats, devices) = seats(&with_buttons(0), Vec::new());
    let arm = |id| {
        axis(&devices, id, STICK, 100);
        axis(&devices, id, STICK, 0);
        pull_and_release_buttons(&devices, id);
    };
    arm(0);
    button(&devices, 0, TRIGGERS[0], true);
    assert_eq!(semantic(&mut seats).throttle, 65_535);
    devices.push(RawEvent::Lost(0));
    let polled = seats.poll(CarState::default());
    assert!(kinds(&polled) == [(Seat::Semantic, UnitEventKind::Lost)] && polled.semantic.brake > 0);
    devices.push(RawEvent::Connected(with_buttons(1)));
    button(&devices, 1, TRIGGERS[0], false);
    let polled = seats.poll(CarState::default());
    assert!(kinds(&polled) == [(Seat::Semantic, UnitEventKind::Returned)] && !polled.ready());
    assert_eq!((polled.semantic.throttle, polled.status[0].trouble().is_some()), (0, true));
    arm(1);
    assert_eq!(semantic(&mut seats), Controls::default());
}

#[test]
fn an_unknown_device_with_axes_for_all_is_no_gamepad_and_says_how_to_calibrate_it() {
    let unknown = DeviceInfo { layout: None, ..with_axes(0) };
    let (mut seats, devices) = seats(&unknown, Vec::new());
    let said = seats.summary()[0].clone();
    assert!(said.contains(&format!("of no use before aeye wheel calibrate --device {PATH} --out")), "{said}");
    axis(&devices, 0, RIGHT, 1023);
    let polled = seats.poll(CarState::default());
    assert!(!polled.ready() && polled.events.is_empty(), "{polled:?}");
}

#[test]
fn a_calibration_wins_over_the_layout() {
    let mut own = g29();
    own.device = "odd pad".into();
    own.steering.axis = RIGHT;
    let (seats, _) = seats(&with_axes(0), vec![own.clone()]);
    assert!(seats.summary()[0].ends_with("read by its calibration file"), "{:?}", seats.summary());
    assert_eq!(calibration_of(&[own.clone()], &with_axes(0)), Some(own));
}
