//! Pictures of every map in every light.

use base::progress::Interrupt;
use lab::gallery::{Options, gallery};
use render::Imaging;

use crate::cli::GalleryArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye gallery`.
pub fn run(args: &GalleryArgs, json: bool) -> anyhow::Result<Verdict> {
    let GalleryArgs { maps, seed, at: tick, camera, size, quality, sensor, models, out } = args.clone();
    let imaging = Imaging { quality, sensor: sensor.unwrap_or_default(), models };
    let options = Options { maps, seed, tick, camera, size, imaging, out };
    print::result(json, &gallery(&options, &Interrupt::listen())?)?;
    Ok(Verdict::Ok)
}
