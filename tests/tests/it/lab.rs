//! The offline lab: the same inputs give the same bytes, and what fails leaves nothing behind.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use replay::{Annotation, Case, Label, Recording};
use rig::cli::{CasesArgs, CheckpointChoice, EvalArgs, NaturalArgs, RerenderArgs};
use rig::exit::Verdict;
use rig::lab::{cases, eval, natural, report, rerender};
use rig::progress::Interrupt;
use tests::recordings::{TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::{Scene, busy_city};

/// A recording of the city whose safety driver brakes, and the case cut from it.
fn recorded(folder: &Path) -> (PathBuf, PathBuf) {
    recorded_in(&busy_city(), folder, "a")
}

/// The same in any scene, as `NAME.mcap` and `NAME.case.mcap`.
pub fn recorded_in(scene: &Scene, folder: &Path, name: &str) -> (PathBuf, PathBuf) {
    let mut log = Recording::from_bytes(&record(scene, TAKEOVER + 60, WITH_TAKEOVER)).unwrap().into_log();
    let comment = "a <test>".into();
    log.annotation = Some(Annotation { label: Label::Rules, comment, perception_caused: None });
    let (path, case_path) = (folder.join(format!("{name}.mcap")), folder.join(format!("{name}.case.mcap")));
    fs::write(&path, log.encode().unwrap()).unwrap();
    let recording = Recording::open(&path).unwrap();
    let window = Case::window(recording.log()).expect("an intervention");
    fs::write(&case_path, Case::cut(&recording, &scene.network, window).unwrap().encode().unwrap()).unwrap();
    (path, case_path)
}

/// Every file below a folder with its bytes.
pub fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
            }
        }
    }
    files
}

fn rerender_args(file: &Path, out: PathBuf) -> RerenderArgs {
    let checkpoint = vec![CheckpointChoice::Truth];
    RerenderArgs { files: vec![file.to_owned()], checkpoint, last: 180, fps: 10, size: (128, 64), jobs: None, out }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_case_and_its_recording_render_to_the_same_bytes_every_time() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, case) = recorded(dir.path());
    let out = |name: &str, file: &Path| {
        let out = dir.path().join(name);
        assert_eq!(rerender::run(&rerender_args(file, out.clone()), true).unwrap(), Verdict::Ok);
        contents(&out)
    };
    let first = out("first", &case);
    assert_eq!(first, out("second", &case));
    let count = |part: &str| first.keys().filter(|path| path.starts_with(Path::new("a.case").join(part))).count();
    assert_eq!((count("rgb"), count("labels"), count("predictions/truth")), (30, 30, 30));
    let metrics = String::from_utf8(first[Path::new("metrics.jsonl")].clone()).unwrap();
    assert_eq!(metrics.lines().count(), 32);
    let last: serde_json::Value = serde_json::from_str(metrics.lines().last().unwrap()).unwrap();
    assert_eq!((last["over"].as_str(), last["miou"].as_f64()), (Some("overall"), Some(1.0)));
    let whole = out("whole", &recording);
    for (path, bytes) in first.iter().filter(|(path, _)| path.starts_with("a.case")) {
        let same = Path::new("a").join(path.strip_prefix("a.case").unwrap());
        assert!(whole[&same] == *bytes, "{}", same.display());
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_divergent_or_damaged_recording_leaves_no_pictures() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, _) = recorded(dir.path());
    let mut log = Recording::open(&recording).unwrap().into_log();
    log.inputs[TAKEOVER as usize - 60].semantic.steer ^= 1;
    let forged = dir.path().join("forged.mcap");
    fs::write(&forged, log.encode().unwrap()).unwrap();
    let out = dir.path().join("out");
    assert_eq!(rerender::run(&rerender_args(&forged, out.clone()), true).unwrap(), Verdict::CheckFailed);
    let mut bytes = fs::read(&recording).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&forged, bytes).unwrap();
    let error = rerender::run(&rerender_args(&forged, out.clone()), true).unwrap_err();
    assert!(format!("{error:#}").contains("forged.mcap"), "{error:#}");
    assert!(!out.exists());
    let left = fs::read_dir(dir.path()).unwrap().count();
    assert_eq!(left, 3, "the two recordings and the case, and nothing half-written");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_report_stands_alone_and_escapes_what_people_wrote() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let html = report::render(&[case], &[CheckpointChoice::Truth], (64, 32)).unwrap();
    assert_eq!(html.matches("data:image/png;base64,").count(), 90);
    assert!(html.contains("a &lt;test&gt;") && !html.contains("<test>"));
    assert!(html.contains("<svg") && html.contains("<circle") && html.contains("15.8 s"));
    let columns = |class: &str| html.matches(&format!("<div class=\"{class}\">")).count();
    assert_eq!((columns("time "), columns("time more")), (6, 24), "one in five frames is always on the page");
    let outside = ["src=\"http", "href=\"http", "src=\"/", "@import", "url("];
    assert!(outside.iter().all(|link| !html.contains(link)));
}

fn natural_args(out: PathBuf, jobs: u16) -> NaturalArgs {
    NaturalArgs {
        scenes: 2,
        val_scenes: 1,
        frames: 2,
        size: (64, 32),
        maps: vec!["rural".into(), "city".into()],
        pedestrians: Some(20),
        seed: 5,
        jobs: Some(jobs),
        out,
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_dataset_is_the_same_in_parallel_and_when_it_was_interrupted() {
    let dir = tempfile::tempdir().unwrap();
    let interrupt = Interrupt::default();
    let (a, b) = (dir.path().join("a"), dir.path().join("b"));
    let made = natural::make(&natural_args(a.clone(), 1), &interrupt).unwrap();
    assert_eq!((made.train_frames, made.val_frames), (4, 2));
    let whole = contents(&a);
    assert_eq!(whole.len(), 6 * 5 + 2, "five files a frame, the frames' list, the manifest");

    // What an interrupted run leaves: the recipe, one finished scene, no manifest.
    let line = |text: &str| text.lines().filter(|l| l.contains("\"train\"") && l.contains("\"scene\":0,")).count();
    let lines = String::from_utf8(whole[Path::new("frames.jsonl")].clone()).unwrap();
    assert_eq!(line(&lines), 2);
    fs::create_dir_all(b.join("parts")).unwrap();
    let recipe = serde_json::to_string(&made.recipe).unwrap();
    fs::write(b.join("parts/recipe.json"), recipe).unwrap();
    let first: String = lines.lines().take(2).map(|l| format!("{l}\n")).collect();
    fs::write(b.join("parts/train_000000.jsonl"), first).unwrap();
    for (path, bytes) in whole.iter().filter(|(path, _)| path.to_string_lossy().contains("train/rural")) {
        fs::create_dir_all(b.join(path).parent().unwrap()).unwrap();
        fs::write(b.join(path), bytes).unwrap();
    }
    let other = natural::make(&NaturalArgs { seed: 6, ..natural_args(b.clone(), 2) }, &interrupt);
    assert!(other.unwrap_err().to_string().contains("other arguments"));
    natural::make(&natural_args(b.clone(), 2), &interrupt).unwrap();
    assert_eq!(contents(&b), whole);

    assert!(natural::make(&natural_args(a.clone(), 1), &interrupt).is_err(), "it is complete");
    let eval_args =
        EvalArgs { checkpoint: CheckpointChoice::Truth, dataset: a, split: "val".into(), save_predictions: None };
    assert_eq!(eval::run(&eval_args, true).unwrap(), Verdict::Ok);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn cases_become_a_dataset_whose_labels_are_the_truth() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, case) = recorded(dir.path());
    let args = |files: &[&Path], name: &str| CasesArgs {
        files: files.iter().map(|file| file.to_path_buf()).collect(),
        split: "train".into(),
        size: (128, 64),
        out: dir.path().join(name),
    };
    for name in ["first", "second"] {
        cases::run(&args(&[&case], name), true).unwrap();
    }
    let first = contents(&dir.path().join("first"));
    assert_eq!(first, contents(&dir.path().join("second")));
    assert_eq!(first.len(), 30 * 5 + 2, "30 frames of 5 pictures, and what they are");
    let lines = String::from_utf8(first[Path::new("frames.jsonl")].clone()).unwrap();
    for line in lines.lines() {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        let counted: u64 = line["class_pixels"].as_object().unwrap().values().map(|n| n.as_u64().unwrap()).sum();
        assert!(counted > 7_000 && counted <= 128 * 64, "{line}");
        assert!(first.contains_key(Path::new(line["image"].as_str().unwrap())), "{line}");
        assert!(line["state_hash"].is_string() && line["tick"].as_u64().unwrap() <= TAKEOVER, "{line}");
    }

    let copy = dir.path().join("copy.case.mcap");
    fs::copy(&case, &copy).unwrap();
    for (files, words) in
        [(&[case.as_path(), &copy][..], "the same case as"), (&[&recording], "expected a corner case")]
    {
        let said = format!("{:#}", cases::run(&args(files, "third"), true).unwrap_err());
        assert!(said.contains(words) && !dir.path().join("third").exists(), "{said}");
    }
}
