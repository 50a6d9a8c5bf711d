//! Tileable textures of what roads and pavements show, drawn once: filtered in advance, they cost a pixel one sample.

mod asphalt;
mod paving;
pub(crate) mod plan;

use crate::tile::Tile;

/// Number of [`layers`].
pub(crate) const LAYERS: usize = 2;

/// The tile of asphalt and that of paving, each with its mip levels.
pub(crate) fn layers() -> [Vec<Vec<u8>>; LAYERS] {
    [asphalt::drawn(), paving::drawn()].map(Tile::levels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tile::CHANNELS;

    fn channel(layer: usize, channel: usize) -> Vec<f32> {
        let finest = &layers()[layer][0];
        finest.iter().skip(channel).step_by(CHANNELS).map(|v| f32::from(*v) / 255.0).collect()
    }

    fn mean(values: &[f32]) -> f32 {
        values.iter().sum::<f32>() / values.len() as f32
    }

    #[test]
    fn stones_are_as_bright_as_their_paint_and_joints_are_dark() {
        for bond in 0..CHANNELS {
            let texels = channel(1, bond);
            let joints = texels.iter().filter(|v| **v < 0.35).count() as f32 / texels.len() as f32;
            assert!((0.42..0.55).contains(&mean(&texels)), "{bond}: {}", mean(&texels));
            assert!((0.004..0.3).contains(&joints), "{bond}: {joints}");
        }
    }

    #[test]
    fn little_of_the_asphalt_is_marked() {
        for (at, most) in [(0, 0.06), (2, 0.01), (3, 0.15)] {
            let share = mean(&channel(0, at));
            assert!(share > 0.0005 && share < most, "{at}: {share}");
        }
        assert!((0.45..0.55).contains(&mean(&channel(0, 1))));
    }
}
