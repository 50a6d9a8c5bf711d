//! Pictures of every map in every light.

use base::progress::Interrupt;
use lab::gallery::{Options, gallery};

use crate::cli::GalleryArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye gallery`.
pub fn run(args: &GalleryArgs, json: bool) -> anyhow::Result<Verdict> {
    let GalleryArgs { maps, seed, at: tick, camera, size, quality, out } = args.clone();
    let options = Options { maps, seed, tick, camera, size, quality, out };
    print::result(json, &gallery(&options, &Interrupt::listen())?)?;
    Ok(Verdict::Ok)
}
