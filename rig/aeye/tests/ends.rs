//! However the program is ended, and whoever listens to it: what it says, its exit code, and what is kept.
#![cfg(unix)]

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use replay::Recording;

/// A command that waits for what is written to a pipe, and the end to write to, once it does wait.
fn waiting(folder: &Path, arguments: &str, pipe: &str) -> (Child, File) {
    let path = folder.join(pipe);
    let made = Command::new("mkfifo").arg(&path).status().expect("mkfifo runs");
    assert!(made.success());
    let child = start(folder, arguments);
    // Opens when the other end does.
    (child, File::options().write(true).open(path).expect("a pipe"))
}

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
        let (mut child, _pipe) = waiting(dir.path(), "questionnaire run.mcap --answers answers.toml", "answers.toml");
        let mut said = BufReader::new(child.stderr.take().expect("piped"));
        send(signal, &child);
        hear(&mut said, "interrupted");
        assert_eq!(child.wait().expect("it ends").code(), Some(code));
    }
}

#[test]
fn a_second_signal_ends_at_once_what_the_first_asks_to_end() {
    let dir = tempfile::tempdir().expect("a folder");
    let campaign = "campaign --checkpoint truth --runs 1 --scenario start.toml --out runs";
    let (mut child, pipe) = waiting(dir.path(), campaign, "start.toml");
    let mut said = BufReader::new(child.stderr.take().expect("piped"));
    send("INT", &child);
    hear(&mut said, "interrupted");
    assert!(child.try_wait().expect("a child").is_none(), "it is asked to end, and waits for its scenario");
    send("INT", &child);
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    drop(pipe);
    assert!(!dir.path().join("runs").exists());
}

#[test]
fn who_starts_the_program_may_have_it_ignore_signals() {
    let dir = tempfile::tempdir().expect("a folder");
    let pipe = dir.path().join("answers.toml");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let ignoring = "trap '' HUP; exec \"$0\" questionnaire run.mcap --answers answers.toml";
    let mut command = Command::new("sh");
    command.current_dir(dir.path()).args(["-c", ignoring, env!("CARGO_BIN_EXE_aeye")]).stderr(Stdio::piped());
    let child = command.spawn().expect("a shell");
    let answers = File::options().write(true).open(pipe).expect("a pipe");
    send("HUP", &child);
    drop(answers);
    let ended = child.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert!(ended.status.code() == Some(1) && said.starts_with("error: run.mcap: "), "{said}");
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
