//! A recording or case in a window, tick by tick; or a check of what the semantic driver saw.

use live::view;

use crate::cli::ViewArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye view`.
pub fn run(args: &ViewArgs, json: bool) -> anyhow::Result<Verdict> {
    let film = view::open(&args.file, args.reveal)?;
    if args.digests {
        let digests = view::digests::compare(&film, &args.checkpoint)?;
        print::result(json, &digests)?;
        return Ok(Verdict::of_check(digests.are_equal()));
    }
    view::watch(&film, &args.checkpoint)?;
    Ok(Verdict::Ok)
}
