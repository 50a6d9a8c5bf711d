//! The topics of a camera: what it is, its pictures, and the ground truth of these. Images are named as `image_transport`
//! expects.

use base::failure::Usage;
use base::png;
use render::{Camera, Frame};
use replay::nanoseconds;

use super::bag::{Bag, Durability, Topic};
use super::messages::{CameraInfo, CompressedImage};
use super::tell;
use super::token::token;
use crate::cameras::Named;

/// Those of one.
pub struct Pictures {
    /// Of its optical axes.
    pub frame: String,
    info: Topic<CameraInfo>,
    rgb: Topic<CompressedImage>,
    truth: Topic<CompressedImage>,
}

impl Pictures {
    /// Those of the drivers' camera.
    pub fn of_driver(bag: &mut Bag) -> anyhow::Result<Self> {
        Self::below("/camera", tell::OPTICAL_FRAME.to_owned(), bag)
    }

    /// Those of another one.
    pub fn of(named: &Named, bag: &mut Bag) -> anyhow::Result<Self> {
        let name = token(&named.name);
        Self::below(&format!("/cameras/{name}"), format!("cameras/{name}_optical_frame"), bag)
    }

    fn below(top: &str, frame: String, bag: &mut Bag) -> anyhow::Result<Self> {
        Ok(Self {
            frame,
            info: bag.topic(&format!("{top}/camera_info"), Durability::Volatile)?,
            rgb: bag.topic(&format!("{top}/image_raw/compressed"), Durability::Volatile)?,
            truth: bag.topic(&format!("{top}/truth/compressed"), Durability::Volatile)?,
        })
    }

    /// Writes what the camera saw.
    pub fn put(&self, bag: &mut Bag, camera: &Camera, seen: &Frame) -> anyhow::Result<()> {
        let (tick, time_ns, size) = (seen.tick, nanoseconds(seen.tick), (seen.width, seen.height));
        bag.put(&self.info, tick, &tell::camera_info(camera, &self.frame, time_ns))?;
        bag.put(&self.rgb, tick, &tell::picture(png::rgb(size, &seen.rgb)?, &self.frame, time_ns))?;
        bag.put(&self.truth, tick, &tell::mask(png::grey(size, &seen.class_ids)?, &self.frame, time_ns))
    }
}

/// Refuses cameras that would have the same topics.
pub fn check_names(cameras: &[Named]) -> anyhow::Result<()> {
    for (i, one) in cameras.iter().enumerate() {
        if let Some(other) = cameras[..i].iter().find(|other| token(&other.name) == token(&one.name)) {
            let (a, b, name) = (&other.name, &one.name, token(&one.name));
            let said = format!("cameras {a:?} and {b:?} would both have topics of {name:?}; expected other names");
            return Err(Usage(said).into());
        }
    }
    Ok(())
}
