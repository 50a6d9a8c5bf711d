//! The program as a process, and something for it to read.
#![allow(dead_code, reason = "each test file uses some of it")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use base::maps::Map;
use kernel::{TickInput, World};
use lab::cityscapes;
use perception::cityscapes::Place;
use render::Frame;
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

/// A dataset of pictures with the sky above, a road below and somebody somewhere.
pub fn dataset(dir: &Path, train: u32, val: u32) {
    const SIZE: (u32, u32) = (64, 32);
    for (split, count) in [("train", train), ("val", val)] {
        for scene in 0..count {
            let walker = 4 + scene * 13 % 48;
            let tag = |(x, y): (u32, u32)| match (walker..walker + 8).contains(&x) && (8..24).contains(&y) {
                true => 4,
                false if y < 16 => 13,
                false => 7,
            };
            let class_ids: Vec<u8> = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| tag((x, y)))).collect();
            let frame = Frame {
                width: SIZE.0,
                height: SIZE.1,
                rgb: class_ids.iter().flat_map(|tag| [tag * 15, 255 - tag * 9, 80]).collect(),
                instance_ids: class_ids.iter().map(|tag| u16::from(*tag == 4)).collect(),
                class_ids,
                ..Frame::default()
            };
            cityscapes::write(dir, &Place { split, city: "toy", scene, frame: 0, camera: None }, &frame)
                .expect("written");
        }
    }
}
