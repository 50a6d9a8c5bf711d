//! Pictures of many files through many checkpoints: made once, whole or not at all, and the same however
//! the work was cut.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::{ImagingArgs, RerenderArgs};
use aeye::commands::rerender;
use aeye::exit::Verdict;
use base::failure::sentence;
use drivers::checkpoint::CheckpointChoice;
use replay::Recording;
use tests::files::contents;
use tests::recordings::recorded_in;
use tests::scenes::{busy_city, country_road};

const EARLY: CheckpointChoice = CheckpointChoice::Bundled("early");

/// A folder with two cases on two maps, one of them further below; also their recordings.
fn library(folder: &Path) -> PathBuf {
    let library = folder.join("library");
    fs::create_dir_all(library.join("below")).unwrap();
    recorded_in(&busy_city(), &library, "b");
    recorded_in(&country_road(), &library.join("below"), "a");
    library
}

fn args(files: &[&Path], checkpoint: &[CheckpointChoice], jobs: u16, out: &Path) -> RerenderArgs {
    let files = files.iter().map(|file| file.to_path_buf()).collect();
    let (checkpoint, out) = (checkpoint.to_vec(), out.to_owned());
    RerenderArgs {
        files,
        checkpoint,
        last: 60,
        fps: 10,
        size: Some((128, 64)),
        imaging: ImagingArgs::default(),
        cameras: None,
        jobs: Some(jobs),
        shard: None,
        out,
    }
}

fn rerendered(args: &RerenderArgs) -> BTreeMap<PathBuf, Vec<u8>> {
    assert_eq!(rerender::run(args, true).unwrap(), Verdict::Ok);
    contents(&args.out)
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn work_that_is_cut_in_pieces_gives_the_same_and_is_done_once() {
    let dir = tempfile::tempdir().unwrap();
    let library = library(dir.path());
    let both = [CheckpointChoice::Truth, EARLY];
    let (whole, out) = (dir.path().join("whole"), dir.path().join("pieces"));
    let expected = rerendered(&args(&[&library], &both, 1, &whole));
    let names: Vec<_> = ["b.case", "below/a.case"].map(|name| format!("{name}/predictions/early/00000950.png")).into();
    assert!(names.iter().all(|name| expected.contains_key(Path::new(name))), "{:?}", expected.keys());

    // One file through one checkpoint, and in vain at another size; then a picture is lost, another is changed, and a
    // process is killed.
    let one = library.join("b.case.mcap");
    let first = rerendered(&args(&[&one], &both[..1], 2, &out));
    let other = RerenderArgs { size: Some((64, 32)), last: 90, ..args(&[&one], &both, 2, &out) };
    let said = sentence(&rerender::run(&other, true).unwrap_err());
    let words =
        "holds results of --last 1s --size 128x64; expected the same, or another folder for --last 1.5s --size 64x32";
    assert!(said.ends_with(words), "{said}");
    assert!(contents(&out) == first, "what is there stays");
    fs::remove_file(out.join("b.case/predictions/truth/00000950.png")).unwrap();
    let kept = out.join("b.case/rgb/00000950.png");
    let mark = [fs::read(&kept).unwrap(), b"kept".to_vec()].concat();
    fs::write(&kept, &mark).unwrap();
    fs::create_dir_all(out.join(".rerender/.aeye-killed/rgb")).unwrap();
    let mut got = rerendered(&args(&[&library], &both, 3, &out));
    assert!(
        got.insert("b.case/rgb/00000950.png".into(), expected[Path::new("b.case/rgb/00000950.png")].clone())
            == Some(mark)
    );
    assert_eq!(got.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    assert!(got == expected, "the same bytes");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn what_cannot_be_rendered_is_said_in_a_sentence_and_leaves_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let library = library(dir.path());
    let place = |name: &str| dir.path().join(name);
    let (empty, copy, other, notes) =
        (place("empty"), place("copy.case.mcap"), place("other.case.mcap"), place("notes"));
    fs::create_dir(&empty).unwrap();
    fs::copy(library.join("b.case.mcap"), &copy).unwrap();
    let mut log = Recording::open(&copy).unwrap().into_log();
    log.manifest.kernel = "0.0.1".into();
    log.manifest.case.as_mut().unwrap().source = [1; 32];
    log.scenes.clear();
    fs::write(&other, log.encode().unwrap()).unwrap();
    fs::create_dir(&notes).unwrap();
    fs::write(notes.join("a.txt"), "a note").unwrap();
    let gone = CheckpointChoice::File(place("gone.onnx"));
    let out = place("out");
    let cases: [(&[&Path], &CheckpointChoice, &Path, &str); 4] = [
        (&[&empty], &EARLY, &out, "empty: holds no corner case; expected at least one *.case.mcap"),
        (&[&other], &EARLY, &out, "other.case.mcap: made by kernel 0.0.1; this one, "),
        (&[&copy], &gone, &out, "gone.onnx: no such checkpoint; expected one of early, full, truth, or an ONNX file"),
        (&[&copy], &EARLY, &notes, "notes: exists already; expected a new or an empty folder"),
    ];
    for (files, checkpoint, out, words) in cases {
        let error = rerender::run(&args(files, std::slice::from_ref(checkpoint), 2, out), true).unwrap_err();
        let said = sentence(&error);
        assert!(said.contains(words) && said.len() < 300, "{said}");
        assert!(!place("out").exists(), "{said}");
    }
    assert_eq!(contents(&notes).len(), 1);
}
