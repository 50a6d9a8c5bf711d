//! `aeye`: maps what a command returns to an exit code, and nothing else.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    rig::quiet::start_over_without_complaints();
    let cli = rig::cli::Cli::parse();
    let result = rig::run(&cli);
    if let Err(error) = &result {
        eprintln!("error: {}", rig::exit::sentence(error));
    }
    rig::exit::code(&result)
}
