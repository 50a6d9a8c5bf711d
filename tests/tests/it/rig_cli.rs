//! Bad input gives one clear sentence that names file and place, the right exit code, and leaves
//! nothing half-written behind.

use std::fs;
use std::path::Path;

use clap::Parser;
use rig::cli::Cli;
use rig::exit;

/// A map, to be cut in half.
const CITY: &str = include_str!("../../../kernel/maps/city.xodr");

/// Exit code and sentence of a command.
fn aeye(arguments: &[&str]) -> (u8, String) {
    let cli = Cli::try_parse_from([&["aeye"], arguments].concat()).expect("a valid command line");
    let result = rig::run(&cli);
    (exit::number(&result), result.err().map(|e| exit::sentence(&e)).unwrap_or_default())
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
fn checkpoints_are_refused_by_name() {
    let dir = tempfile::tempdir().expect("a folder");
    let noise = dir.path().join("noise.onnx");
    fs::write(&noise, [7u8; 300]).expect("writable");
    refused(dir.path(), &["--checkpoint", noise.to_str().expect("UTF-8")], 1, &["noise.onnx"]);
    refused(dir.path(), &["--checkpoint", "missing.onnx"], 1, &["missing.onnx"]);
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
        &["drive", "--record", "x.mcap"][..],
        &["campaign", "--checkpoint", "truth", "--out", "d"],
        &["campaign", "--checkpoint", "truth", "--out", "d", "--runs", "0"],
        &["rerender", "x.mcap", "--checkpoint", "truth", "--size", "0x0", "--out", "d"],
        &["rerender", "x.mcap", "--checkpoint", "truth", "--fps", "7", "--out", "d"],
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
    assert!(names(dir.path()).is_empty());
}
