//! Where the picture is taken from.

use glam::{Quat, Vec3};
use kernel::scene::EgoScene;

use crate::models::ModelsId;
use crate::{Imaging, Quality, Sensor};

/// What a camera is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mount {
    /// The ego car: moves and turns with it.
    Ego,
    /// The ego car's place: moves with it, keeps its direction in the world.
    EgoPlace,
    /// The world.
    World,
}

/// A camera: a pinhole, behind which a sensor may change the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// What it is fixed to.
    pub mount: Mount,
    /// Position in the mount's frame, metres.
    pub position: Vec3,
    /// Rotation from the camera's axes (x along the view, y left, z up) to the mount's.
    pub rotation: Quat,
    /// Horizontal field of view, radians, (0, pi).
    pub fov_x_rad: f32,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// How good its pictures are.
    pub quality: Quality,
    /// What its lens and its chip make of them.
    pub sensor: Sensor,
    /// Models of a user's own that stand for what it sees.
    pub models: Option<ModelsId>,
}

/// From optical axes (x right, y down, z along the view) to those of a [`Camera`].
pub const OPTICAL: Quat = Quat::from_xyzw(-0.5, 0.5, -0.5, 0.5);

/// From [`EgoScene::position`] (below the rear axle) to the middle of the ego car's footprint, metres
/// forward.
pub const EGO_MIDDLE_M: f32 = kernel::ego::CENTRE_M.x;

impl Camera {
    /// The camera both drivers see through: on the ego car, 1.2 m forward of its middle, 1.5 m high,
    /// level, 90 degrees horizontal field of view.
    pub fn driver(width: u32, height: u32) -> Self {
        let position = Vec3::new(EGO_MIDDLE_M + 1.2, 0.0, 1.5);
        Self { mount: Mount::Ego, position, ..Self::level(width, height) }
    }

    /// The driver's cameras for three screens side by side, left one first: 60 degrees each, which
    /// together see 180 degrees.
    pub fn driver_row(width: u32, height: u32) -> [Self; 3] {
        let turn_rad = core::f32::consts::FRAC_PI_3;
        [turn_rad, 0.0, -turn_rad].map(|yaw_rad| Self {
            rotation: Quat::from_rotation_z(yaw_rad),
            fov_x_rad: turn_rad,
            ..Self::driver(width, height)
        })
    }

    /// Behind and above the ego car, which is in the picture.
    pub fn chase(width: u32, height: u32) -> Self {
        let position = Vec3::new(-6.5, 0.0, 3.2);
        let rotation = Quat::from_rotation_y(0.16);
        Self { mount: Mount::Ego, position, rotation, ..Self::level(width, height) }
    }

    /// Straight down on the ego car, north up, `span_m` metres of ground from left to right.
    pub fn top(width: u32, height: u32, span_m: f32) -> Self {
        let fov_x_rad = 0.5;
        let above = 0.5 * span_m / kernel::ops::tan(0.5 * fov_x_rad);
        // The view's x axis looks down, its z axis (up in the picture) points north, its y axis west.
        let rotation = Quat::from_mat3(&glam::Mat3::from_cols(Vec3::NEG_Z, Vec3::NEG_X, Vec3::Y));
        let position = Vec3::new(0.0, 0.0, above);
        Self { mount: Mount::EgoPlace, position, rotation, fov_x_rad, ..Self::level(width, height) }
    }

    fn level(width: u32, height: u32) -> Self {
        let fov_x_rad = core::f32::consts::FRAC_PI_2;
        let Imaging { quality, sensor, models } = Imaging::default();
        let (position, rotation) = (Vec3::ZERO, Quat::IDENTITY);
        Self { mount: Mount::World, position, rotation, fov_x_rad, width, height, quality, sensor, models }
    }

    /// The same with pictures of another kind; of a quality alone, by an ideal sensor.
    pub fn at(self, imaging: impl Into<Imaging>) -> Self {
        let Imaging { quality, sensor, models } = imaging.into();
        Self { quality, sensor, models, ..self }
    }

    /// How it makes its pictures.
    pub fn imaging(&self) -> Imaging {
        Imaging { quality: self.quality, sensor: self.sensor, models: self.models }
    }

    /// What moves its pixels from where the pinhole has them: k1, k2, p1, p2 and k3 of OpenCV.
    pub fn distortion(&self) -> [f64; 5] {
        let [k1, k2] = self.sensor.distortion().map(f64::from);
        [k1, k2, 0.0, 0.0, 0.0]
    }

    /// What its pixels are, row by row as a 3x3 matrix: square, the middle of the first one at (0.5, 0.5), before
    /// [`Camera::distortion`].
    pub fn intrinsics(&self) -> [f64; 9] {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        let focal = 0.5 * width / f64::from(kernel::ops::tan(0.5 * self.fov_x_rad));
        [focal, 0.0, 0.5 * width, 0.0, focal, 0.5 * height, 0.0, 0.0, 1.0]
    }

    /// Position and rotation in the world.
    pub fn pose(&self, ego: &EgoScene) -> (Vec3, Quat) {
        match self.mount {
            Mount::Ego => (ego.position + ego.rotation * self.position, ego.rotation * self.rotation),
            Mount::EgoPlace => (ego.position + self.position, self.rotation),
            Mount::World => (self.position, self.rotation),
        }
    }
}
