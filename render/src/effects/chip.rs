//! How much light each pixel gets: vignetting and exposure.

use kernel::ops;

use super::tone::Light;
use crate::Camera;

/// Exposes a camera's picture.
pub(super) fn expose(light: &mut Light, camera: &Camera) {
    let (exposure_ev, vignetting) = (camera.sensor.exposure_ev(), camera.sensor.vignetting());
    if exposure_ev == 0.0 && vignetting == 0.0 {
        return;
    }
    let gain = ops::pow(2.0, exposure_ev);
    // Focal lengths a pixel.
    let pitch = 2.0 * ops::tan(0.5 * camera.fov_x_rad) / camera.width as f32;
    let aside = |at: usize, side: u32| (at as f32 + 0.5 - 0.5 * side as f32) * pitch;
    for (y, row) in light.0.chunks_exact_mut(camera.width as usize).enumerate() {
        let down = aside(y, camera.height);
        for (x, pixel) in row.iter_mut().enumerate() {
            let right = aside(x, camera.width);
            let share = gain * (1.0 - vignetting * (1.0 - cos4(right * right + down * down)));
            *pixel = pixel.map(|light| light * share);
        }
    }
}

/// The fourth power of the cosine of the angle whose tangent has this square.
fn cos4(tan2: f32) -> f32 {
    let cos2 = 1.0 / (1.0 + tan2);
    cos2 * cos2
}
