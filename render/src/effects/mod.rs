//! What a camera's optics and chip make of what there is to see. Everything happens after a picture was read back, on the
//! processor and with operations that are exact by their standard, so that it is the same on every adapter.

mod chip;
mod lens;
mod lenses;
mod noise;
mod shutter;
mod tone;

use kernel::SceneSnapshot;

use self::lens::Lens;
pub(crate) use self::lenses::Lenses;
pub use self::lenses::check_lens;
use self::tone::Light;
use crate::{Camera, Frame};

/// What a camera with a sensor takes, from what the pinhole camera of its lens sees of a scene.
pub(crate) fn take(seen: Frame, scene: &SceneSnapshot, camera: &Camera, lens: &Lens) -> Frame {
    let sensor = &camera.sensor;
    if seen.rgb.is_empty() {
        return lens.labels(seen);
    }
    let mut light = Light::of(&seen.rgb);
    if sensor.motion_blur_s() > 0.0 {
        light = shutter::blurred(light, &seen, scene, (lens.pinhole(), sensor.motion_blur_s()));
    }
    let mut light = lens.bent(light);
    chip::expose(&mut light, camera);
    let rgb = noise::developed(&light, sensor.noise(), noise::seed(scene, camera));
    Frame { rgb, ..lens.labels(seen) }
}
