//! A camera in the world: what it sees and how large.

use glam::{Vec2, Vec3};
use kernel::ops;
use kernel::scene::EgoScene;

use crate::Camera;
use crate::mesh::model::Detail;

/// A camera's axes in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub(crate) eye: Vec3,
    pub(crate) ahead: Vec3,
    pub(crate) right: Vec3,
    pub(crate) up: Vec3,
    /// Tangents of half the fields of view.
    pub(crate) tan_x: f32,
    pub(crate) tan_y: f32,
    /// Size in pixels of one metre, one metre ahead.
    pub(crate) pixels_per_m: f32,
}

/// A view is steep whose level share is less than this: one that looks down by more than 60 degrees.
const STEEP: f32 = 0.5;

impl View {
    pub(crate) fn new(camera: &Camera, ego: &EgoScene) -> Self {
        let (eye, rotation) = camera.pose(ego);
        let tan_x = ops::tan(0.5 * camera.fov_x_rad);
        let (width, height) = (camera.width as f32, camera.height as f32);
        Self {
            eye,
            ahead: rotation * Vec3::X,
            right: rotation * Vec3::NEG_Y,
            up: rotation * Vec3::Z,
            tan_x,
            tan_y: tan_x * height / width,
            pixels_per_m: 0.5 * width / tan_x,
        }
    }

    /// The view of a picture of this size as its pixels' corners see it, of which it has one column and one row more.
    pub(crate) fn at_corners(self, width: u32, height: u32) -> Self {
        let wider = |tan: f32, side: u32| tan * ((side + 1) as f32 / side as f32);
        Self { tan_x: wider(self.tan_x, width), tan_y: wider(self.tan_y, height), ..self }
    }

    /// Which way it looks, level, as long as 1; shorter where it looks so steeply that it sees as much of what lies behind, and zero
    /// straight down or up.
    pub(crate) fn level_ahead(ahead: Vec3) -> Vec2 {
        let flat = ahead.truncate();
        flat * (1.0 / flat.length().max(STEEP))
    }

    /// Whether any of a sphere can be in the picture.
    pub(crate) fn sees(&self, centre: Vec3, radius_m: f32) -> bool {
        let rel = centre - self.eye;
        let depth = rel.dot(self.ahead);
        let inside = |across: f32, tan: f32| across.abs() - depth * tan <= radius_m * ops::sqrt(1.0 + tan * tan);
        depth > -radius_m && inside(rel.dot(self.right), self.tan_x) && inside(rel.dot(self.up), self.tan_y)
    }

    /// Size in pixels of `size_m` at the near side of a sphere.
    pub(crate) fn pixels(&self, size_m: f32, centre: Vec3, radius_m: f32) -> f32 {
        let near = (centre.distance(self.eye) - radius_m).max(0.5);
        size_m * self.pixels_per_m / near
    }
}

/// A level of detail serves when it differs from the finest by less than this many pixels.
const ERROR_PX: f32 = 0.5;

impl View {
    /// The roughest level of detail that serves for what lies in a sphere.
    pub(crate) fn detail(&self, centre: Vec3, radius_m: f32) -> Detail {
        let serves = |d: &Detail| self.pixels(d.error_m(), centre, radius_m) < ERROR_PX;
        Detail::ALL.into_iter().rev().find(serves).unwrap_or(Detail::Fine)
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;

    fn view() -> View {
        let ego =
            EgoScene { position: Vec3::ZERO, rotation: Quat::IDENTITY, speed_mps: 0.0, wheel_angle_rad: 0.0, lamps: 0 };
        View::new(&Camera::driver(256, 128), &ego)
    }

    #[test]
    fn spheres_beside_and_behind_are_not_seen() {
        let view = view();
        assert!(view.sees(Vec3::new(30.0, 0.0, 1.0), 1.0));
        assert!(view.sees(Vec3::new(30.0, 28.5, 1.0), 1.5), "touches the left edge");
        assert!(!view.sees(Vec3::new(30.0, 32.0, 1.0), 1.0));
        assert!(!view.sees(Vec3::new(-10.0, 0.0, 1.0), 1.0));
    }

    #[test]
    fn a_metre_at_64_m_is_two_pixels_of_256() {
        let centre = view().eye + Vec3::X * 64.0;
        assert!((view().pixels(1.0, centre, 0.0) - 2.0).abs() < 1e-3);
    }
}
