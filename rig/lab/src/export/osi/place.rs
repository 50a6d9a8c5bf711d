//! Places and directions in the coordinates of the map's OpenDRIVE file.

use std::f64::consts::PI;

use glam::{DVec3, Quat, Vec3};
use kernel::ops;
use kernel::time::Tick;
use replay::nanoseconds;

use super::messages::{BaseStationary, Dimension3d, Orientation3d, Timestamp, Vector3d};

const NANOSECONDS: u64 = 1_000_000_000;

/// Where the kernel's coordinates are in those of the map's file.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// What to add, metres to the east and to the north.
    pub origin_m: [f64; 2],
}

impl Frame {
    /// A place.
    pub fn place(self, at: Vec3) -> Vector3d {
        let [east_m, north_m] = self.origin_m;
        vector(at.as_dvec3() + DVec3::new(east_m, north_m, 0.0))
    }

    /// A box that stands on the ground or hangs, by its middle.
    pub fn stationary(self, middle: Vec3, orientation: Orientation3d, size_m: Vec3) -> BaseStationary {
        BaseStationary { dimension: dimension(size_m), position: self.place(middle), orientation }
    }
}

/// A direction, velocity or acceleration.
pub fn vector(of: DVec3) -> Vector3d {
    Vector3d { x: of.x, y: of.y, z: of.z }
}

/// Length, width and height.
pub fn dimension(size_m: Vec3) -> Dimension3d {
    let size_m = size_m.as_dvec3();
    Dimension3d { length: size_m.x, width: size_m.y, height: size_m.z }
}

/// The angles of a rotation from axes (x forward, y left, z up) to the world's.
pub fn orientation(rotation: Quat) -> Orientation3d {
    let [ahead, left, up] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| rotation * axis);
    Orientation3d {
        roll: angle(left.z, up.z),
        pitch: angle(-ahead.z, ops::hypot(ahead.x, ahead.y)),
        yaw: angle(ahead.y, ahead.x),
    }
}

/// That of what stands upright.
pub fn upright(heading_rad: f32) -> Orientation3d {
    Orientation3d { roll: 0.0, pitch: 0.0, yaw: f64::from(ops::wrap_angle(heading_rad)).clamp(-PI, PI) }
}

/// In [-pi, pi], which the nearest f32 to pi is not.
fn angle(y: f32, x: f32) -> f64 {
    f64::from(ops::atan2(y, x)).clamp(-PI, PI)
}

/// The time of a tick.
pub fn timestamp(tick: Tick) -> Timestamp {
    let time_ns = nanoseconds(tick);
    Timestamp { seconds: (time_ns / NANOSECONDS) as i64, nanos: (time_ns % NANOSECONDS) as u32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_turn_axes_as_the_rotation_does() {
        for (yaw, pitch, roll) in [(0.0, 0.0, 0.0), (3.1, 0.0, 0.0), (-2.0, 0.3, -0.2), (1.0, -1.2, 0.4)] {
            let (z, y, x) = (Quat::from_rotation_z(yaw), Quat::from_rotation_y(pitch), Quat::from_rotation_x(roll));
            let told = orientation(z * y * x);
            let off = [(told.yaw, yaw), (told.pitch, pitch), (told.roll, roll)];
            assert!(off.iter().all(|(told, set)| (told - f64::from(*set)).abs() < 1e-6), "{off:?}");
        }
        // Downhill, the nose is down: to the right-hand rule about the axis to the left.
        let downhill = Quat::from_rotation_arc(Vec3::X, Vec3::new(1.0, 0.0, -0.1).normalize());
        assert!(orientation(downhill).pitch > 0.09);
    }

    #[test]
    fn backwards_is_within_the_range_of_angles() {
        let back = orientation(Quat::from_xyzw(0.0, 0.0, 1.0, 0.0));
        assert!((PI - 1e-6..=PI).contains(&back.yaw.abs()));
        assert!(upright(std::f32::consts::PI).yaw <= PI);
    }

    #[test]
    fn places_are_those_of_the_file() {
        let frame = Frame { origin_m: [500_000.0, 5_400_000.0] };
        assert_eq!(frame.place(Vec3::new(1.5, -2.0, 3.0)), Vector3d { x: 500_001.5, y: 5_399_998.0, z: 3.0 });
    }

    #[test]
    fn a_tick_is_a_sixtieth_of_a_second() {
        assert_eq!(timestamp(0), Timestamp { seconds: 0, nanos: 0 });
        assert_eq!(timestamp(90), Timestamp { seconds: 1, nanos: 500_000_000 });
        let Timestamp { seconds, nanos } = timestamp(125);
        assert_eq!((seconds, nanos.abs_diff(83_333_333) <= 1), (2, true));
    }
}
