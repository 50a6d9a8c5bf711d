//! Says what is in maps, and draws them.

use std::path::Path;

use base::failure::{Failed, Failure, Usage};
use lab::map::{Options, draw, inspect};

use crate::cli::{MapCommand, MapDrawArgs, MapInspectArgs};
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye map`.
pub fn run(command: &MapCommand, json: bool) -> anyhow::Result<Verdict> {
    match command {
        MapCommand::Inspect(args) => look(args, json),
        MapCommand::Draw(args) => picture(args, json),
    }
}

fn look(args: &MapInspectArgs, json: bool) -> anyhow::Result<Verdict> {
    let mut failed = Vec::new();
    for file in &args.files {
        match inspect(file) {
            Ok(inspected) => print::result(json, &inspected)?,
            Err(error) if error.is::<Usage>() => return Err(error),
            Err(error) => failed.push(Failure::new(Path::new(file), &error)),
        }
    }
    Failed::check(&failed, args.files.len() - failed.len())?;
    Ok(Verdict::Ok)
}

fn picture(args: &MapDrawArgs, json: bool) -> anyhow::Result<Verdict> {
    let MapDrawArgs { file, size, out } = args.clone();
    print::result(json, &draw(&Options { file, size_px: size, out })?)?;
    Ok(Verdict::Ok)
}
