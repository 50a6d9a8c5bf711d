//! What a camera is, and the pictures that it took.

use foxglove::messages::{CameraCalibration, CompressedImage};
pub use render::camera::OPTICAL;

use render::Camera;

use super::parts::stamp;

/// Frame of the optical axes of the drivers' camera: x right, y down, z along the view.
pub const CAMERA: &str = "camera";

/// That of another camera.
pub fn frame_of(name: &str) -> String {
    format!("cameras/{name}")
}

/// What the pixels of the camera in a frame are: square, and where its lens shows them.
pub fn calibration(camera: &Camera, frame: &str, time_ns: u64) -> CameraCalibration {
    let k = camera.intrinsics();
    let [fx, _, cx, _, fy, cy, ..] = k;
    CameraCalibration {
        timestamp: stamp(time_ns),
        frame_id: frame.into(),
        width: camera.width,
        height: camera.height,
        distortion_model: "plumb_bob".into(),
        d: camera.distortion().to_vec(),
        k: k.to_vec(),
        r: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: vec![fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
    }
}

/// A picture that the camera in a frame took, a PNG file.
pub fn image(png: Vec<u8>, frame: &str, time_ns: u64) -> CompressedImage {
    CompressedImage { timestamp: stamp(time_ns), frame_id: frame.into(), data: png.into(), format: "png".into() }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn optical_axes_are_right_down_and_ahead() {
        let near = |axis: Vec3, expected: Vec3| assert!((OPTICAL * axis).distance(expected) < 1e-6);
        near(Vec3::Z, Vec3::X);
        near(Vec3::X, Vec3::NEG_Y);
        near(Vec3::Y, Vec3::NEG_Z);
    }

    #[test]
    fn the_calibration_sees_as_wide_as_the_camera() {
        let camera = Camera::driver(512, 256);
        let k = calibration(&camera, CAMERA, 0).k;
        let half_width = (k[2] / k[0]).atan();
        assert!((2.0 * half_width - f64::from(camera.fov_x_rad)).abs() < 1e-6);
        assert_eq!((k[0], k[5]), (k[4], 128.0));
    }
}
