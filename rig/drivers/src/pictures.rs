//! What drivers at screens are shown, as people ask for it.

use perception::Compute;

/// How the live rig makes its pictures.
#[derive(Clone, Debug)]
pub struct Pictures {
    /// Size of the safety driver's picture, pixels.
    pub image_size: (u32, u32),
    /// Size of the semantic driver's mask, pixels (default: the checkpoint's own).
    pub mask_size: Option<(u32, u32)>,
    /// What computes the networks.
    pub inference: Compute,
    /// Monitors that the safety driver's view is spread over.
    pub screens: Screens,
}

/// Monitors that a view is spread over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screens {
    /// One.
    One,
    /// Three side by side.
    Three,
}
