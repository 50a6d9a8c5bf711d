//! What drivers at screens are shown, as people ask for it.

use perception::Compute;
use render::Imaging;

/// How the live rig makes its pictures.
#[derive(Clone, Debug)]
pub struct Pictures {
    /// Size of the safety driver's picture, pixels.
    pub image_size: (u32, u32),
    /// Size of the semantic driver's mask, pixels (default: the checkpoint's own).
    pub mask_size: Option<(u32, u32)>,
    /// How the pictures are made that the network looks at.
    pub imaging: Imaging,
    /// What computes the networks.
    pub inference: Compute,
    /// Monitors that the safety driver's view is spread over.
    pub screens: Screens,
}

impl Pictures {
    /// Size and kind of the pictures that networks look at.
    pub fn of_networks(&self) -> (Option<(u32, u32)>, Imaging) {
        (self.mask_size, self.imaging)
    }
}

/// Monitors that a view is spread over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screens {
    /// One.
    One,
    /// Three side by side.
    Three,
}
