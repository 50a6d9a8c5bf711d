//! The layout of Cityscapes, which trainers read as it is.
//!
//! `leftImg8bit/SPLIT/CITY/CITY_SEQ_FRAME_leftImg8bit.png` and, below `gtFine/SPLIT/CITY`,
//! `_gtFine_labelIds.png` (tags of CARLA 0.9.10), `_gtFine_labelTrainIds.png` (train ids of
//! [`crate::classes`]; 255 counts nowhere), `_gtFine_instanceIds.png` (16 bits: tag * 1000 +
//! number for road users, else the tag) and `_gtFine_color.png` (the tags' colours). `CITY` is the map, or `MAP-CAMERA` where
//! several cameras take each frame.

use std::path::{Path, PathBuf};

/// What the names of pictures end with.
pub const IMAGE_ENDING: &str = "_leftImg8bit.png";

/// Which frame of which scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place<'a> {
    /// `train`, `val` or `test`.
    pub split: &'a str,
    /// The map; must not contain `_`, which separates the parts of a name.
    pub city: &'a str,
    /// Number of the scene within its split.
    pub scene: u32,
    /// Number of the frame within its scene.
    pub frame: u32,
    /// Which of several cameras took it; its name follows the map's, with `-` for `_`.
    pub camera: Option<&'a str>,
}

impl Place<'_> {
    fn city_folder(&self) -> String {
        match self.camera {
            Some(camera) => format!("{}-{}", self.city, camera.replace('_', "-")),
            None => self.city.to_owned(),
        }
    }

    /// Path of one of the frame's files below the dataset folder.
    pub fn path(&self, kind: Kind) -> String {
        let Self { split, scene, frame, .. } = self;
        let city = self.city_folder();
        let (top, ending) = kind.names();
        format!("{top}/{split}/{city}/{city}_{scene:06}_{frame:06}_{ending}.png")
    }
}

/// The files of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The picture.
    Image,
    /// Tags.
    LabelIds,
    /// Train ids.
    TrainIds,
    /// Tags with numbers.
    InstanceIds,
    /// Tags in their colours.
    Color,
}

impl Kind {
    /// Every one.
    pub const ALL: [Self; 5] = [Self::Image, Self::LabelIds, Self::TrainIds, Self::InstanceIds, Self::Color];

    /// The folder below the dataset's, and the end of the file's name.
    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Image => ("leftImg8bit", "leftImg8bit"),
            Self::LabelIds => ("gtFine", "gtFine_labelIds"),
            Self::TrainIds => ("gtFine", "gtFine_labelTrainIds"),
            Self::InstanceIds => ("gtFine", "gtFine_instanceIds"),
            Self::Color => ("gtFine", "gtFine_color"),
        }
    }
}

/// Another file of the frame with this picture; `None` when the path is not that of a picture
/// (`.../leftImg8bit/SPLIT/CITY/NAME_leftImg8bit.png`).
pub fn sibling(image: &Path, kind: Kind) -> Option<PathBuf> {
    let (top, ending) = kind.names();
    let stem = image.file_name()?.to_str()?.strip_suffix(IMAGE_ENDING)?;
    let city = image.parent()?;
    let split = city.parent()?;
    let dataset = split.parent()?.parent()?;
    let folder = dataset.join(top).join(split.file_name()?).join(city.file_name()?);
    Some(folder.join(format!("{stem}_{ending}.png")))
}
