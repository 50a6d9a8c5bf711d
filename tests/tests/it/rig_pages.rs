//! The pages of `docs` say what the program does.

use std::fs;
use std::path::{Path, PathBuf};

use aeye::help;
use kernel::Scenario;
use lab::map;

const SCENARIO: &str = include_str!("../../../docs/scenario.md");
const COMMAND_LINE: &str = include_str!("../../../docs/command-line.md");

#[test]
fn the_example_of_a_scenario_has_every_key_and_so_has_its_table() {
    let example = SCENARIO.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let scenario = Scenario::from_toml(example).expect("a scenario");
    assert_ne!(scenario, Scenario::default_for("city", 7));
    // Every key is printed where none is left out; the page also has what stands for several.
    let mut all: Vec<String> = keys(&scenario.to_toml());
    all.extend(["hazards.level", "weather.preset"].map(String::from));
    let mut on_page: Vec<String> =
        SCENARIO.lines().filter_map(|line| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_owned())).collect();
    all.sort_unstable();
    on_page.sort_unstable();
    assert_eq!(on_page, all);
    let in_example = keys(example);
    assert!(in_example.iter().all(|key| all.contains(key)), "{in_example:?}");
    let stood_for = |key: &str| ["hazards.", "weather."].iter().any(|section| key.starts_with(section));
    let left_out: Vec<_> = all.iter().filter(|key| !in_example.contains(key) && !stood_for(key)).collect();
    assert_eq!(left_out, Vec::<&String>::new());
}

/// `section.key` of everything in a text; of a section in a section, which repeats the keys of that, `section.name.*` and what
/// it has beyond them.
fn keys(text: &str) -> Vec<String> {
    let table: toml::Table = text.parse().expect("TOML");
    let mut keys = Vec::new();
    for (name, value) in &table {
        match value.as_table() {
            Some(section) => {
                for (key, value) in section {
                    keys.push(format!("{name}.{key}{}", if value.is_table() { ".*" } else { "" }));
                    let own = value.as_table().into_iter().flat_map(toml::Table::keys);
                    let own = own.filter(|own| !section.contains_key(*own) && *own != "preset");
                    keys.extend(own.map(|own| format!("{name}.{key}.{own}")));
                }
            }
            None => keys.push(name.clone()),
        }
    }
    keys
}

/// The map on the page on maps, as a program that stands in the root of the workspace names it.
const CROSS: &str = "tests/maps/cross_lights.xodr";

/// `AEYE_BLESS=1` writes both anew.
#[test]
fn the_page_on_maps_says_and_shows_what_the_program_does() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let file = root.join(CROSS).to_str().expect("UTF-8").to_owned();
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("map.svg");
    map::draw(&map::Options { file: file.clone(), size_px: 600, out: out.clone() }).expect("drawn");
    let said = map::inspect(&file).expect("a map").to_string().replace(&file, CROSS);
    let page = fs::read_to_string(root.join("docs/maps.md")).expect("the page");
    let (before, rest) = page.split_once("```text\n").expect("a block of text");
    let (_, after) = rest.split_once("```").expect("its end");
    same(root.join("docs/maps.md"), &format!("{before}```text\n{said}\n```{after}"));
    same(root.join("docs/map.svg"), &fs::read_to_string(out).expect("a picture"));
}

/// Expects a file to hold this, or makes it.
fn same(path: PathBuf, expected: &str) {
    if std::env::var_os("AEYE_BLESS").is_some() {
        fs::write(&path, expected).expect("writable");
    }
    let there = fs::read_to_string(&path).unwrap_or_default();
    assert!(there == expected, "{} is stale; AEYE_BLESS=1 makes it anew", path.display());
}

#[test]
fn options_that_take_lists_take_commas_and_are_on_the_page() {
    let command = help::command();
    let commands: Vec<_> =
        command.get_subcommands().flat_map(|c| std::iter::once(c).chain(c.get_subcommands())).collect();
    let options = commands.iter().flat_map(|command| command.get_arguments().filter(|arg| !arg.is_positional()));
    for option in options {
        let name = option.get_long().unwrap_or_default();
        let many = matches!(option.get_action(), clap::ArgAction::Append);
        assert!(!many || option.get_value_delimiter() == Some(','), "--{name} takes a list without commas");
        assert!(!many || COMMAND_LINE.contains(&format!("`--{name}`")), "--{name} takes a list and is not on the page");
        let most = option.get_num_args().map_or(1, |range| range.max_values());
        assert!(most <= 1, "--{name} eats what follows it");
    }
}
