//! Scenes drawn and looked at through several checkpoints.

use std::collections::BTreeSet;

use anyhow::Context;
use kernel::{RoadNetwork, SceneSnapshot};
use perception::Mask;
use render::{Camera, Frame, RenderOptions, Renderer};

use crate::cli::CheckpointChoice;
use crate::exit::Usage;
use crate::vision::Eye;

/// The eyes that a command line asks for, ready for pictures of one size.
pub fn open_eyes(choices: &[CheckpointChoice], size: (u32, u32)) -> anyhow::Result<Vec<Eye>> {
    let eyes = choices.iter().map(|choice| Eye::open_at(choice, size)).collect::<anyhow::Result<Vec<_>>>()?;
    let names: BTreeSet<&str> = eyes.iter().map(Eye::name).collect();
    if names.len() < eyes.len() {
        return Err(Usage("two checkpoints have the same file name; expected names that differ".into()).into());
    }
    Ok(eyes)
}

/// A renderer for the driver's camera, made anew when the map changes.
pub struct Studio {
    camera: Camera,
    options: RenderOptions,
    current: Option<(u128, Renderer)>,
}

impl Studio {
    /// For pictures of one size; fails where nothing can draw.
    pub fn new((width, height): (u32, u32)) -> anyhow::Result<Self> {
        let options = RenderOptions::default();
        options.adapter.find()?;
        Ok(Self { camera: Camera::driver(width, height), options, current: None })
    }

    /// The driver's view of a scene.
    pub fn draw(&mut self, network: &RoadNetwork, scene: &SceneSnapshot) -> anyhow::Result<Frame> {
        if self.current.as_ref().is_none_or(|(digest, _)| *digest != network.digest) {
            self.current = Some((network.digest, Renderer::new(network, &self.options)?));
        }
        let (_, renderer) = self.current.as_mut().context("a renderer")?;
        Ok(renderer.draw(scene, &self.camera)?)
    }
}

/// What each eye makes of a frame, as tag ids.
pub fn look(eyes: &mut [Eye], frame: &Frame) -> anyhow::Result<Vec<Mask>> {
    eyes.iter_mut().map(|eye| eye.see(frame.clone())).collect()
}
