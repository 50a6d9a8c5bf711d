//! `aeye`: maps what a command returns to an exit code, and nothing else.

use std::process::ExitCode;

use base::failure::{Failed, sentence};
use clap::Parser;

fn main() -> ExitCode {
    aeye::quiet::start_over_without_complaints();
    let cli = aeye::cli::Cli::parse();
    let result = aeye::run(&cli);
    if let Err(error) = &result {
        if let Some(failed) = error.downcast_ref::<Failed>() {
            failed.sentences().for_each(|sentence| eprintln!("error: {sentence}"));
        }
        eprintln!("error: {}", sentence(error));
    }
    aeye::exit::code(&result)
}
