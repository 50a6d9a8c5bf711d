//! What there is to see of a drive: the newest of everything.

use std::sync::Arc;

use base::image::Image;
use base::newest::Newest;
use kernel::time::Tick;
use kernel::{RoadNetwork, SceneSnapshot};

use crate::figures::TickFigures;

/// The newest of everything that onlookers see.
#[derive(Debug, Default)]
pub struct Feed {
    /// Where everybody is.
    pub scene: Newest<Look>,
    /// What the semantic driver is to see next.
    pub semantic: Newest<View>,
    /// What the safety driver is to see next.
    pub safety: Newest<View>,
    /// The figures of the tick.
    pub figures: Newest<TickFigures>,
}

/// A scene to draw.
#[derive(Debug)]
pub struct Look {
    /// Number of the run.
    pub run: u32,
    /// The map that it drives on.
    pub network: Arc<RoadNetwork>,
    /// Which of the session's checkpoints the semantic driver sees it through.
    pub eye: usize,
    /// What there is to see.
    pub scene: SceneSnapshot,
    /// When it was captured, microseconds since the session began.
    pub captured_us: u64,
}

/// A picture for a screen.
#[derive(Debug)]
pub struct View {
    /// Number of the run.
    pub run: u32,
    /// The tick it is a picture of.
    pub tick: Tick,
    /// The picture.
    pub image: Arc<Image>,
    /// Tag ids and their digest, where the picture is a mask in class colours.
    pub mask: Option<ShownMask>,
    /// When its scene was captured, microseconds since the session began.
    pub captured_us: u64,
    /// When the picture was complete, microseconds since the session began.
    pub ready_us: u64,
}

/// The mask behind a picture in class colours.
#[derive(Debug)]
pub struct ShownMask {
    /// Tag ids of CARLA 0.9.10, rows from top to bottom.
    pub ids: Vec<u8>,
    /// First 8 bytes of their BLAKE3 digest, as recordings hold it.
    pub digest: u64,
}
