//! The application `aeye`: drivers and sessions, and the offline lab.

mod boxes;
pub mod campaign;
mod chart;
pub mod cli;
pub mod clock;
pub mod commands;
pub mod crew;
mod desktop;
pub mod drivers;
pub mod exit;
mod footprint;
pub mod lab;
mod live;
pub mod maps;
pub mod measures;
mod newest;
pub mod output;
pub mod progress;
pub mod quiet;
mod recorded_eye;
pub mod session;
pub mod simulate;
pub mod statistics;
pub mod stats;
pub mod study;
mod toml_text;
pub mod units;
mod view;
pub mod vision;
mod words;

use cli::{Cli, Command};
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
        Command::View(args) => view::run(args, json),
        Command::Questionnaire(args) => commands::questionnaire::run(args, json),
        Command::Rerender(args) => lab::rerender::run(args, json),
        Command::Compare(args) => lab::compare::run(args, json),
        Command::Dataset(command) => lab::dataset::run(command, json),
        Command::Redrive(args) => lab::redrive::run(args, json),
        Command::Export(args) => lab::export::run(args, json),
        Command::Train(args) => lab::train::run(args, json),
        Command::Eval(args) => lab::eval::run(args, json),
        Command::Report(args) => lab::report::run(args, json),
        Command::Experiment(args) => lab::experiment::run(args, json),
        Command::Demo(args) => lab::demo::run(args, json),
        Command::Wheel(command) => commands::wheel::run(command, json),
        Command::Doctor(args) => commands::doctor::run(args, json),
    }
}
