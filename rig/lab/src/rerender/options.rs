//! What may be chosen.

use std::path::PathBuf;

use drivers::checkpoint::CheckpointChoice;
use kernel::time::{TICK_HZ, Tick};
use render::Imaging;

/// What is drawn and looked at again.
#[derive(Clone, Debug)]
pub struct Options {
    /// Recordings or cases, or folders with cases anywhere below.
    pub files: Vec<PathBuf>,
    /// Checkpoints to look through.
    pub checkpoint: Vec<CheckpointChoice>,
    /// Length of the window that ends at the intervention (or at the end), as in `3s`.
    pub last: Tick,
    /// Frames a second; must divide 60.
    pub fps: u32,
    /// Size of the pictures; none: that which the first network takes.
    pub size: Option<(u32, u32)>,
    /// How good the pictures are.
    pub imaging: Imaging,
    /// A file with cameras that see the windows, too ([`crate::cameras`]).
    pub cameras: Option<PathBuf>,
    /// Frames looked at at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the results. One that this command began with the same options is completed: what is whole and
    /// follows from the same files and checkpoints is kept.
    pub out: PathBuf,
}

/// The options that pictures in a folder have in common, as they are given.
pub fn of_pictures(args: &Options, (width, height): (u32, u32)) -> Vec<String> {
    let last_s = args.last as f64 / f64::from(TICK_HZ);
    let size = format!("--size {width}x{height}");
    let quality = format!("--quality {}", args.imaging.quality.name());
    let sensor =
        Some(args.imaging.sensor).filter(|sensor| !sensor.is_ideal()).map(|sensor| format!("--sensor {sensor}"));
    // A folder may be anywhere: it is told from others by its digest.
    let models = args.imaging.models.map(|models| format!("--models {models}"));
    let always = [format!("--last {last_s}s"), format!("--fps {}", args.fps), size, quality];
    always.into_iter().chain(sensor).chain(models).collect()
}
