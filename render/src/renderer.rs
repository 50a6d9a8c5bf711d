//! The renderer: one map on one adapter.

use kernel::{RoadNetwork, SceneSnapshot};

use crate::{AdapterChoice, AdapterInfo, Camera, Frame, RenderError};

/// How much to draw. Classes, instances and depth are the same in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// [`Preset::Cheap`] on CPU adapters, [`Preset::Full`] on GPUs.
    #[default]
    Auto,
    /// Shadow of the static world, blobs under moving things, one sample a pixel.
    Cheap,
    /// Shadow of everything, nine colour samples a pixel.
    Full,
}

/// How to draw.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RenderOptions {
    /// With what.
    pub adapter: AdapterChoice,
    /// How much.
    pub preset: Preset,
}

/// Draws one map on one adapter.
pub struct Renderer {}

impl Renderer {
    /// Builds the map's static world on an adapter.
    pub fn new(_network: &RoadNetwork, _options: &RenderOptions) -> Result<Self, RenderError> {
        todo!()
    }

    /// Draws a snapshot and reads all planes back.
    pub fn draw(&mut self, _scene: &SceneSnapshot, _camera: &Camera) -> Result<Frame, RenderError> {
        todo!()
    }

    /// The adapter it draws with.
    pub fn adapter(&self) -> &AdapterInfo {
        todo!()
    }
}
