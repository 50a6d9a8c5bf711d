//! The live rig as people use it: real windows on a virtual display, real keys.

mod display;

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use display::Display;
use replay::Recording;

const AEYE: &str = env!("CARGO_BIN_EXE_aeye");
/// Nothing takes this long; without it a test that waits in vain would never end.
const PATIENCE: Duration = Duration::from_secs(240);

const SEMANTIC: &str = "A-Eye: semantic driver";
const SAFETY: &str = "A-Eye: safety driver";
const CENTRE: &str = "A-Eye: control centre";

/// A running `aeye drive`.
struct Rig {
    child: Child,
    said: Receiver<String>,
}

impl Rig {
    fn start(display: &Display, record: &Path, arguments: &[&str]) -> Self {
        let mut child = Command::new(AEYE)
            .args(["--json", "drive", "--map", "city", "--checkpoint", "early", "--record"])
            .arg(record)
            .args(arguments)
            .env("DISPLAY", display.name())
            .env_remove("WAYLAND_DISPLAY")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("aeye starts");
        let stderr = child.stderr.take().expect("piped");
        let (sender, said) = mpsc::channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stderr).lines().map_while(Result::ok) {
                let _ = sender.send(line);
            }
        });
        Self { child, said }
    }

    /// Waits for a line that contains the words.
    fn says(&self, words: &str) {
        let mut heard = Vec::new();
        while let Ok(line) = self.said.recv_timeout(PATIENCE) {
            if line.contains(words) {
                return;
            }
            heard.push(line);
        }
        panic!("it never said {words:?}, but {heard:?}");
    }

    fn exit(mut self) -> ExitStatus {
        self.child.wait().expect("aeye ends")
    }
}

/// Waits until a recording holds a tick.
fn wait_for_tick(path: &Path, tick: u64) {
    wait_until(|| Recording::open(path).is_ok_and(|r| r.log().last_tick() >= tick));
}

fn wait_until(mut is_so: impl FnMut() -> bool) {
    const STEP: Duration = Duration::from_millis(100);
    let steps = PATIENCE.as_millis() / STEP.as_millis();
    assert!(
        (0..steps).any(|_| is_so() || {
            std::thread::sleep(STEP);
            false
        }),
        "waited in vain"
    );
}

/// What a command prints, which must succeed.
fn aeye(arguments: &[&str], file: &Path) -> serde_json::Value {
    let output = Command::new(AEYE).arg("--json").args(arguments).arg(file).output().expect("aeye runs");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn two_people_drive_intervene_label_and_go_on() {
    let dir = tempfile::tempdir().expect("a folder");
    let display = Display::open(dir.path());
    let record = dir.path().join("drive.mcap");
    let rig = Rig::start(&display, &record, &["--semantic", "keyboard", "--safety", "keyboard", "--seed", "3"]);

    rig.says("run 1 is ready");
    let [semantic, safety, centre] = [SEMANTIC, SAFETY, CENTRE].map(|title| display.window(title));
    display.focus(&semantic);
    display.keys(&["key", "n"]);
    display.keys(&["keydown", "w"]);
    wait_for_tick(&record, 60);
    display.keys(&["keyup", "w"]);
    wait_for_tick(&record, 240);
    display.keep("drive");
    check_pictures(&display);
    display.focus(&safety);
    display.keys(&["keydown", "Down"]);
    rig.says("run 1 has ended");
    display.keys(&["keyup", "Down"]);
    display.focus(&centre);
    display.keys(&["key", "1"]);
    display.keys(&["type", "--delay", "50", "seen too late"]);
    display.keep("label");
    display.keys(&["key", "Return"]);

    rig.says("run 2 is ready");
    let case = dir.path().join("drive.case.mcap");
    wait_until(|| case.exists());
    display.keys(&["key", "n"]);
    let second = dir.path().join("drive-2.mcap");
    wait_for_tick(&second, 60);
    display.keys(&["key", "Escape"]);
    assert!(rig.exit().success());

    for file in [&record, &second, &case] {
        let verified = aeye(&["verify"], file);
        assert_eq!(verified["ok"], true, "{verified}");
    }
    let contents = aeye(&["inspect"], &record);
    assert_eq!((&contents["label"], &contents["comment"]), (&"walker".into(), &"seen too late".into()), "{contents}");
    assert_eq!((&contents["outcome"], &contents["intervention"]["by_brake"]), (&"intervened".into(), &true.into()));
    assert!(contents["km"].as_f64().expect("a number") > 0.001, "the car has moved: {contents}");
    check_masks(&record);
    assert_eq!(aeye(&["inspect"], &case)["comment"], "seen too late");
    assert_eq!(aeye(&["inspect"], &second)["outcome"], "stopped");
}

/// The semantic driver sees class colours and nothing else of the world, the safety driver the image.
fn check_pictures(display: &Display) {
    let picture = display.picture();
    let road = [128, 64, 128];
    let share = |[x, y]: [usize; 2]| picture.share(road, [x, y], [600, 160]);
    assert!(share([20, 180]) > 0.2, "the semantic driver sees a road: {}", share([20, 180]));
    assert!(share([670, 180]) < 0.01, "the safety driver sees no mask: {}", share([670, 180]));
    assert!(picture.colours([670, 100], [600, 200]) > 200, "the safety driver sees an image");
}

/// Masks were shown, in order, each after its frame.
fn check_masks(record: &Path) {
    let recording = Recording::open(record).expect("a recording");
    let masks = &recording.log().masks;
    assert!(masks.len() > 3, "{}", masks.len());
    assert!(masks.is_sorted_by_key(|m| m.tick_shown));
    for mask in masks {
        let times = mask.times.expect("live drives hold times");
        assert!(mask.tick_of_frame < mask.tick_shown, "{mask:?}");
        assert!(times.capture_us < times.inference_us && times.inference_us < times.present_us, "{mask:?}");
    }
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn a_terminated_drive_of_bots_leaves_a_whole_recording() {
    let dir = tempfile::tempdir().expect("a folder");
    let display = Display::open(dir.path());
    let record = dir.path().join("bots.mcap");
    let rig = Rig::start(&display, &record, &["--semantic", "bot", "--safety", "bot"]);
    rig.says("run 1 is ready");
    display.focus(&display.window(CENTRE));
    display.keys(&["key", "n"]);
    wait_for_tick(&record, 120);
    let pid = rig.child.id().to_string();
    assert!(Command::new("kill").args(["-TERM", &pid]).status().expect("kill runs").success());
    rig.says("ended by Ctrl-C or SIGTERM");
    assert!(rig.exit().success());
    let contents = aeye(&["inspect"], &record);
    assert_eq!((&contents["finished"], &contents["outcome"]), (&true.into(), &"stopped".into()));
    assert_eq!(contents["provenance"]["semantic"], "bot");
    assert_eq!(aeye(&["verify"], &record)["ok"], true);
}

#[test]
fn without_a_display_it_says_what_to_do() {
    let dir = tempfile::tempdir().expect("a folder");
    let record = dir.path().join("drive.mcap");
    let mut command = Command::new(AEYE);
    command.args(["drive", "--record"]).arg(&record).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    let output = command.output().expect("aeye runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("--headless") && said.lines().count() == 1, "{said}");
    assert!(!record.exists());
}
