//! Bad input gives one clear sentence that names file and place, the right exit code, and leaves
//! nothing half-written behind.

use std::fs;
use std::path::Path;

use aeye::cli::Cli;
use aeye::exit;
use base::failure::sentence;
use clap::{CommandFactory, Parser};

/// A map, to be cut in half.
const CITY: &str = include_str!("../../../kernel/maps/city.xodr");

/// Exit code and sentence of a command.
fn aeye(arguments: &[&str]) -> (u8, String) {
    let cli = Cli::try_parse_from([&["aeye"], arguments].concat()).expect("a valid command line");
    let result = aeye::run(&cli);
    (exit::number(&result), result.err().map(|e| sentence(&e)).unwrap_or_default())
}

/// What remains in a folder, by name.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a readable folder");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Drives with the given arguments, and expects a refusal with these words.
fn refused(folder: &Path, arguments: &[&str], code: u8, words: &[&str]) {
    let record = folder.join("run.mcap");
    let arguments = [&["drive", "--headless", "--record", record.to_str().expect("UTF-8")], arguments].concat();
    let before = names(folder);
    let (got, sentence) = aeye(&arguments);
    assert_eq!(got, code, "{arguments:?}: {sentence}");
    assert!(words.iter().all(|w| sentence.contains(w)), "{sentence:?} lacks one of {words:?}");
    assert!(!sentence.contains('\n') && sentence.len() < 400, "{sentence:?}");
    assert_eq!(names(folder), before, "something was left behind");
}

#[test]
fn maps_and_scenarios_are_refused_by_name_and_place() {
    let dir = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| {
        let path = dir.path().join(name);
        fs::write(&path, text).expect("writable");
        path.to_str().expect("UTF-8").to_owned()
    };
    let half = file("half.xodr", &CITY[..CITY.len() / 2]);
    let unit = file("unit.toml", "map = \"city\"\n[weather]\nsun_altitude_deg = 4000.0\n");
    let key = file("key.toml", "map = \"city\"\n[traffic]\nlorries = 4\n");
    let unknown = file("unknown.toml", "map = \"atlantis\"\n");
    refused(dir.path(), &["--map", "atlantis"], 2, &["atlantis", "city"]);
    refused(dir.path(), &["--map", "missing.xodr"], 1, &["missing.xodr"]);
    refused(dir.path(), &["--map", &half], 1, &["half.xodr"]);
    refused(dir.path(), &["--scenario", &unit], 2, &["unit.toml", "sun_altitude_deg"]);
    refused(dir.path(), &["--scenario", &key], 2, &["key.toml", "lorries"]);
    refused(dir.path(), &["--scenario", &unknown], 2, &["unknown.toml", "atlantis"]);
    refused(dir.path(), &["--scenario", "missing.toml"], 1, &["missing.toml"]);
}

#[test]
fn a_start_that_does_not_fit_the_map_is_refused_by_line_also_where_it_is_only_printed() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("start.toml");
    let scenario = path.to_str().expect("UTF-8");
    for (ego, words) in [
        ("lane = 99999", &["start.toml: line 4: ego.lane is 99999, expected a driving lane of city: "][..]),
        ("s_m = 1e5\nlane = LANE", &["start.toml: line 4: ego.s_m is 100000, expected at most ", " of city)"]),
    ] {
        let lane = driving_lane();
        fs::write(&path, format!("map = \"city\"\nseed = 3\n[ego]\n{}\n", ego.replace("LANE", &lane)))
            .expect("writable");
        refused(dir.path(), &["--scenario", scenario], 2, words);
        refused(dir.path(), &["--scenario", scenario, "--print-scenario"], 2, words);
        let (code, said) = aeye(&["campaign", "--scenario", scenario, "--print-scenario"]);
        assert!(code == 2 && words.iter().all(|word| said.contains(word)), "{said}");
    }
}

/// The number of a driving lane of the city.
fn driving_lane() -> String {
    let network = kernel::map::bundled("city").expect("bundled");
    let first = kernel::scenario::driving_lanes(&network).swap_remove(0);
    first.split(' ').next().expect("a number").to_owned()
}

#[test]
fn a_scenario_is_printed_without_a_place_for_results() {
    for command in [&["drive", "--print-scenario"][..], &["campaign", "--print-scenario"]] {
        assert_eq!(aeye(command), (0, String::new()), "{command:?}");
    }
}

#[test]
fn checkpoints_are_refused_by_name() {
    let dir = tempfile::tempdir().expect("a folder");
    let noise = dir.path().join("noise.onnx");
    fs::write(&noise, [7u8; 300]).expect("writable");
    refused(dir.path(), &["--checkpoint", noise.to_str().expect("UTF-8")], 1, &["noise.onnx"]);
    refused(dir.path(), &["--checkpoint", "missing.onnx"], 1, &["missing.onnx", "early, full, truth"]);
    refused(dir.path(), &["--checkpoint", "late"], 2, &["late", "early, full, truth"]);
}

#[test]
fn recordings_are_refused_with_the_place() {
    let dir = tempfile::tempdir().expect("a folder");
    let noise = dir.path().join("noise.mcap");
    fs::write(&noise, [9u8; 5000]).expect("writable");
    for command in ["verify", "inspect"] {
        let (code, sentence) = aeye(&[command, noise.to_str().expect("UTF-8")]);
        assert_eq!(code, 1, "{sentence}");
        assert!(sentence.contains("noise.mcap"), "{sentence}");
        let (code, sentence) = aeye(&[command, "missing.mcap"]);
        assert!(code == 1 && sentence.contains("missing.mcap"), "{sentence}");
    }
}

#[test]
fn nonsense_on_the_command_line_is_usage() {
    for arguments in [
        &["drive"][..],
        &["drive", "--headless", "--safety", "keyboard", "--record", "x.mcap"],
        &["drive", "--headless", "--record", "x.mcap", "--max-time", "3"],
        &["campaign", "--checkpoint", "truth", "--out", "d"],
        &["campaign", "--checkpoint", "truth", "--out", "d", "--runs", "0"],
        &["rerender", "x.mcap", "--checkpoint", "truth", "--size", "0x0", "--out", "d"],
        &["rerender", "x.mcap", "--checkpoint", "truth", "--fps", "7", "--out", "d"],
        &["compare", "x.mcap", "--checkpoint", "truth,early", "--gate", "speed>=1", "--out", "d"],
        &["compare", "x.mcap", "--checkpoint", "truth,early", "--gate", "miou~1", "--out", "d"],
        &["compare", "x.mcap", "--checkpoint", "truth", "early", "--out", "d"],
        &["rerender", "--checkpoint", "full", "c.onnx", "x.mcap", "--out", "d"],
        &["fly"],
    ] {
        let error = Cli::try_parse_from([&["aeye"], arguments].concat()).expect_err("nonsense");
        assert_eq!(error.exit_code(), 2, "{arguments:?}");
    }
    let dir = tempfile::tempdir().expect("a folder");
    let out = dir.path().join("out");
    let campaign = ["campaign", "--checkpoint", "truth", "--km=-1", "--out", out.to_str().expect("UTF-8")];
    let (code, sentence) = aeye(&campaign);
    assert!(code == 2 && sentence.contains("--km"), "{sentence}");
    for (checkpoint, words) in [("early", "expected two or more"), ("early,early", "given twice; expected each once")] {
        let out = out.to_str().expect("UTF-8");
        let (code, sentence) = aeye(&["compare", "missing.case.mcap", "--checkpoint", checkpoint, "--out", out]);
        assert!(code == 2 && sentence.contains(words), "before any file is looked for: {sentence}");
    }
    assert!(names(dir.path()).is_empty());
}

/// Runs a command that is refused, and gives the sentence.
fn sentence_of(arguments: &[&str]) -> String {
    let (code, sentence) = aeye(arguments);
    assert_eq!(code, 1, "{arguments:?}: {sentence}");
    sentence
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn places_that_cannot_hold_results_are_refused_before_the_work() {
    let dir = tempfile::tempdir().expect("a folder");
    let place = |name: &str| dir.path().join(name).to_str().expect("UTF-8").to_owned();
    let (file, folder, missing) = (place("file"), place("folder"), place("missing/page.html"));
    fs::write(&file, "a note").expect("writable");
    fs::create_dir(&folder).expect("writable");
    for below in ["", "/below"] {
        let out = format!("{file}{below}");
        for command in [&["campaign", "--checkpoint", "truth", "--runs", "1"][..], &["dataset", "natural"], &["demo"]] {
            let sentence = sentence_of(&[command, &["--out", &out]].concat());
            assert_eq!(sentence, format!("{file}: is a file; expected a folder"));
        }
    }
    let sentence = sentence_of(&["rerender", "run.mcap", "--checkpoint", "truth", "--out", &file]);
    assert_eq!(sentence, format!("{file}: is a file; expected a folder"));
    for command in [&["report", "case.mcap", "--checkpoint", "truth"][..], &["train", "--dataset", "none"]] {
        let sentence = sentence_of(&[command, &["--out", &folder]].concat());
        assert_eq!(sentence, format!("{folder}: is a folder; expected a file"));
        let sentence = sentence_of(&[command, &["--out", &missing]].concat());
        assert!(sentence.starts_with(&missing) && sentence.ends_with("does not exist"), "{sentence}");
    }
    let run = place("missing/run.mcap");
    let sentence = sentence_of(&["drive", "--headless", "--record", &run]);
    assert_eq!(sentence, format!("{run}: the folder {} does not exist", place("missing")));
    assert_eq!(fs::read_to_string(&file).expect("still there"), "a note");
    assert_eq!(names(dir.path()), ["file", "folder"]);
}

#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_full_disk_is_named_with_the_recording() {
    let dir = tempfile::tempdir().expect("a folder");
    let full = dir.path().join("full.mcap");
    std::os::unix::fs::symlink("/dev/full", &full).expect("linked");
    let full = full.to_str().expect("UTF-8");
    let sentence = sentence_of(&["drive", "--headless", "--map", "rural", "--max-time", "4", "--record", full]);
    assert!(sentence.starts_with(&format!("{full}: No space left on device")), "{sentence}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_bundled_checkpoint_by_name_and_by_path_gives_the_same_recording() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../perception/checkpoints/early.onnx");
    let recording = |checkpoint: &str, name: &str| {
        let record = dir.path().join(name);
        let record = record.to_str().expect("UTF-8");
        let drive = ["drive", "--headless", "--map", "rural", "--max-time", "4", "--record", record];
        assert_eq!(aeye(&[&drive[..], &["--checkpoint", checkpoint]].concat()).0, 0);
        fs::read(record).expect("a recording")
    };
    assert!(recording("early", "a.mcap") == recording(path, "b.mcap"));
}

#[test]
fn the_readme_names_every_command_as_it_is_called() {
    let readme = include_str!("../../../README.md");
    let calls = readme.lines().filter_map(|line| line.strip_prefix("| `aeye ")?.split('`').next());
    let mut named: Vec<&str> = calls.clone().filter_map(|call| call.split(' ').next()).collect();
    for call in calls {
        let words = call
            .split(' ')
            .map(|word| if word == "N" { "1" } else { word.trim_end_matches("...").trim_end_matches(',') });
        let parsed = Cli::try_parse_from(["aeye"].into_iter().chain(words));
        assert!(parsed.is_ok(), "aeye {call}: {:?}", parsed.err());
    }
    let command = Cli::command();
    let mut known: Vec<&str> = command.get_subcommands().map(|command| command.get_name()).collect();
    named.sort_unstable();
    named.dedup();
    known.sort_unstable();
    assert_eq!(named, known);
}
