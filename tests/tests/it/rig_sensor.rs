//! Cameras with a sensor: recordings, datasets and results say what it does, and are drawn again as they were.

use std::fs;
use std::path::Path;

use aeye::cli::Cli;
use clap::Parser;
use tests::command::aeye;
use tests::files::contents;
use tests::recordings::recorded;

fn run(words: &[&str]) -> u8 {
    let cli = Cli::try_parse_from(["aeye", "--json"].iter().chain(words)).expect("a valid command line");
    aeye::exit::number(&aeye::run(&cli))
}

/// What a command line is refused with.
fn refused(command: &str) -> String {
    let parsed = Cli::try_parse_from(command.split(' '));
    parsed.err().map(|error| error.to_string()).unwrap_or_default()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_drive_is_drawn_again_as_its_sensor_saw_it() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("drive.mcap");
    let place = path.to_str().unwrap();
    let drive = ["drive", "--headless", "--map", "rural", "--seed", "3", "--max-time", "4s", "--checkpoint", "early"];
    let sensor = ["--sensor", "noise=6,k1=-0.1,motion_blur_s=0.02", "--record", place];
    assert_eq!(run(&[&drive[..], &sensor].concat()), 0);
    let log = replay::Recording::open(&path).unwrap().into_log();
    let said = &log.manifest.provenance["camera"];
    assert_eq!(said, "driver 256x128 standard noise=6,k1=-0.1,motion_blur_s=0.02");
    assert_eq!(run(&["view", "--digests", place]), 0, "the network sees the same again");

    // Without the sensor it would not: recordings that say nothing of one have none.
    let ideal = dir.path().join("ideal.mcap");
    assert_eq!(run(&[&drive[..], &["--record", ideal.to_str().unwrap()]].concat()), 0);
    let other = replay::Recording::open(&ideal).unwrap().into_log();
    assert_eq!(other.manifest.provenance["camera"], "driver 256x128 standard");
    assert_eq!(run(&["view", "--digests", ideal.to_str().unwrap()]), 0);
    let seen = |log: &replay::Log| log.masks.iter().map(|mask| mask.digest).take(3).collect::<Vec<_>>();
    assert_ne!(seen(&log), seen(&other));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_dataset_says_what_its_sensor_does_and_is_made_again() {
    let dir = tempfile::tempdir().unwrap();
    let make =
        "dataset natural --scenes 1 --val-scenes 0 --test-scenes 0 --frames 2 --size 64x32 --maps rural --seed 5";
    let sensor = "exposure_ev=-1,noise=4,vignetting=0.5";
    let [noisy, ideal, again] = ["noisy", "ideal", "again"].map(|name| dir.path().join(name));
    assert_eq!(aeye(&format!("{make} --sensor {sensor}"), &[], &noisy).0, 0);
    assert_eq!(aeye(make, &[], &ideal).0, 0);
    let text = |folder: &Path, file: &str| fs::read_to_string(folder.join(file)).unwrap();
    let recipe: serde_json::Value = serde_json::from_str(&text(&noisy, "dataset.json")).unwrap();
    assert_eq!(recipe["recipe"]["sensor"], sensor);
    assert!(text(&noisy, "frames.jsonl").contains(&format!("\"driver 64x32 standard {sensor}\"")));
    assert!(
        !text(&ideal, "dataset.json").contains("sensor")
            && text(&ideal, "frames.jsonl").contains("\"driver 64x32 standard\"")
    );
    assert_eq!(aeye("dataset rebuild", &[&noisy], &again), (0, String::new()));
    assert!(contents(&again) == contents(&noisy));
    let kinds = |folder: &Path, ending: &str| -> Vec<Vec<u8>> {
        contents(folder)
            .into_iter()
            .filter(|(name, _)| name.to_string_lossy().ends_with(ending))
            .map(|(_, bytes)| bytes)
            .collect()
    };
    assert!(kinds(&noisy, "_labelIds.png") == kinds(&ideal, "_labelIds.png"), "labels are those of the scene");
    assert!(kinds(&noisy, "_leftImg8bit.png") != kinds(&ideal, "_leftImg8bit.png"));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn results_of_one_sensor_are_not_those_of_another() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let out = dir.path().join("out");
    let command = "rerender --checkpoint truth --size 64x32 --last 0.2s";
    assert_eq!(aeye(&format!("{command} --sensor noise=4"), &[&case], &out).0, 0);
    let (code, said) = aeye(command, &[&case], &out);
    assert!(code == 1 && said.contains("--sensor noise=4; expected the same"), "{said}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn every_camera_of_a_file_takes_its_picture() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, _) = recorded(dir.path());
    let rig = dir.path().join("rig.toml");
    let camera = |name: &str, more: &str| format!("[[cameras]]\nname = \"{name}\"\nx_m = 2.0\nz_m = 1.5\n{more}\n");
    fs::write(&rig, camera("front", "") + &camera("left", "yaw_rad = 1.57\nwidth = 48\nsensor = \"k1=-0.1\"")).unwrap();
    let command = format!("render --size 64x32 --cameras {}", rig.display());
    let out = dir.path().join("pictures");
    assert_eq!(aeye(&command, &[&recording], &out), (0, String::new()));
    let of = |name: &str| base::png::read(&out.join(name), 3).unwrap();
    assert_eq!((of("front.png").0, of("left.png").0), ((64, 32), (48, 32)));
    assert_eq!(fs::read_dir(&out).unwrap().count(), 2);
    let (code, said) = aeye(&command, &[&recording], &out);
    assert!(code == 1 && said.contains("exists already"), "{said}");

    let drawn = dir.path().join("drawn");
    let rerender = format!("rerender --checkpoint truth --size 64x32 --last 0.2s --cameras {}", rig.display());
    assert_eq!(aeye(&rerender, &[&recording], &drawn), (0, String::new()));
    let last = |folder: &str| {
        let pictures = fs::read_dir(drawn.join("a").join(folder)).unwrap();
        fs::read(pictures.map(|entry| entry.unwrap().path()).max().unwrap()).unwrap()
    };
    assert!(last("cameras/front/rgb") == fs::read(out.join("front.png")).unwrap(), "of the same tick");
    assert!(last("cameras/left/rgb") == fs::read(out.join("left.png")).unwrap());
    assert!(last("cameras/left/labels") != last("labels"));
    let whole = contents(&drawn);
    assert_eq!(aeye(&rerender, &[&recording], &drawn), (0, String::new()));
    assert!(contents(&drawn) == whole, "what is there is kept");
    fs::write(&rig, camera("front", "k1 = 3")).unwrap();
    let (code, said) = aeye(&command, &[&recording], &dir.path().join("none"));
    assert!(code == 2 && said.contains("unknown field `k1`") && !dir.path().join("none").exists(), "{said}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_sensor_that_cannot_be_is_refused() {
    assert!(
        refused("aeye render --out a.png --sensor noise=nan")
            .contains("noise is \"nan\"; expected a number from 0 to 32")
    );
    assert!(refused("aeye render --out a.png --sensor iso=100").contains("no such setting: \"iso\""));
    assert!(refused("aeye campaign --runs 1 --out a --sensor noise=1,noise=2").contains("noise is given twice"));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn what_no_camera_can_draw_is_refused_before_anything_is_done() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let there = contents(dir.path());
    let commands = [
        ("render --map rural --at 0s", "still.png"),
        ("gallery --maps rural", "gallery"),
        ("rerender --checkpoint truth CASE", "rerendered"),
        ("export --format gif CASE", "case.gif"),
        ("export CASE", "case.mcap"),
        ("dataset natural --maps rural --scenes 1 --val-scenes 0 --test-scenes 0 --frames 1", "natural"),
        ("dataset cases CASE", "cases"),
    ];
    let cameras = [
        ("--size 64x32 --sensor k1=-0.9", "a lens of k1=-0.9 folds the picture"),
        ("--size 6000x64 --quality fine", "fine pictures of 6000x64; expected sides of at most"),
    ];
    for ((command, out), (camera, words)) in commands.into_iter().flat_map(|command| cameras.map(|it| (command, it))) {
        let files: &[&Path] = if command.contains("CASE") { &[&case] } else { &[] };
        let command = format!("{} {camera}", command.trim_end_matches(" CASE"));
        let (code, said) = aeye(&command, files, &dir.path().join(out));
        assert!(code == 2 && said.starts_with(words) && !said.contains('\n'), "{command}: {code}, {said:?}");
        assert!(contents(dir.path()) == there, "{command}: something was left");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_still_is_a_new_png_file() {
    let dir = tempfile::tempdir().unwrap();
    let still = |out: &Path| aeye("render --map rural --at 0s --size 64x32", &[], out);
    let refused = |name: &str, words: &str| {
        let (code, said) = still(&dir.path().join(name));
        assert!(code == 2 && said.contains(words) && contents(dir.path()).is_empty(), "{name}: {code}, {said}");
    };
    refused("still", "expected the name of a PNG file, as in still.png");
    refused("still.jpg", "expected the name of a PNG file");
    let out = dir.path().join("still.png");
    assert_eq!(still(&out).0, 0);
    let drawn = fs::read(&out).unwrap();
    let (code, said) = still(&out);
    assert!(code == 1 && said.contains("exists already") && fs::read(&out).unwrap() == drawn, "{code}, {said}");
}
