//! The program as people start it: what it says, how it ends, and what it leaves behind.

mod common;

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
