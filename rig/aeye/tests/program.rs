//! The program as people start it: what it says, how it ends, and what it leaves behind.

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;

use base::maps::Map;
use common::{aeye, blind_drive, names, run};
use serde_json::Value;

/// Tells old and new Vulkan loaders, and that of OpenGL, that the driver is where nothing is.
const NO_DRIVER: [(&str, &str); 3] = [
    ("VK_ICD_FILENAMES", "/nonexistent"),
    ("VK_DRIVER_FILES", "/nonexistent"),
    ("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent"),
];

#[test]
fn without_a_graphics_driver_each_command_says_what_to_install_and_leaves_nothing() {
    let dir = tempfile::tempdir().expect("a folder");
    blind_drive(&dir.path().join("run.mcap"), 1);
    for command in [
        "drive --headless --max-time 4s --record new.mcap",
        "campaign --checkpoint truth --runs 1 --out new",
        "render --at 1s --out new.png",
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

#[test]
fn what_does_not_fit_a_scenario_is_told_in_words_of_a_scenario() {
    let dir = tempfile::tempdir().expect("a folder");
    for (text, code, said) in [
        (
            "hazards = \"none\"",
            2,
            "2: hazards is \"none\", expected a section [hazards] with level = \"none\" or \"natural\" or \"raised\"",
        ),
        ("traffic.cars = -1", 2, "2: traffic.cars is -1, expected a whole number from 0 to 500"),
        ("[rules]\nmax_speed = 50", 2, "3: unknown key rules.max_speed, expected one of max_speed_kmh, max_seconds, "),
    ] {
        fs::write(dir.path().join("run.toml"), format!("map = \"rural\"\n{text}\n")).expect("writable");
        refused_by_all(dir.path(), code, &format!("error: run.toml: line {said}"));
    }
    fs::write(dir.path().join("run.toml"), "map = \"nowhere.xodr\"\n").expect("writable");
    refused_by_all(dir.path(), 1, "error: run.toml: line 1: map: nowhere.xodr: ");
}

/// Expects one sentence that begins so, of each command that reads a scenario.
fn refused_by_all(folder: &Path, code: i32, begins: &str) {
    for command in ["drive --headless --record run.mcap", "campaign --checkpoint truth --runs 1 --out runs"] {
        let (got, out, said) = run(aeye(folder, command).args(["--scenario", "run.toml"]));
        assert_eq!((got, out.as_str(), said.lines().count()), (Some(code), "", 1), "{command}: {said}");
        assert!(said.starts_with(begins), "{command}: {said:?} does not begin with {begins:?}");
        assert_eq!(names(folder), ["run.toml"], "{command} left something behind");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn who_has_no_room_on_a_map_is_told_by_every_command_that_drives() {
    let dir = tempfile::tempdir().expect("a folder");
    let map = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/maps/cross_stop.xodr");
    fs::copy(map, dir.path().join("small.xodr")).expect("copied");
    fs::write(dir.path().join("run.toml"), "map = \"small.xodr\"\ntraffic.pedestrians = 500\n").expect("writable");
    let told = |command: &str| {
        let (code, out, said) = run(&mut aeye(dir.path(), command));
        assert_eq!(code, Some(0), "{command}: {said}");
        let told = said.lines().filter(|line| line.starts_with("map small has no room for ")).count();
        (told, serde_json::from_str::<Value>(&out).expect("JSON"))
    };
    let is_short = |run: &Value| run["asked"]["pedestrians"] == 500 && run["missing"]["pedestrians"].as_u64() > Some(0);

    let (times, driven) = told("drive --headless --json --scenario run.toml --max-time 4s --record run.mcap");
    assert!(times == 1 && is_short(&driven), "{driven}");
    let (_, inspected) = told("inspect --json run.mcap");
    assert_eq!((&inspected["asked"], &inspected["missing"]), (&driven["asked"], &driven["missing"]));
    let (_, text, _) = run(&mut aeye(dir.path(), "inspect run.mcap"));
    assert!(
        text.lines().any(|line| line.starts_with("no room for  ") && line.contains(" of 500 pedestrians")),
        "{text}"
    );

    let drives = "--checkpoint truth,early --scenario run.toml --runs 2 --max-time 10s";
    let (times, campaign) = told(&format!("campaign --json {drives} --out runs"));
    let runs = campaign["runs"].as_array().expect("runs");
    assert!(times == 1 && runs.len() == 4 && runs.iter().all(is_short), "{campaign}");

    let frames =
        "--maps small.xodr --pedestrians 500 --scenes 2 --val-scenes 0 --test-scenes 0 --frames 1 --size 64x32";
    assert_eq!(told(&format!("dataset natural --json {frames} --out natural")).0, 1);
}
