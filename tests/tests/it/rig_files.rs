//! What every command over many cases makes of them: bad ones among good ones, ones of the same name, and names that
//! would come in the way of results.

use std::fs;
use std::path::{Path, PathBuf};

use base::failure::sentence;
use base::progress::Interrupt;
use drivers::film::Viewpoint;
use lab::export;
use render::Imaging;
use replay::Recording;
use tests::command::aeye;
use tests::files::contents;
use tests::recordings::recorded_in;
use tests::scenes::{busy_city, country_road};

/// The commands that make something of each case, with small pictures, and where it goes.
const COMMANDS: [(&str, &str); 5] = [
    ("rerender --checkpoint truth --size 64x32 --last 0.2s", "pictures"),
    ("compare --checkpoint truth,early --size 64x32", "compared"),
    ("export --size 16x8 --last 0.2s", "exports"),
    ("report --checkpoint truth --size 64x32", "page.html"),
    ("redrive --without-intervention --after 1s", "forks"),
];

/// A case of a scene, said to be driven with true masks.
fn case(scene: &tests::scenes::Scene, folder: &Path, name: &str) -> PathBuf {
    fs::create_dir_all(folder).unwrap();
    let (recording, path) = recorded_in(scene, folder, name);
    fs::remove_file(recording).unwrap();
    let mut log = Recording::open(&path).unwrap().into_log();
    log.manifest.provenance.insert("checkpoint_digest".into(), "truth".into());
    fs::write(&path, log.encode().unwrap()).unwrap();
    path
}

/// Whether something was made under a name.
fn has(out: &Path, name: &str) -> bool {
    if out.is_file() {
        let id = name.trim_end_matches(".case").replace('/', "&#x2f;");
        return fs::read_to_string(out).unwrap().contains(&format!("id=\"{id}\""));
    }
    let fork = format!("{}.fork", name.trim_end_matches(".case"));
    contents(out).keys().any(|path| {
        let path = path.to_str().unwrap();
        [name, &fork].iter().any(|name| path.contains(&format!("{name}/")) || path.contains(&format!("{name}.")))
    })
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_bad_file_is_told_and_the_rest_goes_on() {
    let dir = tempfile::tempdir().unwrap();
    let good = case(&busy_city(), dir.path(), "good");
    let (bad, copy) = (dir.path().join("bad.case.mcap"), dir.path().join("good-again.case.mcap"));
    let mut bytes = fs::read(&good).unwrap();
    fs::write(&copy, &bytes).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&bad, bytes).unwrap();
    for (command, out) in COMMANDS {
        let out = dir.path().join(out);
        let (code, said) = aeye(command, &[&bad, &good, &copy], &out);
        assert_eq!((code, said.as_str()), (1, "2 of 3 files failed"), "{command}");
        assert!(has(&out, "good.case") && !has(&out, "bad.case") && !has(&out, "good-again.case"), "{command}");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn cases_of_the_same_name_are_told_apart() {
    let dir = tempfile::tempdir().unwrap();
    let (one, two) = (dir.path().join("1"), dir.path().join("2"));
    let cases = [case(&busy_city(), &one, "x"), case(&country_road(), &two, "x")];
    for (command, out) in COMMANDS {
        let out = dir.path().join(out);
        let (code, said) = aeye(command, &[&cases[0], &cases[1]], &out);
        assert_eq!(code, 0, "{command}: {said}");
        assert!(has(&out, "1/x.case") && has(&out, "2/x.case"), "{command}: {:?}", out);
    }
    // Alone, the second would be filed where another one is, of the folder that was given alone.
    for (command, out) in [COMMANDS[0], COMMANDS[4]] {
        let out = dir.path().join("alone").join(out);
        assert_eq!(aeye(command, &[&one], &out).0, 0, "{command}");
        let before = contents(&out).len();
        let (code, said) = aeye(command, &[&two], &out);
        assert!(code == 1 && said.contains("holds results of another file as x.case"), "{command}: {said}");
        assert!(has(&out, "x.case") && contents(&out).len() == before - 1, "{command}: but for the table");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_case_named_as_the_table_of_all_or_hidden_is_told_and_the_rest_goes_on() {
    let dir = tempfile::tempdir().unwrap();
    let cases = dir.path().join("cases");
    let (good, other) = (case(&busy_city(), &cases, "good"), case(&country_road(), &cases, "other"));
    let (odd, hidden) = (cases.join("metrics.jsonl.mcap"), cases.join(".odd/good.case.mcap"));
    fs::create_dir(cases.join(".odd")).unwrap();
    fs::copy(&other, &hidden).unwrap();
    fs::rename(other, &odd).unwrap();
    let (command, out, beside) = (COMMANDS[0].0, dir.path().join("out"), dir.path().join("beside"));
    for _ in 0..2 {
        let (code, said) = aeye(command, &[&good, &odd], &out);
        assert_eq!((code, said.as_str()), (1, "1 of 2 files failed"));
        assert!(out.join("metrics.jsonl").is_file() && has(&out, "good.case"));
    }
    // Two of one name have their folders before them, of which one is hidden.
    let (code, said) = aeye(command, &[&good, &hidden], &beside);
    assert_eq!((code, said.as_str()), (1, "1 of 2 files failed"));
    assert!(has(&beside, "cases/good.case") && !beside.join(".odd").exists());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn an_export_that_is_interrupted_leaves_no_empty_folder() {
    let dir = tempfile::tempdir().unwrap();
    let cases = dir.path().join("cases");
    case(&busy_city(), &cases.join("below"), "a");
    let out = dir.path().join("new/out");
    let options = export::Options {
        cameras: None,
        files: vec![cases],
        format: export::Format::Mcap,
        camera: Viewpoint::Driver,
        checkpoint: vec![],
        last: None,
        from: None,
        to: None,
        fps: 10,
        size: Some((16, 8)),
        imaging: Imaging::default(),
        jobs: None,
        out: out.clone(),
    };
    let interrupt = Interrupt::default();
    interrupt.raise();
    let said = sentence(&export::export(&options, &interrupt).expect_err("interrupted"));
    assert!(said.contains("interrupted; nothing of its export is kept"), "{said}");
    assert!(!dir.path().join("new").exists());
}
