//! Simulated wheels for the tests of this folder.

use super::source::{AxisRange, DeviceInfo};

/// A wheel with the axes of a G29, of no known make.
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
    }
}
