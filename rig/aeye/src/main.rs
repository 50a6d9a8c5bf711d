//! `aeye`: maps what a command returns to an exit code, and nothing else.

use std::process::ExitCode;

use base::failure::{Failed, sentence};
use clap::FromArgMatches;

fn main() -> ExitCode {
    aeye::quiet::start_over_without_complaints();
    let matches = aeye::help::command().get_matches();
    let cli = aeye::cli::Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    let result = aeye::run(&cli);
    if let Err(error) = &result {
        if let Some(failed) = error.downcast_ref::<Failed>() {
            failed.sentences().for_each(|sentence| eprintln!("error: {sentence}"));
        }
        eprintln!("error: {}", sentence(error));
    }
    aeye::exit::code(&result)
}
