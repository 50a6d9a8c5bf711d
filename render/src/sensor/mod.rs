//! What a camera has that an ideal one has not.

mod text;

/// What tells a real camera's picture from an ideal one's. Its values are finite and within their limits: it comes from its
/// text alone, as in `exposure_ev=-1,noise=4`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensor {
    exposure_ev: f32,
    noise: f32,
    k1: f32,
    k2: f32,
    motion_blur_s: f32,
    vignetting: f32,
}

// No value is NaN.
impl Eq for Sensor {}

impl Sensor {
    /// Whether it changes nothing.
    pub fn is_ideal(&self) -> bool {
        *self == Self::default()
    }

    /// How much lighter it exposes than the renderer, stops.
    pub fn exposure_ev(&self) -> f32 {
        self.exposure_ev
    }

    /// Standard deviation of its noise at mid-grey, in steps of 8 bits.
    pub fn noise(&self) -> f32 {
        self.noise
    }

    /// Radial distortion as OpenCV has it, k1 and k2: a point at the distance r from the middle, in focal lengths, is seen at
    /// r (1 + k1 r^2 + k2 r^4).
    pub fn distortion(&self) -> [f32; 2] {
        [self.k1, self.k2]
    }

    /// How long its shutter is open, seconds; the picture's tick is in the middle.
    pub fn motion_blur_s(&self) -> f32 {
        self.motion_blur_s
    }

    /// How much of the natural fall of light towards the corners, by the fourth power of the cosine, it lets happen, 0 to 1.
    pub fn vignetting(&self) -> f32 {
        self.vignetting
    }

    /// Whether pixels show other places than those of a pinhole camera.
    pub(crate) fn distorts(&self) -> bool {
        self.distortion() != [0.0; 2]
    }
}
