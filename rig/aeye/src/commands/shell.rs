//! What a shell wants to know of the program: completions and man pages.

use anyhow::Context;
use base::output;

use crate::cli::{CompletionsArgs, ManArgs};
use crate::exit::Verdict;
use crate::help::command;
use crate::print;

/// Runs `aeye completions`.
pub fn completions(args: &CompletionsArgs) -> anyhow::Result<Verdict> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command(), "aeye", &mut script);
    print::text(&String::from_utf8_lossy(&script))?;
    Ok(Verdict::Ok)
}

/// Runs `aeye man`.
pub fn man(args: &ManArgs) -> anyhow::Result<Verdict> {
    output::create_folder(&args.out)?;
    clap_mangen::generate_to(command(), &args.out).with_context(|| args.out.display().to_string())?;
    Ok(Verdict::Ok)
}
