//! A checkpoint measured on a split of a dataset folder.

use base::progress::Interrupt;
use lab::eval::{Summary, evaluate, evaluate_and_keep};

use crate::cli::EvalArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye eval`.
pub fn run(args: &EvalArgs, json: bool) -> anyhow::Result<Verdict> {
    let EvalArgs { checkpoint, dataset, split, jobs, out } = args;
    let interrupt = Interrupt::listen();
    let evaluation = match out {
        Some(folder) => evaluate_and_keep(checkpoint, dataset, split, folder, *jobs, &interrupt)?,
        None => evaluate(checkpoint, dataset, split, *jobs, &interrupt)?,
    };
    print::result(json, &Summary::new(&evaluation, dataset, split))?;
    Ok(Verdict::Ok)
}
