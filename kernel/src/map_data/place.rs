//! A place on a way.

use glam::{Vec2, Vec3};

/// Less is no step from one way to the next, metres.
const STEP_M: f32 = 0.3;

/// A place on a lane or a way of pedestrians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Where, metres.
    pub position: Vec3,
    /// The direction of travel, a unit vector.
    pub forward: Vec3,
    /// Half of the width of the lane or way, metres.
    pub half_width_m: f32,
}

impl Place {
    /// Horizontal unit vector to the left.
    pub fn left(&self) -> Vec2 {
        Vec2::new(-self.forward.y, self.forward.x).normalize_or_zero()
    }

    /// Whether another place is about here, so that a way goes on there without a step.
    pub fn joins(&self, other: &Self) -> bool {
        self.position.distance_squared(other.position) < STEP_M * STEP_M
    }

    /// The place `offset_m` to the left.
    pub fn beside(&self, offset_m: f32) -> Vec3 {
        self.position + (self.left() * offset_m).extend(0.0)
    }
}
