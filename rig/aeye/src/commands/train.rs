//! A checkpoint trained from a dataset folder.

use base::progress::Interrupt;
use base::say::say;
use lab::train::{Epoch, Options, train};

use crate::cli::TrainArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye train`. Ctrl-C stops it; the same command goes on from the last finished epoch.
pub fn run(args: &TrainArgs, json: bool) -> anyhow::Result<Verdict> {
    let TrainArgs { dataset, out, epochs, seed, size, horizon, patience, batch, replicas, rate, preset, min_height } =
        args.clone();
    let options = Options {
        dataset,
        out,
        epochs,
        seed,
        size,
        horizon,
        patience,
        batch,
        replicas,
        rate,
        preset,
        min_height_px: min_height,
    };
    let show = &mut |epoch: &Epoch| print::result(json, epoch);
    let summary = train(&options, &Interrupt::listen(), show)?;
    if summary.was_there {
        say(format_args!("{}: is trained already, with these options on this dataset", summary.checkpoint.display()));
    }
    print::print(json, &summary, || format!("{}: digest {}", summary.checkpoint.display(), summary.digest))?;
    Ok(Verdict::Ok)
}
