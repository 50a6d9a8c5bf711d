//! Directions and rectangles on the ground.

use glam::{Quat, Vec2};

use crate::ops;

/// The unit vector of a heading.
pub fn direction(heading_rad: f32) -> Vec2 {
    Vec2::new(ops::cos(heading_rad), ops::sin(heading_rad))
}

/// The rotation about the vertical that turns east to a heading.
pub fn rotation(heading_rad: f32) -> Quat {
    let half = 0.5 * heading_rad;
    Quat::from_xyzw(0.0, 0.0, ops::sin(half), ops::cos(half))
}
