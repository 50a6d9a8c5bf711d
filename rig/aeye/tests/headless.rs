//! The program built without windows: what it refuses, and in which words.
#![cfg(not(feature = "live"))]

use std::process::Command;

/// Exit code, and what was said on stdout and stderr.
fn aeye(arguments: &str) -> (Option<i32>, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_aeye"));
    let output = command.args(arguments.split_whitespace()).output().expect("the program starts");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn what_needs_windows_is_refused_in_one_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let record = folder.path().join("run.mcap");
    for command in [format!("drive --record {}", record.display()), "wheel list".into()] {
        let (code, out, said) = aeye(&command);
        assert_eq!((code, out.as_str()), (Some(2), ""), "{command}: {said}");
        assert!(said.contains("has no windows") && said.contains("--headless"), "{command}: {said}");
        assert_eq!(said.lines().count(), 1, "{command}: {said}");
    }
    assert!(!record.exists());
}

#[test]
fn help_names_no_command_that_cannot_work() {
    let (code, help, _) = aeye("--help");
    assert_eq!(code, Some(0));
    assert!(help.contains("campaign") && !help.contains("wheel"), "{help}");
}

#[cfg(not(feature = "cuda"))]
#[test]
fn a_network_cannot_be_computed_by_what_was_not_built_in() {
    let (code, out, _) = aeye("doctor --json --seconds 0");
    let found: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    let notes = found["notes"].to_string();
    assert!(code != Some(0) || notes.contains("built without it (the feature cuda)"), "{out}");
}
