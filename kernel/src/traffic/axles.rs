//! Long vehicles have both axles on their way.

use glam::Vec3;

/// From the middle to an axle, as a share of the length.
pub(super) const AXLE: f32 = 0.28;

/// The middle of a long vehicle and its direction: both axles are on its way, which is asked for by the distance from its
/// middle, metres.
pub(super) fn on_axles(length_m: f32, mut way: impl FnMut(f32) -> Vec3) -> (Vec3, Vec3) {
    let to_axle_m = AXLE * length_m;
    let [rear, front] = [-to_axle_m, to_axle_m].map(&mut way);
    ((rear + front) * 0.5, (front - rear).normalize_or(Vec3::X))
}
