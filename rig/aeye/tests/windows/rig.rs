//! `aeye drive` in windows.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use replay::Recording;

use crate::display::Display;

/// The program.
pub const AEYE: &str = env!("CARGO_BIN_EXE_aeye");
/// Nothing takes this long; without it a test that waits in vain would never end.
const PATIENCE: Duration = Duration::from_secs(240);

/// Titles of the windows.
pub const SEMANTIC: &str = "A-Eye: semantic driver";
pub const SAFETY: &str = "A-Eye: safety driver";
pub const CENTRE: &str = "A-Eye: control centre";

/// A running `aeye drive`.
pub struct Rig {
    pub child: Child,
    said: Receiver<String>,
}

impl Rig {
    /// Starts it on a display, which also keeps what it remembers.
    pub fn start(display: &Display, record: &Path, arguments: &[&str]) -> Self {
        Self::start_with(display, &[], record, arguments)
    }

    /// The same behind another program, which runs it.
    pub fn start_with(display: &Display, wrapper: &[&str], record: &Path, arguments: &[&str]) -> Self {
        let drive = ["drive", "--map", "city", "--checkpoint", "early", "--record"];
        let record = record.to_str().expect("a plain path");
        let arguments: Vec<&str> = drive.into_iter().chain([record]).chain(arguments.iter().copied()).collect();
        Self::run(display, wrapper, &arguments)
    }

    /// Starts what a plan has, or goes on with it, at keyboards.
    pub fn planned(display: &Display, plan: &Path, record: &Path) -> Self {
        let [plan, record] = [plan, record].map(|path| path.to_str().expect("a plain path"));
        let keyboards = ["--semantic", "keyboard", "--safety", "keyboard"];
        Self::run(display, &[], &[&["drive", "--plan", plan, "--record", record], &keyboards[..]].concat())
    }

    fn run(display: &Display, wrapper: &[&str], arguments: &[&str]) -> Self {
        let program: Vec<&str> = wrapper.iter().copied().chain([AEYE]).collect();
        let mut child = Command::new(program[0])
            .args(&program[1..])
            .arg("--json")
            .args(arguments)
            .env("DISPLAY", display.name())
            .env("XDG_CONFIG_HOME", display.folder())
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

    /// Waits for a line that contains the words; gives the lines before it.
    pub fn says(&self, words: &str) -> Vec<String> {
        let mut heard = Vec::new();
        while let Ok(line) = self.said.recv_timeout(PATIENCE) {
            if line.contains(words) {
                return heard;
            }
            heard.push(line);
        }
        panic!("it never said {words:?}, but {heard:?}");
    }

    /// Waits for its end.
    pub fn exit(mut self) -> ExitStatus {
        self.child.wait().expect("aeye ends")
    }
}

/// Waits until a recording holds a tick.
pub fn wait_for_tick(path: &Path, tick: u64) {
    wait_until(|| Recording::open(path).is_ok_and(|r| r.log().last_tick() >= tick));
}

/// Waits until something is so.
pub fn wait_until(mut is_so: impl FnMut() -> bool) {
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
pub fn aeye(arguments: &[&str], file: &Path) -> serde_json::Value {
    let output = Command::new(AEYE).arg("--json").args(arguments).arg(file).output().expect("aeye runs");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}
