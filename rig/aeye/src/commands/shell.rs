//! What a shell wants to know of the program: completions and man pages.

use std::io::Write;

use anyhow::Context;
use base::output;

use crate::cli::{CompletionsArgs, ManArgs};
use crate::exit::Verdict;
use crate::help::command;

/// Runs `aeye completions`.
pub fn completions(args: &CompletionsArgs) -> anyhow::Result<Verdict> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command(), "aeye", &mut script);
    std::io::stdout().lock().write_all(&script).context("stdout")?;
    Ok(Verdict::Ok)
}

/// Runs `aeye man`.
pub fn man(args: &ManArgs) -> anyhow::Result<Verdict> {
    output::create_folder(&args.out)?;
    clap_mangen::generate_to(command(), &args.out).with_context(|| args.out.display().to_string())?;
    Ok(Verdict::Ok)
}
