//! What a shell wants to know of the program: completions and man pages.

use anyhow::Context;
use base::output;
use clap::builder::PossibleValuesParser;
use clap::{Arg, Command};
use clap_complete::Shell;
use perception::{BUNDLED, TRUTH};

use crate::cli::{CompletionsArgs, ManArgs};
use crate::exit::Verdict;
use crate::help::command;
use crate::print;

/// Runs `aeye completions`.
pub fn completions(args: &CompletionsArgs) -> anyhow::Result<Verdict> {
    let mut script = Vec::new();
    let mut command = match args.shell {
        // What it is offered it offers before files, the other shells instead of them.
        Shell::Bash => with_checkpoints(command()),
        _ => command(),
    };
    clap_complete::generate(args.shell, &mut command, "aeye", &mut script);
    print::text(&String::from_utf8_lossy(&script))?;
    Ok(Verdict::Ok)
}

/// Every option that takes checkpoints with the names of those that come with the program.
fn with_checkpoints(command: Command) -> Command {
    let names = || PossibleValuesParser::new(BUNDLED.into_iter().chain([TRUTH]));
    let takes_them = |arg: &Arg| matches!(arg.get_id().as_str(), "checkpoint" | "blind");
    command
        .mut_args(|arg| if takes_them(&arg) { arg.value_parser(names()) } else { arg })
        .mut_subcommands(with_checkpoints)
}

/// Runs `aeye man`.
pub fn man(args: &ManArgs) -> anyhow::Result<Verdict> {
    output::create_folder(&args.out)?;
    clap_mangen::generate_to(command(), &args.out).with_context(|| args.out.display().to_string())?;
    Ok(Verdict::Ok)
}
