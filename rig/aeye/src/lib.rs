//! The command `aeye`: what people and scripts type, and what they are told. Arguments become options of the
//! crates below, results become text or JSON, errors become exit codes.

pub mod cli;
pub mod commands;
pub mod exit;
pub mod help;
pub mod print;
pub mod quiet;

use cli::{Cli, Command, DatasetCommand};
use exit::Verdict;

/// Runs a command.
pub fn run(cli: &Cli) -> anyhow::Result<Verdict> {
    let json = cli.json;
    match &cli.command {
        Command::Drive(args) => commands::drive::run(args, json),
        Command::Campaign(args) => commands::campaign::run(args, json),
        Command::Verify(args) => commands::verify::run(args, json),
        Command::Inspect(args) => commands::inspect::run(args, json),
        Command::Statistics(args) => commands::statistics::run(args, json),
        Command::View(args) => commands::view::run(args, json),
        Command::Questionnaire(args) => commands::questionnaire::run(args, json),
        Command::Render(args) => commands::render::run(args, json),
        Command::Gallery(args) => commands::gallery::run(args, json),
        Command::Rerender(args) => commands::rerender::run(args, json),
        Command::Compare(args) => commands::compare::run(args, json),
        Command::Cases(args) => commands::cases::run(args, json),
        Command::Dataset(command) => match command {
            DatasetCommand::Natural(args) => commands::dataset::natural(args, json),
            DatasetCommand::Cases(args) => commands::dataset::cases(args, json),
            DatasetCommand::Mix(args) => commands::dataset::mix(args, json),
            DatasetCommand::Rebuild(args) => commands::dataset::rebuild(args, json),
        },
        Command::Redrive(args) => commands::redrive::run(args, json),
        Command::Export(args) => commands::export::run(args, json),
        Command::Train(args) => commands::train::run(args, json),
        Command::Eval(args) => commands::eval::run(args, json),
        Command::Report(args) => commands::report::run(args, json),
        Command::Experiment(args) => commands::experiment::run(args, json),
        Command::Demo(args) => commands::demo::run(args, json),
        Command::Map(command) => commands::map::run(command, json),
        Command::Wheel(command) => commands::windows::wheels(command, json),
        Command::Doctor(args) => commands::doctor::run(args, json),
        Command::Completions(args) => commands::shell::completions(args),
        Command::Man(args) => commands::shell::man(args),
    }
}
