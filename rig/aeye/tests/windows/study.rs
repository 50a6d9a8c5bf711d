//! A blind drive gives nothing away: not on the terminal, not by a file's name, not when inspected,
//! until it is revealed.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use replay::Recording;

use crate::display::Display;
use crate::rig::{AEYE, CENTRE, SAFETY, wait_for_tick, wait_until};

/// Names that no other text contains.
const CANDIDATES: [&str; 2] = ["zebra.onnx", "walrus.onnx"];
const EARLY: &[u8] = include_bytes!("../../../../perception/checkpoints/early.onnx");

fn aeye(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(AEYE);
    command.current_dir(folder).args(arguments.split_whitespace());
    command
}

/// Everything that a command said, which must have gone well.
fn said(output: &Output) -> String {
    let text = [&output.stdout[..], &output.stderr[..]].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert!(output.status.success(), "{text:?}");
    text.concat()
}

fn tells(text: &str) -> bool {
    ["zebra", "walrus"].iter().any(|name| text.contains(name)) || text.contains(&digest())
}

/// The digest of both candidates, which are the same network.
fn digest() -> String {
    blake3::hash(EARLY).to_hex().to_string()
}

fn folder() -> tempfile::TempDir {
    let dir = tempfile::tempdir().expect("a folder");
    CANDIDATES.iter().for_each(|name| fs::write(dir.path().join(name), EARLY).expect("writable"));
    dir
}

/// The files of a folder that drives have made.
fn made(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a readable folder").map(|e| e.expect("an entry").file_name());
    let mut names: Vec<String> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
    names.retain(|name| !CANDIDATES.contains(&name.as_str()));
    names.sort();
    names
}

/// What inspecting a blind drive tells, and what it tells when asked.
fn check(folder: &Path, file: &str) {
    for form in ["", "--json "] {
        let hidden = said(&aeye(folder, &format!("{form}inspect {file}")).output().expect("aeye runs"));
        assert!(!tells(&hidden) && hidden.contains("one of 2 checkpoints"), "{hidden}");
        let revealed = said(&aeye(folder, &format!("{form}inspect {file} --reveal")).output().expect("aeye runs"));
        assert!(tells(&revealed) && revealed.contains(&digest()), "{revealed}");
    }
    let viewed = aeye(folder, &format!("view {file}")).output().expect("aeye runs");
    let sentence = String::from_utf8_lossy(&viewed.stderr);
    assert_eq!(viewed.status.code(), Some(2), "{sentence}");
    assert!(sentence.contains("--reveal") && !tells(&sentence) && viewed.stdout.is_empty(), "{sentence}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_blind_headless_drive_tells_nothing() {
    let dir = folder();
    let drive = "drive --headless --map rural --max-time 4s --record run.mcap --semantic-name P07 --blind";
    let text = said(&aeye(dir.path(), drive).arg(CANDIDATES.join(",")).output().expect("aeye runs"));
    assert!(!tells(&text), "{text}");
    assert_eq!(made(dir.path()), ["run.mcap"]);
    check(dir.path(), "run.mcap");
    // Which one it was follows from the seed.
    let checkpoint = |seed: u32| {
        let drive = drive.replace("run.mcap", &format!("{seed}.mcap"));
        let output = aeye(dir.path(), &drive).arg(CANDIDATES.join(",")).args(["--seed", &seed.to_string()]).output();
        said(&output.expect("aeye runs"));
        let recording = Recording::open(&dir.path().join(format!("{seed}.mcap"))).expect("a recording");
        recording.log().manifest.provenance["checkpoint"].clone()
    };
    let drawn: Vec<String> = (10..16).map(checkpoint).collect();
    assert!(["zebra", "walrus"].iter().all(|name| drawn.iter().any(|d| d == name)), "{drawn:?}");
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn a_blind_live_drive_for_familiarisation_tells_nothing_and_leaves_no_case() {
    let dir = folder();
    let display = Display::open(dir.path());
    let drive = "drive --map city --record run.mcap --semantic bot --safety keyboard --familiarisation \
                 --semantic-name P07 --safety-name P03 --blind";
    let mut command = aeye(dir.path(), drive);
    command
        .arg(CANDIDATES.join(","))
        .env("DISPLAY", display.name())
        .env("XDG_CONFIG_HOME", display.folder())
        .env_remove("WAYLAND_DISPLAY");
    let rig = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("aeye starts");
    let record = dir.path().join("run.mcap");

    let [safety, centre] = [SAFETY, CENTRE].map(|title| display.window(title));
    display.focus(&centre);
    display.keys(&["key", "n"]);
    wait_for_tick(&record, 240);
    display.keep("study");
    display.focus(&safety);
    display.keys(&["key", "Shift_R"]);
    display.keys(&["keydown", "Down"]);
    wait_until(|| Recording::open(&record).is_ok_and(|recording| recording.log().intervention.is_some()));
    display.keys(&["keyup", "Down"]);
    // The car comes to a stand; then the label is taken.
    wait_until(|| {
        display.keys(&["key", "4", "Return"]);
        Recording::open(&record).is_ok_and(|recording| recording.finished())
    });
    display.keys(&["key", "Escape"]);
    let text = said(&rig.wait_with_output().expect("aeye ends"));
    assert!(!tells(&text) && text.contains("familiarisation: does not count"), "{text}");
    assert_eq!(made(dir.path()).iter().filter(|name| name.ends_with(".mcap")).collect::<Vec<_>>(), ["run.mcap"]);
    check(dir.path(), "run.mcap");
    let provenance = &Recording::open(&record).expect("a recording").log().manifest.provenance.clone();
    assert_eq!((&*provenance["semantic_name"], &*provenance["safety_name"]), ("P07", "P03"));
    let contents = crate::rig::aeye(&["inspect"], &record);
    let (seen, age) = (&contents["measures"]["seen"], &contents["measures"]["mask_age"]);
    assert_eq!((seen.as_array().map(Vec::len), &seen[0]["seat"]), (Some(1), &"safety".into()), "{contents}");
    let [ticks, ms, screen_ms] = ["ticks", "ms", "frame_to_screen_ms"].map(|unit| age[unit]["median"].as_f64());
    assert!(ticks >= Some(1.0) && ms > Some(0.0) && screen_ms > Some(0.0), "{age}");
}
