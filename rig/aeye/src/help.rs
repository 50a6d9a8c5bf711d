//! What `--help` says beyond the arguments: the commands in groups, and an example of each.

use clap::{Command, CommandFactory};

use crate::cli::Cli;

/// The commands by what they are for.
const GROUPS: [(&str, &[&str]); 7] = [
    ("Drive", &["drive", "campaign", "demo"]),
    (
        "Look at recordings",
        &["verify", "inspect", "statistics", "view", "render", "gallery", "export", "questionnaire"],
    ),
    ("Look at corner cases again", &["cases", "rerender", "compare", "redrive", "report"]),
    ("Learn", &["dataset", "train", "eval", "experiment"]),
    ("Maps", &["map"]),
    ("The machine", &["doctor", "wheel"]),
    ("The shell", &["completions", "man"]),
];

/// A call of each command.
const EXAMPLES: [&str; 33] = [
    "aeye drive --headless --map city --checkpoint early --max-time 2m --record drive.mcap",
    "aeye campaign --checkpoint early,full --km 5 --out runs",
    "aeye campaign --collect shards --out runs",
    "aeye verify runs --jobs 4",
    "aeye inspect runs/early-0003.case.mcap --json",
    "aeye statistics runs more-runs --reference early",
    "aeye view runs/early-0003.mcap --checkpoint early,full",
    "aeye render --map suburb --weather HardRainSunset --at 30s --camera chase --out still.png",
    "aeye gallery --maps city,town.xodr --out gallery",
    "aeye questionnaire p07.mcap p07-2.mcap --answers after.toml",
    "aeye rerender runs --checkpoint early,full --out pictures",
    "aeye compare runs --checkpoint early,full --gate \"ped_iou>=0.5,fixed>=1\" --out compared",
    "aeye redrive runs --without-intervention --after 10s --out forks",
    "aeye export drive.mcap --checkpoint early --last 3s --out export.mcap",
    "aeye export drive.mcap --format ros2 --cameras rig.toml --last 3s --out bag",
    "aeye cases runs --label walker --overlooked walker:200 --reviewed no --unique --limit 20",
    "aeye dataset natural --scenes 8 --maps city,rural --out natural",
    "aeye dataset natural --scenes 8 --cameras rig.toml --size 512x256 --out surround",
    "aeye dataset cases runs --label walker,vehicle --out cases",
    "aeye dataset mix --natural natural --pool pool --corner-cases cases --out sets",
    "aeye dataset rebuild sets/corner-case/dataset.json runs --out again",
    "aeye train --dataset natural --epochs 40 --out mine.onnx",
    "aeye eval --checkpoint mine.onnx --dataset natural --split test",
    "aeye report runs --checkpoint early,full --out report.html",
    "aeye experiment --preset smoke --out experiment",
    "aeye demo --out demo",
    "aeye map inspect city town.xodr",
    "aeye map draw town.xodr --out town.svg",
    "aeye wheel list",
    "aeye wheel calibrate --out wheel.toml",
    "aeye wheel import wheel_config.ini --out wheel.toml",
    "aeye doctor --max-time 10s",
    "aeye completions bash",
];

/// The command line with all that `--help` says.
pub fn command() -> Command {
    let mut command = with_examples(Cli::command().subcommand_value_name("COMMAND"));
    let mut commands = String::new();
    for (group, names) in GROUPS {
        commands.push_str(&format!("\n{group}:\n"));
        for name in names {
            let about = command.find_subcommand(name).and_then(Command::get_about).map(ToString::to_string);
            commands.push_str(&format!("  {name:<14}{}\n", about.unwrap_or_default()));
        }
    }
    command = command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n{commands}\nOptions:\n{{options}}\n\n\
         `aeye COMMAND --help` says more, with an example.\n"
    ));
    command
}

fn with_examples(command: Command) -> Command {
    EXAMPLES.iter().fold(command, |command, example| {
        let mut words = example.split(' ').skip(1);
        let name = words.next().unwrap_or_default();
        command.mut_subcommand(name, |command| {
            let inner = words.next().filter(|word| command.find_subcommand(word).is_some());
            match inner {
                Some(inner) => command.mut_subcommand(inner, |command| with_example(command, example)),
                None => with_example(command, example),
            }
        })
    })
}

fn with_example(command: Command, example: &str) -> Command {
    let before = command.get_after_help().map(|text| format!("{text}\n\n")).unwrap_or_default();
    command.after_help(format!("{before}Example: {example}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[test]
    fn every_command_is_in_a_group_and_has_an_example_that_parses() {
        let command = command();
        let mut known: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        known.sort_unstable();
        grouped.sort_unstable();
        assert_eq!(known, grouped);
        for command in command.get_subcommands() {
            let inner: Vec<&Command> = command.get_subcommands().collect();
            for command in if inner.is_empty() { vec![command] } else { inner } {
                let said = command.get_after_help().map(ToString::to_string).unwrap_or_default();
                assert!(said.contains("Example: aeye "), "{}", command.get_name());
            }
        }
        for example in EXAMPLES {
            let words = example.split(' ').map(|word| word.trim_matches('"'));
            assert!(Cli::try_parse_from(words).is_ok(), "{example}");
        }
    }
}
