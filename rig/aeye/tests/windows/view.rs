//! The replay viewer as people use it: the check of mask digests as a command, the window on a virtual
//! display with real keys and a real pointer.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use replay::{Case, Log, Recording};
use serde_json::Value;

use crate::display::Display;
use crate::rig::AEYE;

/// Nothing takes this long; without it a test that waits in vain would never end.
const PATIENCE: Duration = Duration::from_secs(240);
/// Length of the drive, ticks: a case of its end begins with a keyframe that is not the first.
const LAST: u64 = 1140;
/// The run is armed, which is the first event.
const ARMED: u64 = 180;

/// Exit code, JSON and sentence of a command on a file.
fn aeye(arguments: &[&str], file: &Path) -> (Option<i32>, Value, String) {
    let output = Command::new(AEYE).arg("--json").args(arguments).arg(file).output().expect("aeye runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), serde_json::from_slice(&output.stdout).unwrap_or_default(), said)
}

/// A drive through a network, in a file of its own.
fn drive(folder: &Path) -> PathBuf {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    let path = folder.join("drive.mcap");
    let bytes = BYTES.get_or_init(|| {
        let arguments = ["drive", "--headless", "--map", "city", "--checkpoint", "early", "--seed", "3"];
        let length = (LAST / 60).to_string();
        let (code, _, said) = aeye(&[&arguments[..], &["--max-time", &length, "--record"]].concat(), &path);
        assert_eq!(code, Some(0), "{said}");
        fs::read(&path).expect("a recording")
    });
    fs::write(&path, bytes).expect("writable");
    path
}

/// The file with its content changed.
fn changed(path: &Path, change: impl FnOnce(&mut Log)) -> PathBuf {
    let mut log = Recording::open(path).expect("a recording").into_log();
    change(&mut log);
    let path = path.with_file_name("changed.mcap");
    fs::write(&path, log.encode().expect("a log")).expect("writable");
    path
}

const DIGESTS: [&str; 2] = ["view", "--digests"];

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn every_mask_that_was_shown_is_made_again_and_one_that_is_not_is_reported() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = drive(dir.path());
    let (code, digests, said) = aeye(&DIGESTS, &path);
    let masks = Recording::open(&path).expect("a recording").into_log().masks;
    assert!(masks.len() > 100, "{}", masks.len());
    let count = |name: &str| digests[name].as_u64().expect("a number") as usize;
    assert_eq!((code, count("equal"), count("different")), (Some(0), masks.len(), 0), "{digests} {said}");
    assert_eq!((&digests["checkpoint"], &digests["first_difference"]), (&"early".into(), &Value::Null));

    let altered = changed(&path, |log| log.masks[50].digest ^= 1);
    let (code, digests, _) = aeye(&DIGESTS, &altered);
    assert_eq!((code, &digests["different"]), (Some(3), &1.into()), "{digests}");
    let first = &digests["first_difference"];
    assert_eq!(first["tick_shown"].as_u64(), Some(masks[50].tick_shown), "{digests}");
    assert_eq!(first["rebuilt"], format!("{:016x}", masks[50].digest), "{digests}");
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn a_case_is_compared_as_far_as_its_frames_are_in_it_and_an_unfinished_file_too() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = drive(dir.path());
    let recording = Recording::open(&path).expect("a recording");
    let network = recording.network().expect("bundled");
    let case = Case::cut(&recording, &network, LAST - 50..=LAST - 10).expect("a window of the recording");
    let file = dir.path().join("cut.case.mcap");
    fs::write(&file, case.encode().expect("a log")).expect("writable");
    let (code, digests, said) = aeye(&DIGESTS, &file);
    let before = case.log().masks.iter().filter(|mask| mask.tick_of_frame < case.log().first_tick()).count();
    assert!(before > 0, "its first mask is of a frame before its first tick");
    assert_eq!((code, digests["before_start"].as_u64()), (Some(0), Some(before as u64)), "{digests} {said}");

    let bytes = fs::read(&path).expect("a recording");
    fs::write(&file, &bytes[..bytes.len() * 2 / 3]).expect("writable");
    let (code, digests, said) = aeye(&DIGESTS, &file);
    assert_eq!((code, &digests["different"]), (Some(0), &0.into()), "{said}");
    assert!(digests["equal"].as_u64().is_some_and(|equal| equal > 20), "{digests}");
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn what_cannot_be_compared_is_said_in_a_sentence() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = drive(dir.path());
    let refused = |file: &Path, words: &[&str]| {
        let (code, json, said) = aeye(&DIGESTS, file);
        assert_eq!((code, json, said.lines().count()), (Some(1), Value::Null, 1), "{said}");
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    let stranger = "5".repeat(64);
    let other = |log: &mut Log| {
        log.manifest.provenance.insert("checkpoint".into(), "mine".into());
        log.manifest.provenance.insert("checkpoint_digest".into(), stranger.clone());
    };
    refused(&changed(&path, other), &["changed.mcap", "checkpoint mine", &stranger, "--checkpoint"]);
    refused(&changed(&path, |log| log.masks.clear()), &["changed.mcap", "no masks"]);
    let elsewhere = |log: &mut Log| drop(log.manifest.provenance.insert("camera".into(), "roof".into()));
    refused(&changed(&path, elsewhere), &["changed.mcap", "\"roof\"", "driver 256x128"]);

    let mut command = Command::new(AEYE);
    let output = command.arg("view").arg(&path).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output();
    let output = output.expect("aeye runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && said.contains("--digests") && said.lines().count() == 1, "{said}");
}

/// A running `aeye view` that has the keyboard.
struct Viewer<'a> {
    child: Child,
    said: Receiver<String>,
    display: &'a Display,
}

impl<'a> Viewer<'a> {
    fn open(display: &'a Display, file: &Path) -> Self {
        let mut command = Command::new(AEYE);
        command.arg("view").arg(file).env("DISPLAY", display.name()).env_remove("WAYLAND_DISPLAY");
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("aeye starts");
        let stderr = child.stderr.take().expect("piped");
        let (sender, said) = mpsc::channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stderr).lines().map_while(Result::ok) {
                let _ = sender.send(line);
            }
        });
        display.focus(&display.window("A-Eye"));
        Self { child, said, display }
    }

    fn keys(&self, keys: &[&str]) {
        self.display.keys(&[&["key"], keys].concat());
    }

    /// The file that the next line on stderr names.
    fn kept(&self, what: &str) -> PathBuf {
        let line = self.said.recv_timeout(PATIENCE).expect("it says what it kept");
        PathBuf::from(line.strip_prefix(what).unwrap_or_else(|| panic!("{what:?} expected, but {line:?}")).trim())
    }

    /// Takes a screenshot, and gives the tick and the number of colours in it.
    fn screenshot(&self) -> (u64, usize) {
        self.keys(&["s"]);
        let path = self.kept("screenshot");
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let tick = name.split('-').nth(1).and_then(|tick| tick.parse().ok());
        (tick.unwrap_or_else(|| panic!("no tick in {name:?}")), colours(&path))
    }
}

/// Number of different colours in a PNG.
fn colours(path: &Path) -> usize {
    let decoder = png::Decoder::new(BufReader::new(fs::File::open(path).expect("a file")));
    let mut reader = decoder.read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut bytes).expect("pixels");
    bytes.as_chunks::<3>().0.iter().collect::<std::collections::HashSet<_>>().len()
}

fn wait_until(mut is_so: impl FnMut() -> bool) {
    const STEP: Duration = Duration::from_millis(100);
    let steps = PATIENCE.as_millis() / STEP.as_millis();
    let waits = || std::thread::sleep(STEP);
    assert!((0..steps).any(|_| is_so() || (waits(), false).1), "waited in vain");
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn one_looks_at_a_recording_steps_jumps_plays_cuts_and_keeps_pictures() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = drive(dir.path());
    let display = Display::open(dir.path());
    let viewer = Viewer::open(&display, &path);

    let (left, right) = (([20, 140], [600, 280]), ([660, 140], [600, 280]));
    viewer.keys(&["Next"]);
    wait_until(|| display.picture().colours(right.0, right.1) > 200);
    let (tick, shades) = viewer.screenshot();
    display.keep("view");
    assert!(tick == ARMED && shades > 200, "{tick}, {shades} colours");

    viewer.keys(&["Right", "Right", "shift+Right", "Left"]);
    assert_eq!(viewer.screenshot().0, ARMED + 1 + 6);
    viewer.keys(&["i", "shift+Right", "shift+Right", "shift+Right", "o"]);
    let cut = |name: &str| {
        viewer.keys(&["c"]);
        assert_eq!(viewer.kept("corner case"), dir.path().join(name));
        let case = dir.path().join(name);
        let (code, verified, said) = aeye(&["verify"], &case);
        assert_eq!((code, &verified["ok"]), (Some(0), &true.into()), "{said}");
        let window = aeye(&["inspect"], &case).1["window"].clone();
        assert_eq!((window["from"].as_u64(), window["to"].as_u64()), (Some(187), Some(205)), "{window}");
        fs::read(case).expect("a case")
    };
    assert!(
        cut("drive-187-205.case.mcap") == cut("drive-187-205-2.case.mcap"),
        "the same cut, and nothing overwritten"
    );

    viewer.keys(&["5", "shift+6", "h"]);
    let red = || display.picture().share([255, 48, 48], left.0, left.1);
    wait_until(|| (0.005..0.5).contains(&red()));
    display.keep("view-difference");
    viewer.keys(&["v", "v", "2", "shift+3", "k"]);
    wait_until(|| red() < 0.001);
    display.keep("view-from-above");

    display.keys(&["mousemove", "645", "742", "click", "1"]);
    let (middle, _) = viewer.screenshot();
    assert!(middle.abs_diff(LAST / 2) < 20, "{middle}");
    display.keys(&["mousedown", "1"]);
    display.keys(&["mousemove", "330", "742"]);
    wait_until(|| viewer.screenshot().0.abs_diff(LAST / 4) < 20);
    display.keys(&["mouseup", "1"]);
    viewer.keys(&["Up", "Up", "Up", "space"]);
    wait_until(|| viewer.screenshot().0 == LAST);
    viewer.keys(&["q"]);
    let mut child = viewer.child;
    assert!(child.wait().expect("aeye ends").success());
}
