//! `aeye`: maps what a command returns to an exit code, and nothing else.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    aeye::quiet::start_over_without_complaints();
    let cli = aeye::cli::Cli::parse();
    let result = aeye::run(&cli);
    if let Err(error) = &result {
        eprintln!("error: {}", base::failure::sentence(error));
    }
    aeye::exit::code(&result)
}
