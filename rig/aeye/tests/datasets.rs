//! What is left of a dataset when the disk fills up while it is written.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use base::maps::Map;
use kernel::{TickInput, World};
use replay::{Case, Manifest, Provenance, Recorder, Recording};

const AEYE: &str = env!("CARGO_BIN_EXE_aeye");
/// Two small datasets, apart from seed and folder.
const NATURAL: &str = "dataset natural --maps rural --scenes 2 --val-scenes 1 --test-scenes 0 --frames 5 --size 128x64";

/// Exit code and stderr of a command, in which no file may grow beyond so many kilobytes: a limit stands
/// for a disk that is full, as the same write fails.
fn limited(kilobytes: &str, folder: &Path, arguments: &str) -> (Option<i32>, String) {
    let limit = "trap '' XFSZ; ulimit -f \"$0\"; exec \"$@\"";
    let mut command = Command::new("bash");
    command.args(["-c", limit, kilobytes, AEYE]).args(arguments.split_whitespace()).current_dir(folder);
    let Output { status, stderr, .. } = command.output().expect("bash starts");
    (status.code(), String::from_utf8(stderr).expect("UTF-8"))
}

fn made(folder: &Path, arguments: &str) {
    let (code, said) = limited("unlimited", folder, arguments);
    assert_eq!(code, Some(0), "{said}");
}

/// The one sentence of a command that ran out of disk.
fn full(kilobytes: &str, folder: &Path, arguments: &str) -> String {
    let (code, said) = limited(kilobytes, folder, arguments);
    let sentences: Vec<&str> = said.lines().filter(|line| line.starts_with("error: ")).collect();
    assert!(code == Some(1) && sentences.len() == 1 && sentences[0].contains(": File too large"), "{said}");
    sentences[0].to_owned()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a readable folder").map(|e| e.expect("an entry"));
    let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// A case of 3 s in which nothing happens.
fn uneventful_case(path: &Path) {
    let map = Map::find("rural").expect("bundled");
    let scenario = map.scenario(1);
    let manifest = Manifest::new(&scenario, &map.network, None, Provenance::default());
    let mut world = World::new(&scenario, &map.network).expect("a world");
    let mut recorder = Recorder::new(Vec::new(), &manifest, &world.initial_keyframe()).expect("a recording");
    for _ in 0..200 {
        let output = world.step(&TickInput::default());
        recorder.tick(&TickInput::default(), &output, &world.part_hashes()).expect("a tick");
    }
    let recording = Recording::from_bytes(&recorder.finish(None).expect("its end")).expect("whole");
    let case = Case::cut(&recording, &map.network, 20..=194).expect("a case");
    fs::write(path, case.encode().expect("a file")).expect("writable");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_full_disk_is_named_and_what_it_leaves_can_be_completed_or_is_nothing() {
    let dir = tempfile::tempdir().expect("a folder");
    let folder = dir.path();
    uneventful_case(&folder.join("a.case.mcap"));
    let natural = format!("{NATURAL} --seed 1 --out natural");
    let said = full("2", folder, &natural);
    assert!(said.contains("natural/leftImg8bit/") && said.contains("_leftImg8bit.png: "), "{said}");
    full("8", folder, &natural);
    assert!(!folder.join("natural/dataset.json").exists());
    made(folder, &natural);
    made(folder, &format!("{NATURAL} --seed 1 --out again"));
    for file in ["dataset.json", "frames.jsonl"] {
        let read = |name: &str| fs::read(folder.join(name).join(file)).expect("written");
        assert_eq!(read("natural"), read("again"));
    }
    assert_eq!(names(&folder.join("natural")), names(&folder.join("again")));

    let before = names(folder);
    full("2", folder, "dataset cases a.case.mcap --size 128x64 --out cases");
    assert_eq!(names(folder), before, "nothing is left");

    made(folder, "dataset cases a.case.mcap --size 128x64 --out cases");
    made(folder, &format!("{NATURAL} --seed 2 --out pool"));
    let before = names(folder);
    let mix = "dataset mix --natural natural --pool pool --corner-cases cases --replace 4 --out mix";
    let said = full("4", folder, mix);
    assert!(said.contains("frames.jsonl"), "{said}");
    assert_eq!(names(folder), before, "nothing is left");
    made(folder, mix);
    assert_eq!(names(&folder.join("mix")), ["corner-case", "natural", "pedestrian"]);
}
