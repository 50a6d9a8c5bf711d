//! Datasets are functions of their recipes, and each frame says where it comes from.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::EvalArgs;
use aeye::commands::eval;
use aeye::exit::Verdict;
use base::progress::Interrupt;
use drivers::checkpoint::CheckpointChoice;
use drivers::vision::{Eye, Vision};
use kernel::weather::WeatherPreset;
use lab::dataset::{FrameLine, Manifest, Part, cases, mix, natural, rebuild};
use lab::redrive::{Counterfactual, Need};
use perception::training::Split;
use render::{AdapterChoice, Imaging, Renderer};
use replay::{Annotation, Case, Label, Recording};
use tests::files::contents;
use tests::recordings::{TAKEOVER, recorded, recorded_in};
use tests::scenes::{busy_city, country_road};

fn natural_args(out: PathBuf, jobs: u16) -> natural::Options {
    natural::Options {
        scenes: 2,
        val_scenes: 1,
        test_scenes: 1,
        frames: 2,
        test_frames: 1,
        size: (64, 32),
        imaging: Imaging::default(),
        cameras: None,
        maps: vec!["rural".into(), "city".into()],
        pedestrians: Some(20),
        weather: Vec::new(),
        seed: 5,
        jobs: Some(jobs),
        out,
    }
}

fn cases_args(files: &[&Path], out: PathBuf) -> cases::Options {
    let files = files.iter().map(|file| file.to_path_buf()).collect();
    cases::Options {
        files,
        label: Vec::new(),
        verdict: Vec::new(),
        split: "train".into(),
        size: (64, 32),
        imaging: Imaging::default(),
        cameras: None,
        jobs: None,
        out,
    }
}

fn lines(folder: &Path) -> Vec<FrameLine> {
    let text = fs::read_to_string(folder.join("frames.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn hex(digest: &[u8]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Pictures and labels that are the training split, by their digests, as a set.
fn training(folder: &Path) -> BTreeSet<(String, String)> {
    let lines = lines(folder).into_iter().filter(|line| line.split == "train");
    lines.map(|line| (line.rgb_digest, line.labels_digest)).collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_dataset_is_the_same_in_parallel_and_when_it_was_interrupted() {
    let dir = tempfile::tempdir().unwrap();
    let interrupt = Interrupt::default();
    let (a, b) = (dir.path().join("a"), dir.path().join("b"));
    // As a kill leaves it that comes just before the recipe has its name.
    fs::create_dir_all(a.join("parts")).unwrap();
    fs::write(a.join("parts/.aeye-begun.json-abcdef"), "half").unwrap();
    let made = natural::make(&natural_args(a.clone(), 1), &interrupt).unwrap();
    assert_eq!((made.train_frames, made.val_frames, made.test_frames), (4, 2, 1));
    let whole = contents(&a);
    assert_eq!(whole.len(), 7 * 5 + 4 + 2, "five files a frame, a recording a scene, the frames' list, the manifest");

    // What an interrupted run leaves: what it was begun with, one finished scene, no manifest.
    natural::make_shard(&natural_args(b.clone(), 1), "1/4".parse().unwrap(), &interrupt).unwrap();
    let begun = b.join("parts/begun.json");
    let text = fs::read_to_string(&begun).unwrap();
    fs::write(&begun, text.replace(&made.adapter, "another")).unwrap();
    let said = natural::make(&natural_args(b.clone(), 2), &interrupt).unwrap_err().to_string();
    assert!(said.contains("on another; expected the same to complete it"), "{said}");
    fs::write(&begun, text).unwrap();
    let other = natural::make(&natural::Options { seed: 6, ..natural_args(b.clone(), 2) }, &interrupt);
    assert!(other.unwrap_err().to_string().contains("other arguments"));
    natural::make(&natural_args(b.clone(), 2), &interrupt).unwrap();
    assert_eq!(contents(&b), whole);

    // As a kill leaves it that comes just after the manifest was written.
    fs::create_dir(a.join("parts")).unwrap();
    assert_eq!(natural::make(&natural_args(a.clone(), 1), &interrupt).unwrap(), made, "it is complete");
    assert!(!a.join("parts").exists());
    let other = natural::Options { seed: 6, ..natural_args(a.clone(), 1) };
    assert!(natural::make(&other, &interrupt).unwrap_err().to_string().contains("another recipe"));
    assert_eq!(contents(&a), whole);
    let eval_args =
        EvalArgs { checkpoint: CheckpointChoice::Truth, dataset: a, split: "val".into(), jobs: None, out: None };
    assert_eq!(eval::run(&eval_args, true).unwrap(), Verdict::Ok);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn each_map_meets_each_weather_that_is_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let weather = ["DryNight", "FoggyNoon"].map(|name| *WeatherPreset::find(name).unwrap()).to_vec();
    let asked = natural::Options {
        scenes: 4,
        val_scenes: 0,
        test_scenes: 0,
        frames: 1,
        weather,
        ..natural_args(dir.path().to_owned(), 2)
    };
    natural::make(&asked, &Interrupt::default()).unwrap();
    let met: Vec<(f32, f32)> =
        lines(dir.path()).iter().map(|line| (line.weather.sun_altitude_deg, line.weather.fog_density_pct)).collect();
    assert_eq!(met, [(-30.0, 0.0), (-30.0, 0.0), (45.0, 50.0), (45.0, 50.0)]);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn every_natural_frame_is_a_tick_of_a_recording_that_verifies() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("a");
    natural::make(&natural_args(out.clone(), 2), &Interrupt::default()).unwrap();
    let mut drives = BTreeMap::new();
    for (path, bytes) in contents(&out.join("drives")) {
        let recording = Recording::from_bytes(&bytes).unwrap();
        let network = recording.network().unwrap();
        let report = replay::verify(recording.log(), &network).unwrap();
        assert!(report.divergence.is_none(), "{}", path.display());
        drives.insert(hex(&recording.digest()), recording);
    }
    let lines = lines(&out);
    assert_eq!((lines.len(), drives.len()), (7, 4));
    for line in lines {
        let log = drives[&line.recording].log();
        let hash = log.hash(line.tick).map(|hash| format!("{hash:08x}"));
        assert!(hash.is_some() && hash == line.state_hash && log.manifest.scenario.seed == line.seed, "{line:?}");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn cases_become_a_dataset_whose_labels_are_the_truth() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, case) = recorded(dir.path());
    let out = |name: &str| dir.path().join(name);
    let make = |files: &[&Path], name: &str| cases::make(&cases_args(files, out(name)), &Interrupt::default());
    let made = make(&[&case], "first").unwrap();
    assert_eq!(make(&[&case], "second").unwrap(), made);
    let first = contents(&out("first"));
    assert_eq!(first, contents(&out("second")));
    assert_eq!(first.len(), 30 * 5 + 2, "30 frames of 5 pictures, and what they are");
    assert_eq!(make(&[&case], "first").unwrap(), made, "it is complete");
    let split = Split::read(&out("first"), "train", 64, 32).unwrap();
    for (line, frame) in lines(&out("first")).iter().zip(&split.frames) {
        let counted = frame.labels.iter().filter(|id| **id != 255).count() as u64;
        assert_eq!(line.class_pixels.values().sum::<u64>(), counted, "{line:?}");
        assert_eq!(line.pedestrian_pixels(), frame.labels.iter().filter(|id| **id == 2).count() as u64);
        assert!(first.contains_key(Path::new(&line.image)) && line.label.as_deref() == Some("rules"), "{line:?}");
        assert!(line.state_hash.is_some() && line.tick <= TAKEOVER, "{line:?}");
        assert_eq!(line.recording, hex(&Recording::open(&recording).unwrap().digest()));
    }

    let copy = dir.path().join("copy.case.mcap");
    fs::copy(&case, &copy).unwrap();
    fs::create_dir(out("empty")).unwrap();
    for (files, words) in [
        (&[case.as_path(), &copy][..], "the same case as"),
        (&[dir.path()], "the same case as"),
        (&[&recording], "expected a corner case"),
        (&[&out("empty")], "holds no corner case; expected at least one *.case.mcap"),
        (&[&out("missing.case.mcap")], "missing.case.mcap: "),
    ] {
        let said = format!("{:#}", make(files, "third").unwrap_err());
        assert!(said.contains(words) && !out("third").exists(), "{said}");
    }
    let walkers = cases::Options { label: vec![Label::Walker], ..cases_args(&[&case], out("third")) };
    let said = cases::make(&walkers, &Interrupt::default()).unwrap_err().to_string();
    assert_eq!(said, "none of the corner cases is labelled walker");
    assert!(make(&[&case, &copy], "first").is_err() && contents(&out("first")) == first);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn cases_are_taken_by_the_verdict_on_their_takeover() {
    let dir = tempfile::tempdir().unwrap();
    let cases =
        [("a", busy_city()), ("b", country_road())].map(|(name, scene)| (recorded_in(&scene, dir.path(), name), scene));
    let files: Vec<&Path> = cases.iter().map(|((_, case), _)| case.as_path()).collect();
    let make = |verdict: Need, out: &str| {
        let options = cases::Options { verdict: vec![verdict], ..cases_args(&files, dir.path().join(out)) };
        cases::make(&options, &Interrupt::default())
    };
    let said = make(Need::Needless, "none").unwrap_err().to_string();
    assert_eq!(said, "on none of the corner cases the verdict is needless");
    let ((recording, case), scene) = &cases[0];
    let recording = Recording::open(recording).unwrap();
    let vision = Vision::new(Renderer::new(&scene.network, &AdapterChoice::default()).unwrap(), Eye::Truth);
    let (found, _) = Counterfactual::of(&recording, &scene.network, vision).unwrap();
    fs::write(case.with_file_name("a.counterfactual.json"), found.encode().unwrap()).unwrap();
    assert_eq!(make(found.verdict, "one").unwrap().train_frames, 30);
    let other = if found.verdict == Need::Necessary { Need::Needless } else { Need::Necessary };
    assert!(make(other, "none").is_err() && !dir.path().join("none").exists());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_dataset_of_cases_does_not_depend_on_the_number_of_threads() {
    let dir = tempfile::tempdir().unwrap();
    let cases =
        [("a", busy_city()), ("b", country_road())].map(|(name, scene)| recorded_in(&scene, dir.path(), name).1);
    let files: Vec<&Path> = cases.iter().map(PathBuf::as_path).collect();
    let make = |jobs: u16| {
        let out = dir.path().join(jobs.to_string());
        cases::make(&cases::Options { jobs: Some(jobs), ..cases_args(&files, out.clone()) }, &Interrupt::default())
            .unwrap();
        contents(&out)
    };
    assert!(make(1) == make(3));
}

/// A case as another kernel would have cut it.
fn of_another_kernel(case: &Path, to: &Path, keep_scenes: bool) {
    let mut log = Case::open(case).unwrap().log().clone();
    log.manifest.kernel = "0.0.9".into();
    let comment = String::new();
    log.annotation = Some(Annotation { label: Label::Walker, comment, perception_caused: None });
    if !keep_scenes {
        log.scenes.clear();
    }
    fs::write(to, log.encode().unwrap()).unwrap();
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_case_from_another_kernel_shows_its_stored_scenes_or_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let out = |name: &str| dir.path().join(name);
    let (with, without) = (out("with.case.mcap"), out("without.case.mcap"));
    of_another_kernel(&case, &with, true);
    of_another_kernel(&case, &without, false);
    let make = |file: &Path, name: &str| cases::make(&cases_args(&[file], out(name)), &Interrupt::default());
    make(&case, "now").unwrap();
    make(&with, "then").unwrap();
    assert_eq!(training(&out("now")), training(&out("then")));
    let said = format!("{:#}", make(&without, "never").unwrap_err());
    let words = "without.case.mcap: made by kernel 0.0.9; this one";
    assert!(said.contains(words) && !said.contains('\n') && !out("never").exists(), "{said}");
}

/// Three datasets to be mixed: natural, pool, cases.
fn parts(dir: &Path) -> mix::Options {
    let (_, case) = recorded(dir);
    let [natural, pool, cases] = ["natural", "pool", "cases"].map(|name| dir.join(name));
    let interrupt = Interrupt::default();
    let many = natural::Options { frames: 6, ..natural_args(natural.clone(), 2) };
    natural::make(&many, &interrupt).unwrap();
    let none = natural::Options { val_scenes: 0, test_scenes: 0, ..many };
    let others = natural::Options { frames: 15, seed: 6, pedestrians: Some(200), out: pool.clone(), ..none };
    natural::make(&others, &interrupt).unwrap();
    cases::make(&cases_args(&[&case], cases.clone()), &interrupt).unwrap();
    mix::Options { natural, pool, cases, replace: Some(5), seed: 3, out: dir.join("mix") }
}

fn with(args: &mix::Options, seed: u64, replace: Option<u32>, name: &str) -> mix::Options {
    let mix::Options { natural, pool, cases, out, .. } = args;
    let out = out.with_file_name(name);
    mix::Options { natural: natural.clone(), pool: pool.clone(), cases: cases.clone(), replace, seed, out }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_mix_is_three_sets_of_equal_size_in_which_the_same_frames_were_replaced() {
    let dir = tempfile::tempdir().unwrap();
    let interrupt = Interrupt::default();
    let args = parts(dir.path());
    let made = mix::make(&args, &interrupt).unwrap();
    let of = |name: &str| training(&args.out.join(name));
    let (natural, pedestrian, corner_case) = (of("natural"), of("pedestrian"), of("corner-case"));
    assert_eq!(natural, training(&args.natural));
    assert_eq!([natural.len(), pedestrian.len(), corner_case.len()], [12; 3]);
    let left = |set: &BTreeSet<_>| natural.difference(set).cloned().collect::<BTreeSet<_>>();
    assert_eq!((left(&pedestrian).len(), left(&pedestrian)), (5, left(&corner_case)));
    assert!(pedestrian.difference(&natural).all(|frame| training(&args.pool).contains(frame)));
    assert!(corner_case.difference(&natural).all(|frame| training(&args.cases).contains(frame)));

    for (name, manifest) in made.named() {
        let folder = args.out.join(name);
        assert_eq!(Manifest::read(&folder).unwrap(), *manifest);
        let lines = lines(&folder);
        let pixels: u64 = lines.iter().filter(|l| l.split == "train").map(FrameLine::pedestrian_pixels).sum();
        assert_eq!(manifest.pedestrian_pixels, Some(pixels as f64 / 12.0));
        for split in ["train", "val", "test"] {
            let read = Split::read(&folder, split, 64, 32).unwrap();
            assert_eq!(read.frames.len(), lines.iter().filter(|line| line.split == split).count());
            let same = Split::read(&args.natural, split, 64, 32).unwrap().digest == read.digest;
            assert_eq!(same, split != "train" || name == "natural", "{name} {split}");
        }
        let part = |part| lines.iter().filter(|line| line.part == Some(part)).count();
        let expected = if name == "natural" {
            [0, 0, 0]
        } else {
            [14, 5 * usize::from(name == "pedestrian"), 5 * usize::from(name == "corner-case")]
        };
        assert_eq!([part(Part::Natural), part(Part::Pool), part(Part::Cases)], expected);
    }
    let figures = made.named().map(|(_, manifest)| manifest.pedestrian_pixels.unwrap());
    assert!((figures[1] - figures[2]).abs() < 1.0, "{figures:?}");

    let before = contents(&args.out);
    assert_eq!(mix::make(&args, &interrupt).unwrap(), made, "it is complete");
    let said =
        mix::make(&mix::Options { seed: 4, ..with(&args, 4, Some(5), "mix") }, &interrupt).unwrap_err().to_string();
    assert!(said.contains("another recipe"), "{said}");
    mix::make(&with(&args, 3, Some(5), "again"), &interrupt).unwrap();
    assert_eq!(contents(&args.out.with_file_name("again")), before);
    mix::make(&with(&args, 4, Some(5), "other"), &interrupt).unwrap();
    assert_ne!(training(&args.out.with_file_name("other").join("corner-case")), corner_case);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn what_cannot_be_mixed_is_named_and_nothing_is_left() {
    let dir = tempfile::tempdir().unwrap();
    let args = parts(dir.path());
    let refused = |args: mix::Options, words: &[&str]| {
        let said = base::failure::sentence(&mix::make(&args, &Interrupt::default()).unwrap_err());
        assert!(words.iter().all(|word| said.contains(word)), "{said} lacks one of {words:?}");
        let left = fs::read_dir(dir.path()).unwrap().filter(|e| {
            let name = e.as_ref().unwrap().file_name();
            name == "mix" || name.to_string_lossy().starts_with(".aeye")
        });
        assert_eq!(left.count(), 0, "{said}");
    };
    refused(with(&args, 3, None, "mix"), &["natural: holds 12 training frames; expected at least 30"]);
    refused(with(&args, 3, Some(0), "mix"), &["--replace 0"]);
    let natural = args.natural.clone();
    refused(mix::Options { pool: natural.clone(), ..with(&args, 3, Some(5), "mix") }, &["is of a drive that"]);
    refused(mix::Options { pool: dir.path().join("none"), ..with(&args, 3, Some(5), "mix") }, &["none/dataset.json: "]);

    let staying = lines(&natural).into_iter().find(|line| line.split == "val").unwrap();
    for (file, words) in [(&staying.labels, "labelTrainIds.png"), (&staying.image, "leftImg8bit.png")] {
        let path = natural.join(file);
        let bytes = fs::read(&path).unwrap();
        fs::remove_file(&path).unwrap();
        refused(with(&args, 3, Some(5), "mix"), &[words, "No such file"]);
        fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        refused(with(&args, 3, Some(5), "mix"), &[words]);
        fs::copy(args.pool.join(&lines(&args.pool)[7].labels), &path).unwrap();
        refused(with(&args, 3, Some(5), "mix"), &[words]);
        fs::write(&path, bytes).unwrap();
    }
    let list = natural.join("frames.jsonl");
    let text = fs::read_to_string(&list).unwrap();
    fs::write(&list, text.lines().skip(1).map(|l| format!("{l}\n")).collect::<String>()).unwrap();
    refused(with(&args, 3, Some(5), "mix"), &["frames.jsonl: was changed since"]);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn recipes_alone_make_the_same_folders_again() {
    let dir = tempfile::tempdir().unwrap();
    let interrupt = Interrupt::default();
    let args = parts(dir.path());
    mix::make(&args, &interrupt).unwrap();
    let recipe = dir.path().join("recipe.json");
    let again = |recipe: &Path, cases: Vec<PathBuf>, name: &str| {
        let (recipe, out) = (recipe.to_owned(), dir.path().join(name));
        rebuild::make(&rebuild::Options { recipe, cases, maps: Vec::new(), jobs: Some(2), out }, &interrupt)
    };
    for (number, set) in ["natural", "pedestrian", "corner-case"].into_iter().enumerate() {
        let first = args.out.join(set);
        fs::copy(first.join("dataset.json"), &recipe).unwrap();
        let cases = if set == "corner-case" { vec![dir.path().join("a.case.mcap")] } else { Vec::new() };
        let rebuilt = again(&recipe, cases, &format!("again-{number}")).unwrap();
        assert!(rebuilt.same && rebuilt.same_labels && rebuilt.made_otherwise.is_none(), "{set}");
        assert!(rebuilt.is_as_promised());
        assert_eq!(contents(&dir.path().join(format!("again-{number}"))), contents(&first), "{set}");
    }
    assert!(!dir.path().join("again-1.parts").exists());

    let said = again(&args.cases, Vec::new(), "never").unwrap_err().to_string();
    assert!(said.starts_with("case a.case with digest ") && said.contains("after the recipe"), "{said}");
    assert!(!dir.path().join("never").exists());

    // What if the first one had come out otherwise?
    let text = fs::read_to_string(dir.path().join("again-0/dataset.json")).unwrap();
    let is_as_promised = |changes: &[&str]| {
        let mut first: serde_json::Value = serde_json::from_str(&text).unwrap();
        changes.iter().for_each(|field| first[*field] = "other".into());
        fs::write(&recipe, first.to_string()).unwrap();
        again(&recipe, Vec::new(), "again-0").unwrap().is_as_promised()
    };
    assert!(!is_as_promised(&["digest"]));
    assert!(is_as_promised(&["digest", "adapter"]));
    assert!(!is_as_promised(&["digest", "adapter", "labels_digest"]));
    let other_map = text.replace("\"rural\"", "\"moor\"");
    fs::write(&recipe, other_map).unwrap();
    let said = again(&recipe, Vec::new(), "never").unwrap_err().to_string();
    assert!(said.starts_with("map moor with digest ") && said.contains("after --maps"), "{said}");
    fs::write(&recipe, "{}").unwrap();
    let said = format!("{:#}", again(&recipe, Vec::new(), "never").unwrap_err());
    assert!(said.contains("recipe.json: does not describe a dataset"), "{said}");
}
