//! However the program is ended, and whoever listens to it: what it says, its exit code, and what is kept.
#![cfg(unix)]

mod common;

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::Duration;

use common::{aeye, blind_drive};
use replay::Recording;

/// A command that says more than a pipe holds, which nobody reads on.
fn unheard(folder: &Path, command: &mut Command) -> (Child, ChildStdout) {
    (0..60).for_each(|seed| blind_drive(&folder.join(format!("run-{seed}.mcap")), seed));
    let mut child =
        command.current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    let mut out = child.stdout.take().expect("piped");
    out.read_exact(&mut [0]).expect("it begins");
    (child, out)
}

const INSPECT: &str = "inspect . --json --jobs 1";

fn start(folder: &Path, arguments: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_aeye"));
    command.current_dir(folder).args(arguments.split_whitespace());
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts")
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
}

/// Reads stderr up to a line that begins so.
fn hear(said: &mut impl BufRead, begins: &str) {
    assert!(said.lines().map(|line| line.expect("a line")).any(|line| line.starts_with(begins)), "{begins} never came");
}

#[test]
fn what_nobody_can_go_on_with_ends_at_once_with_the_signal_in_its_exit_code() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let dir = tempfile::tempdir().expect("a folder");
        let (mut child, _out) = unheard(dir.path(), &mut aeye(dir.path(), INSPECT));
        let mut said = BufReader::new(child.stderr.take().expect("piped"));
        send(signal, &child);
        hear(&mut said, "interrupted");
        assert_eq!(child.wait().expect("it ends").code(), Some(code));
    }
}

#[test]
fn two_signals_end_a_campaign_that_has_hours_to_go() {
    let dir = tempfile::tempdir().expect("a folder");
    let mut child = start(dir.path(), "campaign --checkpoint truth --runs 1 --max-time 24h --out runs");
    while !dir.path().join("runs").exists() {
        assert!(child.try_wait().expect("a child").is_none(), "it drives");
        std::thread::sleep(Duration::from_millis(20));
    }
    ["STOP", "INT", "TERM", "CONT"].iter().for_each(|signal| send(signal, &child));
    let code = child.wait().expect("it ends").code();
    assert!(matches!(code, Some(130 | 143)), "{code:?}");
    assert!(!dir.path().join("runs/campaign.json").exists());
}

#[test]
fn who_starts_the_program_may_have_it_ignore_signals() {
    let dir = tempfile::tempdir().expect("a folder");
    let ignoring = format!("trap '' HUP; exec \"$0\" {INSPECT}");
    let (mut child, mut out) =
        unheard(dir.path(), Command::new("sh").args(["-c", &ignoring, env!("CARGO_BIN_EXE_aeye")]));
    send("HUP", &child);
    let mut rest = String::new();
    out.read_to_string(&mut rest).expect("it goes on");
    assert_eq!((rest.lines().count(), child.wait().expect("it ends").code()), (61, Some(0)));
}

const DRIVE: &str = "drive --headless --map rural --max-time";

#[test]
fn an_interrupted_drive_keeps_its_recording() {
    let dir = tempfile::tempdir().expect("a folder");
    let mut child = start(dir.path(), &format!("{DRIVE} 24h --record run.mcap"));
    let mut said = BufReader::new(child.stderr.take().expect("piped"));
    hear(&mut said, "tick ");
    send("INT", &child);
    hear(&mut said, "interrupted");
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    assert!(Recording::open(&dir.path().join("run.mcap")).expect("readable").finished());
}

#[test]
fn a_drive_whose_stderr_is_closed_or_full_goes_on() {
    for (number, stderr) in ["2>&-", "2>/dev/full"].into_iter().enumerate() {
        if stderr.ends_with("full") && !Path::new("/dev/full").exists() {
            continue;
        }
        let dir = tempfile::tempdir().expect("a folder");
        let drive = format!("exec \"$0\" {DRIVE} 4s --record run-{number}.mcap {stderr}");
        let mut command = Command::new("sh");
        command.current_dir(dir.path()).args(["-c", &drive, env!("CARGO_BIN_EXE_aeye")]).stdout(Stdio::null());
        assert_eq!(command.status().expect("a shell").code(), Some(0), "{stderr}");
        assert!(Recording::open(&dir.path().join(format!("run-{number}.mcap"))).expect("readable").finished());
    }
}

#[test]
fn names_of_files_do_not_steer_the_terminal() {
    let dir = tempfile::tempdir().expect("a folder");
    let name = "a\u{1b}[2J\nb.mcap";
    fs::write(dir.path().join(name), "noise").expect("writable");
    for arguments in [&["verify", name][..], &["inspect", "."], &["verify", "."], &["drive", "--map", name], &[name]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_aeye"));
        let said = command.current_dir(dir.path()).args(arguments).output().expect("the program starts");
        for text in [said.stdout, said.stderr] {
            assert!(!text.contains(&0x1b), "{arguments:?}: {}", String::from_utf8_lossy(&text));
        }
        assert_ne!(said.status.code(), Some(0));
    }
}
