//! From the colours of a picture to the light that they stand for, and back.

/// The renderer's tone curve (`scene.wgsl`): a light is drawn as sqrt(SHARE light / (light + HALF)).
const HALF: f32 = 0.55;
const SHARE: f32 = 1.42;

/// The light of a picture: red, green and blue of each pixel, linear, in the renderer's units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Light(pub(super) Vec<[f32; 3]>);

impl Light {
    /// That of a picture of 3 bytes a pixel. What is white may have been lighter: that is lost, as in a camera.
    pub(super) fn of(rgb: &[u8]) -> Self {
        let table: [f32; 256] = core::array::from_fn(|byte| light_of(byte as f32));
        Self(rgb.as_chunks::<3>().0.iter().map(|pixel| pixel.map(|byte| table[usize::from(byte)])).collect())
    }
}

/// The light of a colour from 0 to 255.
pub(super) fn light_of(colour: f32) -> f32 {
    let drawn = colour / 255.0;
    let share = drawn * drawn / SHARE;
    HALF * share / (1.0 - share)
}

/// The colour of a light, 0 and up; 255 is white. Exact operations alone, the same everywhere.
pub(super) fn colour_of(light: f32) -> f32 {
    255.0 * (SHARE * light / (light + HALF)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_and_colour_are_each_others_inverse() {
        assert!((0..=255u8).all(|byte| colour_of(light_of(f32::from(byte))).round() as u8 == byte));
        assert_eq!((light_of(0.0), colour_of(0.0)), (0.0, 0.0));
    }

    #[test]
    fn the_curve_is_that_of_the_shader() {
        let shader = include_str!("../shaders/scene.wgsl");
        assert!(shader.contains(&format!("sqrt(lit / (lit + {HALF}) * {SHARE})")));
    }
}
