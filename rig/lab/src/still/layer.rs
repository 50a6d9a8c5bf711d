//! The planes of a picture as files.

use std::str::FromStr;

use base::failure::Usage;
use base::png;
use render::Frame;

/// One of the planes of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layer {
    /// Colour.
    #[default]
    Rgb,
    /// Classes: the 23 tags of CARLA 0.9.10 as indices into a palette of their colours.
    Classes,
    /// Instances, 16 bits a pixel: 0 for none, an actor's id, 32768 and up for parked cars, 65535 for the ego car.
    Instances,
    /// Distance along the view, 16 bits a pixel as in KITTI's depth benchmark: 256 a metre, 0 for none, which the sky and
    /// what is 256 m away or farther have.
    Depth,
}

/// What stands for them in help.
pub const LAYERS: &str = "rgb|classes|instances|depth";

impl Layer {
    const ALL: [Self; 4] = [Self::Rgb, Self::Classes, Self::Instances, Self::Depth];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rgb => "rgb",
            Self::Classes => "classes",
            Self::Instances => "instances",
            Self::Depth => "depth",
        }
    }

    /// It of a picture, as a PNG file.
    pub fn png(self, frame: &Frame) -> anyhow::Result<Vec<u8>> {
        let size = (frame.width, frame.height);
        match self {
            Self::Rgb => png::rgb(size, &frame.rgb),
            Self::Classes => png::tags(size, &frame.class_ids),
            Self::Instances => png::grey16(size, &frame.instance_ids),
            Self::Depth => png::grey16(size, &frame.depth_m.iter().map(|m| depth_code(*m)).collect::<Vec<_>>()),
        }
    }
}

impl FromStr for Layer {
    type Err = Usage;

    fn from_str(text: &str) -> Result<Self, Usage> {
        let named = Self::ALL.into_iter().find(|layer| layer.name() == text);
        named
            .ok_or_else(|| Usage(format!("no such layer: {text:?}; expected {}", Self::ALL.map(Self::name).join(", "))))
    }
}

fn depth_code(depth_m: f32) -> u16 {
    let code = (depth_m * 256.0).round();
    if code <= f32::from(u16::MAX) { code as u16 } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_in_parts_of_a_metre_as_far_as_it_goes() {
        assert_eq!([0.5, 1.0, 255.996, 256.0, f32::INFINITY].map(depth_code), [128, 256, 65_535, 0, 0]);
    }

    #[test]
    fn layers_are_found_by_their_names() {
        assert!(Layer::ALL.iter().all(|layer| layer.name().parse() == Ok(*layer)));
        let sentence = "labels".parse::<Layer>().expect_err("no layer").to_string();
        assert_eq!(sentence, "no such layer: \"labels\"; expected rgb, classes, instances, depth");
    }
}
