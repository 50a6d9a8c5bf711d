//! `aeye`: maps what a command returns to an exit code, and nothing else.

use std::env;
use std::process::{ExitCode, exit};

use base::failure::{Failed, sentence};
use base::progress::watch_signals;
use base::say::{printable, say};
use clap::FromArgMatches;

fn main() -> ExitCode {
    aeye::quiet::start_over_without_complaints();
    let matches = aeye::help::command().try_get_matches().unwrap_or_else(|error| refuse(&error));
    let cli = aeye::cli::Cli::from_arg_matches(&matches).unwrap_or_else(|error| refuse(&error));
    let result = watch_signals().and_then(|()| aeye::run(&cli));
    if let Err(error) = &result {
        if let Some(failed) = error.downcast_ref::<Failed>() {
            failed.sentences().for_each(|sentence| say(format_args!("error: {sentence}")));
        }
        say(format_args!("error: {}", sentence(error)));
    }
    aeye::exit::code(&result)
}

/// Help, or what is wrong with the command line; in plain text where an argument would steer the terminal.
fn refuse(error: &clap::Error) -> ! {
    let steers = |argument: &str| printable(argument) != argument;
    if !env::args_os().any(|argument| steers(&argument.to_string_lossy())) {
        error.exit();
    }
    error.render().to_string().lines().for_each(say);
    exit(error.exit_code())
}
