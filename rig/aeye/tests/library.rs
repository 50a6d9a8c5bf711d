//! The index of a library of cases: what people said stays, what cannot be read is named, and neither a second process nor a
//! killed one harms it.
#![cfg(unix)]

mod common;
#[path = "kills/cases.rs"]
mod one;

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::Duration;

use common::{aeye, run};
use serde_json::Value;

/// What the program prints of each case, and of all.
fn cases(folder: &Path, arguments: &str) -> (Option<i32>, Vec<Value>, String) {
    let (code, said, errors) = run(&mut aeye(folder, &format!("--json cases {arguments}")));
    (code, said.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect(), errors)
}

/// Names of the cases that are found.
fn files(folder: &Path, arguments: &str) -> Vec<String> {
    let (code, lines, errors) = cases(folder, arguments);
    assert_eq!(code, Some(0), "{errors}");
    let (_, lines) = lines.split_last().expect("a last line");
    lines.iter().map(|line| line["file"].as_str().expect("a file").to_owned()).collect()
}

#[test]
fn reviews_and_tags_stay_when_a_file_is_moved_copied_or_away_for_a_while() {
    let dir = tempfile::tempdir().expect("a folder");
    let at = |name: &str| dir.path().join(name);
    fs::create_dir_all(at("runs/below")).expect("a folder");
    one::case(&at("runs/a.case.mcap"), 1);
    one::case(&at("runs/b.case.mcap"), 2);
    assert_eq!(files(dir.path(), "runs --label walker --reviewed no"), ["runs/a.case.mcap", "runs/b.case.mcap"]);
    files(dir.path(), "runs runs/b.case.mcap --set-review rejected --add-tag odd,night");
    fs::rename(at("runs/b.case.mcap"), at("runs/below/c.case.mcap")).expect("moved");
    assert_eq!(files(dir.path(), "runs/below --index runs/cases.sqlite --tag odd"), ["runs/below/c.case.mcap"]);
    assert_eq!(files(dir.path(), "runs --reviewed rejected"), ["runs/below/c.case.mcap"]);
    fs::copy(at("runs/below/c.case.mcap"), at("runs/0.case.mcap")).expect("copied");
    assert_eq!(files(dir.path(), "runs --tag night"), ["runs/0.case.mcap"], "a case counts once");
    fs::rename(at("runs"), at("elsewhere")).expect("moved");
    fs::remove_file(at("elsewhere/0.case.mcap")).expect("there");
    fs::rename(at("elsewhere/below"), at("away")).expect("moved");
    assert_eq!(files(dir.path(), "elsewhere"), ["elsewhere/a.case.mcap"]);
    fs::rename(at("away"), at("elsewhere/below")).expect("moved");
    assert_eq!(files(dir.path(), "elsewhere --tag odd --remove-tag odd"), ["elsewhere/below/c.case.mcap"]);
    assert!(files(dir.path(), "elsewhere --tag odd").is_empty());
    let (code, _, errors) = cases(dir.path(), "elsewhere --set-review accepted");
    assert_eq!(code, Some(2), "a review of every case: {errors}");
}

#[test]
fn what_cannot_be_read_is_named_each_time_and_a_damaged_index_is_refused() {
    let dir = tempfile::tempdir().expect("a folder");
    let at = |name: &str| dir.path().join(name);
    one::case(&at("a.case.mcap"), 1);
    let whole = fs::read(at("a.case.mcap")).expect("readable");
    fs::write(at("b.case.mcap"), &whole[..1000]).expect("writable");
    for _ in 0..2 {
        let (code, lines, errors) = cases(dir.path(), ".");
        assert!(
            code == Some(1) && errors.contains("b.case.mcap: damaged") && errors.contains("1 of 2 files"),
            "{errors}"
        );
        assert_eq!(lines.len(), 2, "the other one and the end");
    }
    fs::remove_file(at("b.case.mcap")).expect("there");
    assert_eq!(files(dir.path(), ".").len(), 1);
    let index = fs::read(at("cases.sqlite")).expect("readable");
    fs::write(at("cases.sqlite"), &index[..index.len() / 2]).expect("writable");
    let (code, _, errors) = cases(dir.path(), ".");
    assert!(code == Some(1) && errors.contains("cases.sqlite: is damaged"), "{errors}");
    assert_eq!(fs::read(at("cases.sqlite")).expect("readable"), index[..index.len() / 2]);
    fs::remove_file(at("cases.sqlite")).expect("there");
    assert_eq!(files(dir.path(), ". --count").len(), 0);
    assert_eq!(files(dir.path(), ". --no-scan").len(), 1);
}

#[test]
fn several_processes_at_once_and_killed_ones_leave_the_index_that_one_makes() {
    let dir = tempfile::tempdir().expect("a folder");
    one::case(&dir.path().join("0.case.mcap"), 1);
    for number in 1..60 {
        fs::copy(dir.path().join("0.case.mcap"), dir.path().join(format!("{number}.case.mcap"))).expect("copied");
    }
    one::case(&dir.path().join("last.case.mcap"), 2);
    let undisturbed = files(dir.path(), ". --index alone");
    assert_eq!(undisturbed, ["./0.case.mcap", "./last.case.mcap"]);
    let start = || -> Child {
        let mut command = aeye(dir.path(), "--json cases . --index shared --label walker --add-tag seen");
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts")
    };
    for wait_ms in [0, 2, 5, 10, 20, 40] {
        let mut killed = start();
        sleep(Duration::from_millis(wait_ms));
        killed.kill().expect("killed");
        killed.wait().expect("gone");
    }
    let together: Vec<Child> = (0..4).map(|_| start()).collect();
    for mut child in together {
        assert!(child.wait().expect("an end").success());
    }
    assert_eq!(files(dir.path(), ". --index shared --tag seen"), undisturbed);
    let (_, lines, _) = cases(dir.path(), ". --index shared");
    assert_eq!(lines.last().expect("the end")["kept"], 61, "nothing is read again");
}

#[test]
fn other_commands_take_what_is_found() {
    let dir = tempfile::tempdir().expect("a folder");
    one::case(&dir.path().join("a b.case.mcap"), 1);
    one::case(&dir.path().join("c.case.mcap"), 2);
    for end in ["", " --null"] {
        let (code, list, errors) = run(&mut aeye(dir.path(), &format!("cases . --paths{end}")));
        assert_eq!(code, Some(0), "{errors}");
        fs::write(dir.path().join("list"), list).expect("writable");
        let (code, said, errors) = run(&mut aeye(dir.path(), "--json verify @list"));
        assert_eq!((code, said.lines().count()), (Some(0), 2), "{errors}");
        let stdin = fs::File::open(dir.path().join("list")).expect("readable");
        let (code, again, errors) = run(aeye(dir.path(), "--json verify @-").stdin(stdin));
        assert_eq!((code, again.lines().count()), (Some(0), 2), "{errors}");
    }
    let (code, _, errors) = run(&mut aeye(dir.path(), "verify @gone"));
    assert!(code == Some(1) && errors.contains("gone"), "{errors}");
}
