//! Scenes drawn and looked at through several checkpoints.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use drivers::checkpoint::{CheckpointChoice, check_names};
use drivers::vision::{DEFAULT_SIZE, Eye};
use kernel::{RoadNetwork, SceneSnapshot};
use perception::Mask;
use render::{AdapterChoice, Camera, Frame, Imaging, Renderer};

/// The eyes that a command line asks for, and the size of the pictures that they all look at: the one that is
/// asked for, else that which the first network takes. Others see those pictures resampled.
pub fn open_eyes(choices: &[CheckpointChoice], size: Option<Size>) -> anyhow::Result<(Vec<Eye>, Size)> {
    check_names(choices)?;
    let size = match size {
        Some(size) => size,
        None => own_size(choices)?,
    };
    let eyes = choices.iter().map(|choice| Eye::open_at(choice, size)).collect::<anyhow::Result<Vec<_>>>()?;
    Ok((eyes, size))
}

/// Width and height of pictures, pixels.
pub type Size = (u32, u32);

fn own_size(choices: &[CheckpointChoice]) -> anyhow::Result<Size> {
    match choices.iter().find(|choice| **choice != CheckpointChoice::Truth) {
        Some(network) => Ok(Eye::open(network)?.size()),
        None => Ok(DEFAULT_SIZE),
    }
}

/// A renderer for each map, all with the driver's camera.
pub struct Studio {
    camera: Camera,
    /// By digest of the map.
    renderers: BTreeMap<u128, Renderer>,
}

impl Studio {
    /// For pictures of one size, made in one way.
    pub fn new((width, height): (u32, u32), imaging: Imaging) -> Self {
        Self { camera: Camera::driver(width, height).at(imaging), renderers: BTreeMap::new() }
    }

    /// The driver's camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The driver's view of a scene; fails where nothing can draw.
    pub fn draw(&mut self, network: &RoadNetwork, scene: &SceneSnapshot) -> anyhow::Result<Frame> {
        let camera = self.camera;
        self.draw_through(network, scene, &camera)
    }

    /// What any camera sees of it.
    pub fn draw_through(
        &mut self,
        network: &RoadNetwork,
        scene: &SceneSnapshot,
        camera: &Camera,
    ) -> anyhow::Result<Frame> {
        let renderer = match self.renderers.entry(network.digest) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(Renderer::new(network, &AdapterChoice::default())?),
        };
        Ok(renderer.draw(scene, camera)?)
    }
}

/// What each eye makes of a frame, as tag ids.
pub fn look(eyes: &mut [Eye], frame: &Frame) -> anyhow::Result<Vec<Mask>> {
    eyes.iter_mut().map(|eye| eye.see(frame.clone())).collect()
}
