//! Why nothing could be drawn.

use crate::models::ModelsId;
use crate::{Camera, Sensor};

/// Why nothing could be drawn; each says in one sentence what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RenderError {
    /// No adapter of the wanted kind answered.
    #[error(
        "no {wanted} found: install a Vulkan driver (on Debian: apt install libvulkan1 mesa-vulkan-drivers, which \
         draws on the CPU where there is no GPU), or one of OpenGL (libegl1 libgl1-mesa-dri); adapters of this machine: {found}"
    )]
    NoAdapter {
        /// What was asked for.
        wanted: String,
        /// The adapters that were found, or "none".
        found: String,
    },
    /// The adapter gave no device.
    #[error("adapter '{adapter}' gives no device: {reason}")]
    Device {
        /// Its name.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// The camera asks for an image that cannot be drawn.
    #[error("camera asks for an image of {width}x{height} pixels, expected 1x1 to {limit}x{limit}")]
    ImageSize {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
        /// Largest side that the adapter draws.
        limit: u32,
    },
    /// The camera's lens shows more than its image, which can be drawn, and that cannot.
    #[error(
        "camera asks for an image of {width}x{height} pixels through a lens of {sensor}, for which {drawn_width}x{drawn_height} are \
         drawn, expected 1x1 to {limit}x{limit} of these: a smaller image or weaker distortion"
    )]
    LensSize {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
        /// What the lens does.
        sensor: Sensor,
        /// Width that the lens shows.
        drawn_width: u32,
        /// Height that the lens shows.
        drawn_height: u32,
        /// Largest side that the adapter draws.
        limit: u32,
    },
    /// The lens shows what no pinhole camera sees.
    #[error(
        "a lens of {sensor} folds the picture of this camera before its corners, or sees farther than 72 degrees from its axis: \
         expected weaker distortion, a greater k2 or a smaller field of view"
    )]
    Distortion {
        /// What was asked for.
        sensor: Sensor,
    },
    /// The models that a picture is to be drawn with were not read.
    #[error(
        "the picture is one with models of digest {wanted}, expected their folder with --models DIR; digests given: {given}"
    )]
    Models {
        /// Which ones.
        wanted: ModelsId,
        /// Those that were read, or "none".
        given: String,
    },
    /// What stands still could not be brought to the adapter.
    #[error(
        "the map did not come to adapter '{adapter}': {reason}; where memory is short, models of fewer triangles take less"
    )]
    Scenery {
        /// Its name.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// The snapshot belongs to another map.
    #[error("snapshot has {got} light groups, the map has {expected}: it belongs to another map")]
    OtherMap {
        /// Light groups of the renderer's map.
        expected: usize,
        /// Light groups in the snapshot.
        got: usize,
    },
    /// The device was lost while drawing.
    #[error("reading the frame of tick {tick} back failed: {reason}")]
    Readback {
        /// Tick of the frame.
        tick: u64,
        /// The driver's words.
        reason: String,
    },
}

impl RenderError {
    /// Why a camera's picture cannot be drawn, of what cannot be drawn for its lens.
    pub(crate) fn through_lens(self, camera: &Camera) -> Self {
        let Camera { width, height, sensor, .. } = *camera;
        match self {
            Self::ImageSize { width: drawn_width, height: drawn_height, limit } => {
                Self::LensSize { width, height, sensor, drawn_width, drawn_height, limit }
            }
            other => other,
        }
    }
}
