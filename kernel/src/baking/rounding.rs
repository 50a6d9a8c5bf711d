//! Rounding, in which the last bits of differing libm results vanish.

use glam::Vec3;

use crate::ops;

/// Rounds to 2^-10.
pub(super) fn snap(value: f32) -> f32 {
    ops::floor(value * 1024.0 + 0.5) / 1024.0
}

/// [`snap`] for each coordinate.
pub(super) fn snap3(v: Vec3) -> Vec3 {
    Vec3::new(snap(v.x), snap(v.y), snap(v.z))
}
