//! A training that is killed, goes on, and is there already: the program as people start it.

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use common::dataset;

fn train(dir: &Path, out: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_aeye"));
    let options = "--json train --dataset data --epochs 8 --size 64x32 --batch 4 --out";
    command.current_dir(dir).args(options.split(' ')).arg(out);
    command
}

/// The checkpoint and all that stands beside it, by name; not what a kill in the middle of writing left.
fn results(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(dir).expect("a readable folder").map(|entry| entry.expect("an entry").path());
    let named = files.map(|path| (path.file_name().expect("a name").to_string_lossy().into_owned(), path));
    named.filter(|(name, _)| name.starts_with("c.")).map(|(name, path)| (name, fs::read(path).expect("read"))).collect()
}

#[test]
fn a_training_that_is_killed_ends_with_the_same_files_and_is_done_once() {
    let dir = tempfile::tempdir().expect("a folder");
    let place = |name: &str| dir.path().join(name);
    dataset(&place("data"), 8, 2);
    for folder in ["whole", "killed"] {
        fs::create_dir(place(folder)).expect("writable");
    }
    let whole = train(dir.path(), "whole/c.onnx").output().expect("the program starts");
    assert!(whole.status.success(), "{}", String::from_utf8_lossy(&whole.stderr));

    let mut killed = train(dir.path(), "killed/c.onnx").stdout(Stdio::piped()).spawn().expect("the program starts");
    let lines = BufReader::new(killed.stdout.take().expect("a pipe")).lines();
    assert_eq!(lines.take(2).count(), 2, "two epochs");
    killed.kill().expect("killed");
    killed.wait().expect("ended");
    assert_eq!(results(&place("killed")).into_keys().collect::<Vec<_>>(), ["c.onnx.part"]);
    fs::write(place("killed/c.onnx"), "mine").expect("writable");
    let refused = train(dir.path(), "killed/c.onnx").output().expect("the program starts");
    assert_eq!(refused.status.code(), Some(1), "{}", String::from_utf8_lossy(&refused.stderr));
    assert_eq!(fs::read_to_string(place("killed/c.onnx")).expect("it is there"), "mine");
    fs::remove_file(place("killed/c.onnx")).expect("it is there");
    let resumed = train(dir.path(), "killed/c.onnx").output().expect("the program starts");
    let said = String::from_utf8_lossy(&resumed.stderr).into_owned();
    assert!(resumed.status.success() && !said.contains("; 0 epochs done"), "{said}");

    let files = results(&place("whole"));
    let after_a_kill = results(&place("killed"));
    assert_eq!(files.keys().collect::<Vec<_>>(), ["c.jsonl", "c.md", "c.onnx", "c.svg"]);
    assert_eq!(files.keys().collect::<Vec<_>>(), after_a_kill.keys().collect::<Vec<_>>());
    let differing: Vec<_> = files.iter().filter(|(name, bytes)| after_a_kill[*name] != **bytes).map(|f| f.0).collect();
    assert!(differing.is_empty(), "{differing:?}");
    let printed = String::from_utf8(whole.stdout).expect("UTF-8");
    let (epochs, end) = printed.trim_end().rsplit_once('\n').expect("epochs and an end");
    assert_eq!(format!("{epochs}\n").as_bytes(), files["c.jsonl"]);
    let end: serde_json::Value = serde_json::from_str(end).expect("JSON");
    assert_eq!((&end["type"], &end["card"]), (&"aeye.train".into(), &"whole/c.md".into()));
    let first: serde_json::Value = serde_json::from_str(printed.lines().next().expect("a line")).expect("JSON");
    assert!(first["iou"]["Sky"].is_f64() && first["rate"].as_f64().is_some_and(|rate| (rate - 2e-3).abs() < 1e-9));

    // As a kill leaves it that comes just after the last file was written.
    fs::copy(place("whole/c.onnx"), place("whole/c.onnx.part")).expect("writable");
    let again = train(dir.path(), "whole/c.onnx").output().expect("the program starts");
    let said = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(
        String::from_utf8_lossy(&again.stdout).lines().count() == 1
            && said.starts_with("whole/c.onnx: is trained already"),
        "{said}"
    );

    assert!(results(&place("whole")) == files);

    let other = train(dir.path(), "whole/c.onnx").args(["--seed", "9"]).output().expect("the program starts");
    let said = String::from_utf8_lossy(&other.stderr).into_owned();
    assert_eq!((other.status.code(), said.lines().count()), (Some(1), 1), "{said}");
    assert!(said.contains("whole/c.onnx: exists already and is not what these options make"), "{said}");
    assert!(results(&place("whole")) == files, "nothing is overwritten");
}

#[test]
fn a_dataset_that_changed_under_a_training_is_named() {
    let dir = tempfile::tempdir().expect("a folder");
    dataset(&dir.path().join("data"), 8, 2);
    let mut begun = train(dir.path(), "c.onnx").stdout(Stdio::piped()).spawn().expect("the program starts");
    assert_eq!(BufReader::new(begun.stdout.take().expect("a pipe")).lines().take(1).count(), 1);
    begun.kill().expect("killed");
    begun.wait().expect("ended");
    dataset(&dir.path().join("data"), 9, 2);
    let refused = train(dir.path(), "c.onnx").output().expect("the program starts");
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!((refused.status.code(), said.lines().count()), (Some(1), 1), "{said}");
    let words = ["c.onnx.part", "its dataset has changed", "remove it to start anew"];
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
}
