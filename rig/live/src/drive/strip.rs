//! A corner case at a glance: frames of its last seconds, images above, true classes below.

use std::path::Path;
use std::sync::Arc;

use base::image::Image;
use kernel::time::CLIP_TICKS;
use measures::footage::Footage;
use render::{AdapterChoice, Camera, Renderer};

/// Frames a second.
const FPS: u32 = 2;
/// Size of a frame, pixels.
const SIZE: (u32, u32) = (192, 108);

/// A strip of frames.
#[derive(Debug)]
pub struct Strip {
    /// The case's name.
    pub name: String,
    /// The frames.
    pub image: Arc<Image>,
}

impl Strip {
    /// That of a case.
    pub fn of(case: &Path) -> anyhow::Result<Self> {
        let footage = Footage::read(case, CLIP_TICKS, FPS)?;
        let mut renderer = Renderer::new(&footage.network, &AdapterChoice::default())?;
        let camera = Camera::driver(SIZE.0, SIZE.1).at(renderer.quality_for_people());
        let (mut images, mut classes) = (Vec::new(), Vec::new());
        for scene in &footage.scenes {
            let frame = renderer.draw(scene, &camera)?;
            classes.push(Image::of_classes(&frame));
            images.push(Image::of(frame));
        }
        let image = Image::side_by_side(&images).above(Image::side_by_side(&classes));
        Ok(Self { name: footage.name, image: Arc::new(image) })
    }
}
