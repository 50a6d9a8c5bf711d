//! Commands as they are typed, in this process.

use std::path::Path;

use aeye::cli::Cli;
use aeye::exit;
use base::failure::sentence;
use clap::Parser;

/// Exit code and sentence of a command about files, whose results go to `out`.
pub fn aeye(command: &str, files: &[&Path], out: &Path) -> (u8, String) {
    let files = files.iter().map(|file| file.to_str().expect("UTF-8"));
    let words = ["aeye", "--json"].into_iter().chain(command.split(' ')).chain(files);
    let words = words.chain(["--out", out.to_str().expect("UTF-8")]);
    let result = aeye::run(&Cli::try_parse_from(words).expect("a valid command line"));
    (exit::number(&result), result.err().map(|error| sentence(&error)).unwrap_or_default())
}
