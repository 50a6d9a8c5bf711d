//! The program in a folder, until it ends or is killed.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, ExitStatus};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::common::aeye;
use crate::contents::names;

/// When a process is killed.
#[derive(Clone, Copy, Debug)]
pub struct Aim {
    /// Not before this time has passed.
    pub after: Duration,
    /// Only when a file or folder has appeared or gone since then.
    pub at_change: bool,
}

/// A start of the program that is over.
pub struct Start {
    /// Whether it was killed; it went well otherwise.
    pub was_killed: bool,
    /// What it said on stdout ...
    pub out: String,
    /// ... and on stderr.
    pub said: String,
    /// How long it took.
    pub took: Duration,
}

/// Between two looks at a process.
const LOOK: Duration = Duration::from_micros(500);

/// Starts the program in `ROOT/FOLDER`, and kills it unless it ends before. What it says goes to files below `ROOT`, and
/// so does what it has for itself alone.
pub fn start(root: &Path, folder: &str, arguments: &str, aim: Option<Aim>) -> Start {
    let (place, [out, said]) = (root.join(folder), ["out", "said"].map(|name| root.join(name)));
    let file = |path: &Path| File::create(path).expect("writable");
    let mut command = aeye(&place, arguments);
    command.env("TMPDIR", root.join("tmp")).stdout(file(&out)).stderr(file(&said));
    let began = Instant::now();
    let mut child = command.spawn().expect("the program starts");
    let ended = match aim {
        Some(aim) => at(&mut child, &place, aim),
        None => Some(child.wait().expect("it ends")),
    };
    let status = ended.unwrap_or_else(|| {
        child.kill().expect("it can be killed");
        child.wait().expect("it ends")
    });
    let read = |path: &Path| fs::read_to_string(path).expect("UTF-8");
    let start =
        Start { was_killed: status.code().is_none(), out: read(&out), said: read(&said), took: began.elapsed() };
    assert!(start.was_killed || status.success(), "aeye {arguments}: {status}: {}", start.said);
    start
}

/// Waits for the moment of a kill; the status of a process that ended before.
fn at(child: &mut Child, place: &Path, aim: Aim) -> Option<ExitStatus> {
    let began = Instant::now();
    let mut ended = || child.try_wait().expect("a child");
    while began.elapsed() < aim.after {
        let status = ended();
        if status.is_some() {
            return status;
        }
        sleep(LOOK.min(aim.after.saturating_sub(began.elapsed())));
    }
    let before = names(place);
    while aim.at_change && names(place) == before {
        let status = ended();
        if status.is_some() {
            return status;
        }
        sleep(LOOK / 5);
    }
    None
}
