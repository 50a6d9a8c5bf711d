//! What is exported, and what comes of a file.

use std::path::PathBuf;

use drivers::checkpoint::CheckpointChoice;
use drivers::film::Viewpoint;
use kernel::time::Tick;
use measures::footage::Asked;
use render::Imaging;
use serde::Serialize;

use super::film::Counts;
use super::format::Format;

/// A file that was written.
#[derive(Debug, Serialize)]
pub struct Export {
    /// What was exported.
    pub file: PathBuf,
    /// To where.
    pub out: PathBuf,
    /// The first tick.
    pub from: Tick,
    /// The last tick.
    pub to: Tick,
    /// It was there already, made from the same.
    pub kept: bool,
    /// How much is in it.
    #[serde(flatten)]
    pub counts: Counts,
}

/// What is exported.
#[derive(Clone, Debug)]
pub struct Options {
    /// Recordings or cases, or folders with cases anywhere below.
    pub files: Vec<PathBuf>,
    /// As what.
    pub format: Format,
    /// From where moving pictures are taken; viewers of robot logs have the driver's view.
    pub camera: Viewpoint,
    /// Checkpoints whose masks come along: with the ground truth, or beside a moving picture.
    pub checkpoint: Vec<CheckpointChoice>,
    /// Only a window of this length that ends at the intervention (or at the end), as in `3s`; without a
    /// window everything is exported.
    pub last: Option<Tick>,
    /// Only from this time of the run on, as in `10s`.
    pub from: Option<Tick>,
    /// Only up to this time of the run, as in `20s`.
    pub to: Option<Tick>,
    /// Pictures a second; must divide 60. What is measured is exported at every tick.
    pub fps: u32,
    /// Size of the pictures; none: that which the first network takes.
    pub size: Option<(u32, u32)>,
    /// How good the pictures are.
    pub imaging: Imaging,
    /// A file with cameras whose pictures come along ([`crate::cameras`]).
    pub cameras: Option<PathBuf>,
    /// Files exported at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// File of the export, with its layout for viewers beside it; or a folder, for several files.
    pub out: PathBuf,
}

impl Options {
    /// The window that is asked for.
    pub fn asked(&self) -> Asked {
        Asked { last: self.last, from: self.from, to: self.to, fps: self.fps }
    }
}
