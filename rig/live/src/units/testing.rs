//! Simulated devices for tests.

use super::layout::{Layout, Trigger};
use super::source::{AxisRange, DeviceInfo};

/// That of most gamepads.
pub(crate) const LAYOUT: Layout = Layout {
    left_stick_x: 0,
    right_trigger: Trigger::Axis(5),
    left_trigger: Trigger::Axis(2),
    south: Some(0x130),
    east: Some(0x131),
    west: Some(0x134),
    north: Some(0x133),
    shoulders: [Some(0x136), Some(0x137)],
    middle: [Some(0x13a), Some(0x13b)],
};

/// A wheel with the axes of a G29, of no known make, that passes for a gamepad.
pub(super) fn device(id: usize, path: &str) -> DeviceInfo {
    let axis = |code, max| AxisRange { code, min: 0, max };
    DeviceInfo {
        id,
        path: path.into(),
        name: "simulated wheel".into(),
        vendor: 1,
        product: 2,
        axes: vec![axis(0, 65_535), axis(1, 255), axis(2, 255), axis(5, 255)],
        buttons: (0x120..0x138).collect(),
        layout: Some(LAYOUT),
    }
}
