//! One picture of one moment: the same as everywhere else, of the run that a drive is, and nothing where it cannot be.

use std::fs;
use std::path::Path;

use base::png;
use tests::command::aeye;
use tests::recordings::recorded;

/// A picture's bytes.
fn still(command: &str, files: &[&Path], out: &Path) -> Vec<u8> {
    assert_eq!(aeye(command, files, out), (0, String::new()), "{command}");
    fs::read(out).unwrap()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_picture_of_a_file_is_the_one_that_others_make_of_it() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, case) = recorded(dir.path());
    let drawn = dir.path().join("drawn");
    assert_eq!(aeye("rerender --checkpoint truth --size 64x32 --last 0.2s", &[&case], &drawn).0, 0);
    let last = |folder: &str| {
        let pictures = fs::read_dir(drawn.join("a.case").join(folder)).unwrap();
        fs::read(pictures.map(|entry| entry.unwrap().path()).max().unwrap()).unwrap()
    };
    for (layer, folder) in [("rgb", "rgb"), ("classes", "labels")] {
        let command = format!("render --size 64x32 --layer {layer}");
        let picture = still(&command, &[&case], &dir.path().join(format!("{layer}.png")));
        assert!(picture == last(folder), "{layer} of the takeover, the usual moment of a case");
        let same = still(&command, &[&recording], &dir.path().join(format!("{layer}-again.png")));
        assert!(picture == same, "{layer} of the recording");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_picture_of_a_scenario_is_one_of_the_drive_that_it_starts() {
    let dir = tempfile::tempdir().unwrap();
    let place = |name: &str| dir.path().join(name);
    let drive = place("drive.mcap");
    let words = ["aeye", "drive", "--headless", "--map", "rural", "--seed", "3", "--max-time", "4s", "--record"];
    let words = words.into_iter().chain([drive.to_str().unwrap()]);
    aeye::run(&clap::Parser::try_parse_from(words).unwrap()).unwrap();
    let options = "--size 64x32 --at 2.5s --camera chase --layer";
    for layer in ["rgb", "instances", "depth"] {
        let run =
            still(&format!("render --map rural --seed 3 {options} {layer}"), &[], &place(&format!("{layer}.png")));
        let file = still(&format!("render {options} {layer}"), &[&drive], &place(&format!("{layer}-of-file.png")));
        assert!(run == file, "{layer}");
    }
    let other = still(&format!("render --map rural --seed 3 --weather WetNoon {options} rgb"), &[], &place("wet.png"));
    assert!(other != fs::read(place("rgb.png")).unwrap());
    let ((width, height), _) = png::read(&place("rgb.png"), 3).unwrap();
    assert_eq!((width, height), (64, 32));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn what_there_is_no_picture_of_is_said_in_a_sentence() {
    let dir = tempfile::tempdir().unwrap();
    let place = |name: &str| dir.path().join(name);
    let (recording, _) = recorded(dir.path());
    fs::write(place("there.png"), "kept").unwrap();
    let (code, said) = aeye("render --at 1s", &[], &place("there.png"));
    assert!(code == 1 && said.ends_with("there.png: exists already; expected a new file"), "{said}");
    assert_eq!(fs::read(place("there.png")).unwrap(), b"kept");

    let (code, said) = aeye("render --at 1h", &[&recording], &place("late.png"));
    assert!(code == 2 && said.ends_with("and no tick 216000"), "{said}");
    let (code, said) = aeye("render --scenario reverses_onto_the_road --at 10m", &[], &place("over.png"));
    assert!(code == 2 && said.contains("the run ended after "), "{said}");
    let (code, said) = aeye("render --map nowhere.xodr", &[], &place("nowhere.png"));
    assert!(code != 0 && said.contains("nowhere.xodr"), "{said}");
    assert!(!["late.png", "over.png", "nowhere.png"].iter().any(|name| place(name).exists()));
}
