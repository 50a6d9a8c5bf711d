//! Arguments of what a shell wants to know.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

/// Arguments of `completions`.
#[derive(Args, Clone, Debug)]
pub struct CompletionsArgs {
    /// Which shell; the script goes to stdout.
    pub shell: Shell,
}

/// Arguments of `man`.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example: aeye man --out man/man1")]
pub struct ManArgs {
    /// Folder of the pages, one for the program and one for each command.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}
