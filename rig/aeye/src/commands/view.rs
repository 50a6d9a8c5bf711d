//! A recording or case in a window, tick by tick; or a check of what the semantic driver saw.

use std::path::Path;

use base::failure::Usage;
use drivers::film::{Film, digests};

use super::windows;
use crate::cli::ViewArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye view`.
pub fn run(args: &ViewArgs, json: bool) -> anyhow::Result<Verdict> {
    let film = open(&args.file, args.reveal)?;
    if args.digests {
        let digests = digests::compare(&film, &args.checkpoint)?;
        print::result(json, &digests)?;
        return Ok(Verdict::of_check(digests.are_equal()));
    }
    windows::watch(&film, &args.checkpoint)?;
    Ok(Verdict::Ok)
}

/// Opens a recording or case for looking at it; a blind one only to `reveal` its checkpoint.
fn open(path: &Path, reveal: bool) -> anyhow::Result<Film> {
    let film = Film::open(path)?;
    if study::is_blind(&film.log().manifest.provenance) && !reveal {
        let file = path.display();
        return Err(Usage(format!("{file}: a blind drive; expected --reveal, which tells its checkpoint")).into());
    }
    Ok(film)
}
