//! Where the pictures of leaves show air.

use glam::DVec2;
use render::leaves;

/// What is leaf of each picture, texel by texel.
pub struct Air {
    leaf: Vec<Vec<bool>>,
}

impl Air {
    pub fn new() -> Self {
        let finest = |levels: &Vec<Vec<u8>>| levels[0].chunks(2).map(|texel| texel[0] >= leaves::THRESHOLD).collect();
        Self { leaf: leaves::layers().iter().map(finest).collect() }
    }

    /// Whether there is air at a place of a picture, which repeats.
    pub fn is_at(&self, leaf: u8, uv: DVec2) -> bool {
        let texel = |share: f64| (share.rem_euclid(1.0) * f64::from(leaves::SIDE)) as usize % leaves::SIDE as usize;
        !self.leaf[leaf as usize][texel(uv.y) * leaves::SIDE as usize + texel(uv.x)]
    }
}
