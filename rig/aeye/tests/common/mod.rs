//! The program as a process, and something for it to read.
#![allow(dead_code, reason = "each test file uses some of it")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use base::maps::Map;
use kernel::{TickInput, World};
use replay::{Manifest, Provenance, Recorder};

/// The program in a folder, with arguments that hold no blanks.
pub fn aeye(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_aeye"));
    command.current_dir(folder).args(arguments.split_whitespace());
    command
}

/// Its exit code, and what it says on stdout and stderr.
pub fn run(command: &mut Command) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } = command.output().expect("the program starts");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (status.code(), text(stdout), text(stderr))
}

/// What a folder holds.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a readable folder").map(|e| e.expect("an entry"));
    let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// A second of a drive that nobody had to see.
pub fn blind_drive(path: &Path, seed: u64) {
    let map = Map::find("rural").expect("bundled");
    let scenario = map.scenario(seed);
    let manifest = Manifest::new(&scenario, &map.network, None, Provenance::default());
    let mut world = World::new(&scenario, &map.network).expect("a world");
    let mut recorder = Recorder::new(Vec::new(), &manifest, &world.initial_keyframe()).expect("a recording");
    for _ in 0..60 {
        let output = world.step(&TickInput::default());
        recorder.tick(&TickInput::default(), &output, &world.part_hashes()).expect("a tick");
    }
    fs::write(path, recorder.finish(None).expect("its end")).expect("writable");
}
