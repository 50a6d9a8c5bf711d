//! The program as people start it: what it says, how it ends, and what it leaves behind.

mod common;

use std::fs;
use std::process::Command;

use base::maps::Map;
use common::{aeye, blind_drive, names, run};

/// Tells old and new Vulkan loaders that the driver is where nothing is.
const NO_DRIVER: [(&str, &str); 2] = [("VK_ICD_FILENAMES", "/nonexistent"), ("VK_DRIVER_FILES", "/nonexistent")];

#[test]
fn without_a_graphics_driver_each_command_says_what_to_install_and_leaves_nothing() {
    let dir = tempfile::tempdir().expect("a folder");
    blind_drive(&dir.path().join("run.mcap"), 1);
    for command in [
        "drive --headless --max-time 4s --record new.mcap",
        "campaign --checkpoint truth --runs 1 --out new",
        "rerender run.mcap --checkpoint truth --out new",
        "compare run.mcap --checkpoint truth,early --out new",
        "report run.mcap --checkpoint truth --out new.html",
        "dataset natural --scenes 1 --val-scenes 0 --frames 1 --out new",
        "demo --out new",
    ] {
        let (code, out, sentence) = run(aeye(dir.path(), command).envs(NO_DRIVER));
        assert_eq!((code, out.as_str()), (Some(1), ""), "{command}: {sentence}");
        let install = "install a Vulkan driver (on Debian: apt install libvulkan1 mesa-vulkan-drivers";
        assert!(sentence.starts_with("error: ") && sentence.contains(install), "{command}: {sentence}");
        assert_eq!(sentence.lines().count(), 1, "{command}: {sentence}");
        assert_eq!(names(dir.path()), ["run.mcap"], "{command} left something behind");
    }
}

#[test]
fn doctor_fails_only_without_what_drives_need() {
    let dir = tempfile::tempdir().expect("a folder");
    let (code, out, _) = run(aeye(dir.path(), "doctor --json").envs(NO_DRIVER));
    let found: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!((code, found["adapters"].as_array().map(Vec::len)), (Some(3), Some(0)));
    assert!(found["problems"][0].as_str().is_some_and(|p| p.contains("mesa-vulkan-drivers")), "{out}");
}

#[test]
fn what_is_not_a_command_is_usage_and_the_version_is_told() {
    let dir = tempfile::tempdir().expect("a folder");
    let (code, out, said) = run(&mut aeye(dir.path(), ""));
    assert!((code, out.as_str()) == (Some(2), "") && said.contains("Usage: aeye"), "{said}");
    let (code, out, said) = run(&mut aeye(dir.path(), "fly"));
    assert!(
        (code, out.as_str()) == (Some(2), "") && said.starts_with("error: unrecognized subcommand 'fly'"),
        "{said}"
    );
    let (code, out, said) = run(&mut aeye(dir.path(), "--version"));
    assert_eq!((code, out.as_str(), said.as_str()), (Some(0), concat!("aeye ", env!("CARGO_PKG_VERSION"), "\n"), ""));
}

#[test]
fn bash_is_offered_the_names_of_checkpoints_and_files() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("mine.onnx"), "").expect("writable");
    let (_, script, _) = run(&mut aeye(dir.path(), "completions bash"));
    fs::write(dir.path().join("aeye.bash"), script).expect("writable");
    let offered = |typed: &str| {
        let asked = format!(
            "source aeye.bash; COMP_WORDS=(aeye compare x.mcap --checkpoint '{typed}'); COMP_CWORD=4; COMPREPLY=(); \
             _aeye aeye '{typed}' --checkpoint; printf '%s\\n' \"${{COMPREPLY[@]}}\"; complete -p aeye"
        );
        run(Command::new("bash").current_dir(dir.path()).args(["-c", &asked])).1
    };
    assert!(offered("").starts_with("early\nfull\ntruth\n"), "{}", offered(""));
    let other = offered("mi");
    assert!(other.starts_with('\n') && other.contains("-o default"), "bash falls back to names of files: {other}");
}

#[test]
fn a_printed_scenario_names_the_place_that_is_driven_and_the_lanes_to_choose_from() {
    let dir = tempfile::tempdir().expect("a folder");
    let (code, printed, _) = run(&mut aeye(dir.path(), "drive --map rural --seed 5 --print-scenario"));
    assert_eq!(code, Some(0));
    let scenario = kernel::Scenario::from_toml(&printed).expect("a scenario");
    let map = Map::find("rural").expect("bundled");
    let drawn = map.scenario(5).start_on(&map.network).expect("a start");
    assert_eq!((scenario.ego.lane, scenario.ego.s_m), (Some(drawn.0), drawn.1));
    assert!(printed.contains("# Driving lanes of rural, for ego.lane:\n# "), "{printed}");
}
