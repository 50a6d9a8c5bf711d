//! Devices as the system has them: a wheel and a gamepad played through /dev/uinput.
#![cfg(target_os = "linux")]

use std::time::Duration;

use evdev::uinput::VirtualDevice;
use evdev::{
    AbsInfo, AbsoluteAxisCode, AbsoluteAxisEvent, AttributeSet, BusType, InputId, KeyCode, KeyEvent, UinputAbsSetup,
};
use kernel::Seat;
use live::units::{CarState, Polled, SeatChoice, Seats, UnitEventKind, UnitState, UnitStatus};

/// A device and the axes of its wheel, throttle and brake: code, greatest value, rest.
struct Make {
    name: &'static str,
    /// Vendor, product and version.
    id: [u16; 3],
    axes: [(AbsoluteAxisCode, i32, i32); 3],
    /// Axes that mean nothing here.
    others: &'static [AbsoluteAxisCode],
    first_button: u16,
}

const WHEEL: Make = Make {
    name: "Logitech G29 Driving Force Racing Wheel",
    id: [0x046d, 0xc24f, 1],
    axes: [
        (AbsoluteAxisCode::ABS_X, 65_535, 32_768),
        (AbsoluteAxisCode::ABS_Z, 255, 255),
        (AbsoluteAxisCode::ABS_RZ, 255, 255),
    ],
    others: &[AbsoluteAxisCode::ABS_Y],
    first_button: 0x120,
};
/// A PS4 controller with an old driver, whose triggers are where others have a right stick: SDL knows.
const PAD: Make = Make {
    name: "A-Eye test pad",
    id: [0x054c, 0x05c4, 0x0111],
    axes: [(AbsoluteAxisCode::ABS_X, 255, 128), (AbsoluteAxisCode::ABS_RY, 255, 0), (AbsoluteAxisCode::ABS_RX, 255, 0)],
    others: &[AbsoluteAxisCode::ABS_Y, AbsoluteAxisCode::ABS_Z, AbsoluteAxisCode::ABS_RZ],
    first_button: 0x130,
};

impl Make {
    fn plug_in(&self) -> VirtualDevice {
        let keys: AttributeSet<KeyCode> = (0..10).map(|i| KeyCode(self.first_button + i)).collect();
        let [vendor, product, version] = self.id;
        let id = InputId::new(BusType::BUS_USB, vendor, product, version);
        let mut builder = VirtualDevice::builder().expect("uinput").name(self.name).input_id(id);
        builder = builder.with_keys(&keys).expect("keys");
        let others = self.others.iter().map(|code| (*code, 255, 128));
        for (code, max, rest) in self.axes.into_iter().chain(others) {
            let setup = UinputAbsSetup::new(code, AbsInfo::new(rest, 0, max, 0, 0, 1));
            builder = builder.with_absolute_axis(&setup).expect("an axis");
        }
        builder.build().expect("a device")
    }

    fn put(&self, device: &mut VirtualDevice, axis: usize, value: i32) {
        let code = self.axes[axis].0;
        device.emit(&[*AbsoluteAxisEvent::new(code, value)]).expect("an event");
    }

    /// Moves the wheel and each pedal, and lets go.
    fn arm(&self, device: &mut VirtualDevice) {
        for (axis, (_, max, rest)) in self.axes.into_iter().enumerate() {
            self.put(device, axis, if rest == max { 0 } else { max });
            self.put(device, axis, rest);
        }
    }

    fn press(&self, device: &mut VirtualDevice) {
        for value in [1, 0] {
            device.emit(&[*KeyEvent::new(KeyCode(self.first_button + 3), value)]).expect("an event");
        }
    }
}

fn path(device: &mut VirtualDevice) -> String {
    let mut nodes = device.enumerate_dev_nodes_blocking().expect("nodes").map(|node| node.expect("a node"));
    let node = nodes.find(|node| node.to_string_lossy().contains("/event")).expect("an event node");
    node.to_string_lossy().into_owned()
}

/// Asks the units again and again until it is so.
fn until(seats: &mut Seats, mut is_so: impl FnMut(&Polled) -> bool) -> Polled {
    for _ in 0..2000 {
        let polled = seats.poll(CarState::default());
        if is_so(&polled) {
            return polled;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("waited in vain: {:?}", seats.summary());
}

fn happened(polled: &Polled, seat: Seat, kind: UnitEventKind) -> bool {
    polled.events.iter().any(|event| (event.seat, event.kind) == (seat, kind))
}

#[test]
#[cfg_attr(no_uinput, ignore = "needs /dev/uinput")]
fn real_devices_are_armed_lost_and_given_back() {
    let (mut wheel, mut pad) = (WHEEL.plug_in(), PAD.plug_in());
    let choices = [SeatChoice::Device(path(&mut wheel)), SeatChoice::Device(path(&mut pad))];
    let mut seats = Seats::new(choices).expect("devices can be looked for");
    let is_there = |status: &UnitStatus| matches!(status.state, UnitState::Arming { .. });
    until(&mut seats, |polled| polled.status.iter().all(is_there));
    let summary = seats.summary().join("\n");
    assert!(summary.contains("a wheel that is known") && summary.contains("read as a gamepad"), "{summary}");

    WHEEL.arm(&mut wheel);
    PAD.arm(&mut pad);
    until(&mut seats, Polled::ready);
    WHEEL.put(&mut wheel, 1, 0);
    PAD.put(&mut pad, 2, 255);
    until(&mut seats, |polled| polled.semantic.throttle == 65_535 && polled.safety.brake == 65_535);
    PAD.put(&mut pad, 2, 0);

    drop(pad);
    let lost = until(&mut seats, |polled| happened(polled, Seat::Safety, UnitEventKind::Lost));
    assert!(lost.semantic.throttle == 0 && lost.semantic.brake > 0 && lost.safety.brake == 0, "{lost:?}");
    let mut pad = PAD.plug_in();
    until(&mut seats, |polled| happened(polled, Seat::Safety, UnitEventKind::Returned));
    PAD.arm(&mut pad);
    until(&mut seats, Polled::ready);

    drop(wheel);
    until(&mut seats, |polled| happened(polled, Seat::Semantic, UnitEventKind::Lost));
    let mut wheel = WHEEL.plug_in();
    until(&mut seats, |polled| happened(polled, Seat::Semantic, UnitEventKind::Returned));
    WHEEL.press(&mut wheel);
    WHEEL.arm(&mut wheel);
    assert!(until(&mut seats, Polled::ready).status.iter().all(|status| status.place.starts_with("/dev/input/")));
}
