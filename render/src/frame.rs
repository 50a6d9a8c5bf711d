//! What a draw gives.

use kernel::time::Tick;

/// One image with its ground truth. All planes come from one draw, which may leave the colours out; rows from top to bottom, pixels
/// from left to right.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Tick of the snapshot that was drawn.
    pub tick: Tick,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Colour, 3 bytes a pixel: red, green, blue (sRGB); empty where it was left out.
    pub rgb: Vec<u8>,
    /// Class, one of the 23 tags of CARLA 0.9.10 a pixel ([`crate::tags::TAGS`]).
    pub class_ids: Vec<u8>,
    /// Class as a [`crate::SemanticTag`], which tells riders, lorries, buses and two-wheelers apart.
    pub fine_ids: Vec<u8>,
    /// Instance: 0 for none, an actor's id (1 to 32767), 32768 and up for parked cars, 65535 for the ego.
    pub instance_ids: Vec<u16>,
    /// Distance from the camera along its viewing direction, metres; infinite for the sky.
    pub depth_m: Vec<f32>,
}

impl Frame {
    /// Class plane in the tags' colours, 3 bytes a pixel.
    pub fn class_colours(&self) -> Vec<u8> {
        crate::tags::colours(&self.class_ids)
    }
}
