//! Models of a user's own: recordings, datasets and results say whose they are, and are drawn again with them.

use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::Cli;
use clap::Parser;
use replay::Recording;
use tests::command::aeye;
use tests::files::contents;
use tests::recordings::recorded;

const LIST: &str = "[[models]]\nfile = \"box.gltf\"\nis = [\"car\", \"ego\", \"tree\"]\n";

/// A folder with a box of the proportions of a car, `long` times as long.
fn folder(dir: &Path, name: &str, long: f32) -> PathBuf {
    let folder = dir.join(name);
    fs::create_dir(&folder).unwrap();
    let size = [1.85, 1.5, 4.5 * long];
    let corner = |i: usize| (0..3).map(move |axis| if i >> axis & 1 == 1 { size[axis] } else { 0.0f32 });
    let faces = [[1u16, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];
    let mut bytes: Vec<u8> = (0..8).flat_map(corner).flat_map(f32::to_le_bytes).collect();
    bytes.extend(faces.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).flat_map(u16::to_le_bytes));
    fs::write(folder.join("box.bin"), &bytes).unwrap();
    let text = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [2, 2, 9]},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "buffers": [{"uri": "box.bin", "byteLength": 168}]}"#;
    fs::write(folder.join("box.gltf"), text).unwrap();
    fs::write(folder.join("models.toml"), LIST).unwrap();
    folder
}

/// What a command line is refused with.
fn refused(command: &str) -> String {
    Cli::try_parse_from(command.split(' ')).err().map(|error| error.to_string()).unwrap_or_default()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_drive_through_models_says_so_and_is_drawn_again() {
    let dir = tempfile::tempdir().unwrap();
    let models = folder(dir.path(), "models", 1.0);
    let id = base::models::read(&models).unwrap();
    let drive = "drive --headless --map city --seed 3 --max-time 4s";
    for (checkpoint, quality, said) in [("early", "standard", " standard"), ("truth", "plain", "")] {
        let [own, usual] = ["own", "usual"].map(|name| dir.path().join(format!("{name}-{checkpoint}.mcap")));
        let with = format!("{drive} --checkpoint {checkpoint} --models {} --record", models.display());
        let run = |command: &str, record: &Path| {
            let line = format!("aeye {command} {}", record.display());
            aeye::exit::number(&aeye::run(&Cli::try_parse_from(line.split(' ')).expect("a valid command line")))
        };
        assert_eq!(run(&with, &own), 0);
        assert_eq!(run(&format!("{drive} --checkpoint {checkpoint} --record"), &usual), 0);
        let log = |path: &Path| Recording::open(path).unwrap().into_log();
        assert_eq!(log(&own).manifest.provenance["camera"], format!("driver 256x128 {quality} models={id}"));
        assert_eq!(log(&usual).manifest.provenance["camera"], format!("driver 256x128{said}"));
        let seen = |path: &Path| log(path).masks.iter().map(|mask| mask.digest).take(3).collect::<Vec<_>>();
        assert_ne!(seen(&own), seen(&usual), "{checkpoint}");
        assert_eq!(run(&format!("view --digests --models {}", models.display()), &own), 0, "the same again");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_dataset_says_whose_models_it_has_and_is_made_again() {
    let dir = tempfile::tempdir().unwrap();
    let models = folder(dir.path(), "models", 1.01);
    let id = base::models::read(&models).unwrap().to_string();
    let make = "dataset natural --scenes 1 --val-scenes 0 --test-scenes 0 --frames 2 --size 64x32 --maps city --seed 5";
    let [own, usual, again] = ["own", "usual", "again"].map(|name| dir.path().join(name));
    assert_eq!(aeye(&format!("{make} --models {}", models.display()), &[], &own).0, 0);
    assert_eq!(aeye(make, &[], &usual).0, 0);
    let text = |folder: &Path, file: &str| fs::read_to_string(folder.join(file)).unwrap();
    let recipe: serde_json::Value = serde_json::from_str(&text(&own, "dataset.json")).unwrap();
    assert_eq!(recipe["recipe"]["models"], id);
    assert!(text(&own, "frames.jsonl").contains(&format!("\"driver 64x32 standard models={id}\"")));
    assert!(!text(&usual, "dataset.json").contains("models") && !text(&usual, "frames.jsonl").contains("models"));
    assert_eq!(aeye(&format!("dataset rebuild --models {}", models.display()), &[&own], &again), (0, String::new()));
    assert!(contents(&again) == contents(&own));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn models_that_are_not_given_are_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, _) = recorded(dir.path());
    let mut log = Recording::open(&recording).unwrap().into_log();
    let digest = "5a".repeat(16);
    log.manifest.provenance.insert("camera".into(), format!("driver 64x32 plain models={digest}"));
    let path = dir.path().join("unread.mcap");
    log.manifest.provenance.insert("checkpoint_digest".into(), "truth".into());
    fs::write(&path, log.encode().unwrap()).unwrap();
    let (code, said) = aeye("redrive --without-intervention", &[&path], &dir.path().join("forks"));
    assert!(code == 1 && said.contains(&digest) && said.contains("--models DIR"), "{said}");
}

#[test]
fn models_that_cannot_be_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let nowhere = dir.path().join("nowhere");
    let command = |folder: &Path| format!("aeye render --out a.png --models {}", folder.display());
    assert!(refused(&command(&nowhere)).contains("nowhere: expected a folder with models.toml"));
    let long = folder(dir.path(), "long", 1.6);
    let said = refused(&command(&long));
    assert!(said.contains("box.gltf: as ego it would be stretched 1.00 times in length, 1.60 in width"), "{said}");
}
