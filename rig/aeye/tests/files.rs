//! What the program makes of files and folders: what counts once, what is no recording, and whose a folder is.

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use base::output::OutputFolder;
use common::{aeye, blind_drive, names, run};
use replay::Exporter;
use serde_json::Value;

/// An export for viewers in which there is nothing.
fn export(path: &Path) {
    let exporter = Exporter::new(Vec::new(), BTreeMap::new()).expect("starts");
    fs::write(path, exporter.finish().expect("ends")).expect("writable");
}

/// Exit code and the lines of JSON of a command.
fn lines(folder: &Path, arguments: &str) -> (Option<i32>, Vec<Value>) {
    let (code, out, _) = run(&mut aeye(folder, &format!("--json {arguments}")));
    (code, out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect())
}

/// Whether one sentence is said, which names a file and holds these words.
fn is_told(said: &Value, file: &str, words: &str) -> bool {
    said["file"].as_str().is_some_and(|told| told.ends_with(file))
        && said["error"].as_str().is_some_and(|told| told.contains(words))
}

#[cfg(unix)]
#[test]
fn the_same_recording_counts_once_in_every_command() {
    let dir = tempfile::tempdir().expect("a folder");
    let at = |name: &str| dir.path().join(name);
    blind_drive(&at("a.mcap"), 1);
    fs::hard_link(at("a.mcap"), at("b.mcap")).expect("linked");
    std::os::unix::fs::symlink(at("a.mcap"), at("c.mcap")).expect("linked");
    for command in ["verify", "inspect", "statistics"] {
        let (code, said) = lines(dir.path(), &format!("{command} ."));
        assert_eq!((code, said.len()), (Some(0), 1), "{command}: links are one file: {said:?}");
    }
    fs::copy(at("a.mcap"), at("d.mcap")).expect("copied");
    let same = "holds the same recording as ./a.mcap; expected each once";
    let (code, said) = lines(dir.path(), "verify .");
    assert_eq!((code, said.len()), (Some(1), 2), "{said:?}");
    assert!(is_told(&said[0], "d.mcap", same) && said[1]["ok"] == true, "{said:?}");
    let (code, said) = lines(dir.path(), "inspect .");
    assert_eq!((code, said.len()), (Some(1), 2), "{said:?}");
    let overall = &said[1];
    assert!(overall["files"] == 1 && is_told(&overall["failed"][0], "d.mcap", same), "{overall}");
    let (code, said) = lines(dir.path(), "statistics .");
    assert!(code == Some(1) && said[0]["checkpoints"][0]["rides"] == 1, "{said:?}");
    assert!(is_told(&said[0]["failed"][0], "d.mcap", same), "{said:?}");
}

#[test]
fn exports_are_passed_over_in_folders_and_told_where_they_are_named() {
    let dir = tempfile::tempdir().expect("a folder");
    blind_drive(&dir.path().join("a.mcap"), 1);
    for name in ["a.case.mcap", "b.mcap"] {
        export(&dir.path().join(name));
    }
    for (command, passed) in [("verify", &["a.case", "b"][..]), ("inspect", &["a.case", "b"]), ("statistics", &["b"])] {
        let (code, _, said) = run(&mut aeye(dir.path(), &format!("{command} .")));
        assert_eq!(code, Some(0), "{command}: {said}");
        let notes = passed.iter().map(|name| format!("./{name}.mcap: left out, an export of aeye for viewers"));
        let mut told: Vec<&str> = said.lines().collect();
        told.sort_unstable();
        assert_eq!(told, notes.collect::<Vec<_>>(), "{command}");
    }
    for command in ["verify", "inspect", "statistics", "view --digests", "report --checkpoint truth --out p.html"] {
        if command.starts_with("report") && cfg!(no_vulkan) {
            continue;
        }
        let (code, _, said) = run(aeye(dir.path(), command).arg("a.case.mcap"));
        let sentence = "error: a.case.mcap: is an export of aeye for viewers, not a recording\n";
        assert_eq!((code, said.as_str()), (Some(1), sentence), "{command}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_not_utf_8_is_told_and_the_rest_goes_on() {
    use std::os::unix::ffi::OsStrExt;
    let dir = tempfile::tempdir().expect("a folder");
    blind_drive(&dir.path().join("a.mcap"), 1);
    blind_drive(&dir.path().join(std::ffi::OsStr::from_bytes(b"\xff.mcap")), 2);
    for command in ["verify", "inspect", "statistics"] {
        let (code, said) = lines(dir.path(), &format!("{command} ."));
        let failed =
            said.iter().flat_map(|line| [line].into_iter().chain(line["failed"].as_array().into_iter().flatten()));
        let told = failed.filter(|line| is_told(line, ".mcap", "its name is not UTF-8; expected one that is"));
        assert_eq!((code, told.count()), (Some(1), 1), "{command}: {said:?}");
    }
}

#[test]
fn a_drive_is_recorded_only_where_it_is_found_again() {
    let dir = tempfile::tempdir().expect("a folder");
    for name in ["d2", "d2.case.mcap", "d2.fork-1.mcap", ".d2.mcap"] {
        let (code, _, said) = run(aeye(dir.path(), "drive --headless --max-time 4s --record").arg(name));
        assert!(code == Some(2) && said.contains("as in drive.mcap"), "{name}: {said}");
    }
    assert!(names(dir.path()).is_empty());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_folder_of_results_is_of_one_process_at_a_time() {
    let dir = tempfile::tempdir().expect("a folder");
    blind_drive(&dir.path().join("a.mcap"), 1);
    let folder = OutputFolder::open(&dir.path().join("out")).expect("free");
    for command in [
        "campaign --checkpoint truth --runs 1",
        "rerender a.mcap --checkpoint truth",
        "compare a.mcap --checkpoint truth,early",
        "redrive a.mcap --without-intervention",
        "export a.mcap",
        "dataset natural --scenes 1 --val-scenes 0 --frames 1",
        "demo",
        "experiment --preset smoke",
    ] {
        let (code, _, said) = run(aeye(dir.path(), command).args(["--out", "out"]));
        let sentence = "error: out: another aeye is at work there; expected another folder, or to wait\n";
        assert_eq!((code, said.as_str()), (Some(75), sentence), "{command}");
    }
    drop(folder);
    assert_eq!(names(dir.path()), ["a.mcap"]);
}
