//! A recording or case, opened to be looked at: its ticks again, and what the semantic driver saw at each. No window is
//! needed for any of it.

pub mod digests;
pub mod reel;
pub mod seen;
mod viewpoint;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::Context;
use kernel::RoadNetwork;
use kernel::time::Tick;
use replay::{Log, MaskShown, Recording};

pub use viewpoint::Viewpoint;

use crate::recorded_eye::RecordedEye;

/// A file, its map, and what it says about the semantic driver's eye.
pub struct Film {
    /// Where it was read.
    pub path: PathBuf,
    /// What it holds.
    pub recording: Recording,
    /// The map.
    pub network: Arc<RoadNetwork>,
    /// The eye behind the masks.
    pub eye: RecordedEye,
}

impl Film {
    /// Reads a file; one whose writer was stopped is read as far as it goes.
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        let named = || path.display().to_string();
        let recording = Recording::open(path)?;
        let network = recording.network().with_context(named)?;
        let eye = RecordedEye::of(&recording.log().manifest.provenance).with_context(named)?;
        Ok(Self { path: path.to_owned(), recording, network, eye })
    }

    /// The content.
    pub fn log(&self) -> &Log {
        self.recording.log()
    }

    /// The mask that was on the semantic driver's screen when the controls of a tick were given; at the
    /// first tick, which has none, when those of the next were. Only changes of the mask are in the log,
    /// so the frame may be a later one with the same mask.
    pub fn mask_at(&self, tick: Tick) -> Option<&MaskShown> {
        self.log().mask_at(tick.max(self.log().first_tick() + 1))
    }

    /// Whether the scene of a tick can be made again from this file; a case begins after the frames of
    /// its first masks.
    pub fn holds(&self, tick: Tick) -> bool {
        (self.log().first_tick()..=self.log().last_tick()).contains(&tick)
    }
}
