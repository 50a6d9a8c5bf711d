//! Checkpoints compared over a library of cases: who sees the hazard, since when, and what gates say.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use aeye::cli::{CompareArgs, ImagingArgs};
use aeye::commands::compare;
use aeye::exit::{self, Verdict};
use base::failure::sentence;
use drivers::checkpoint::CheckpointChoice;
use kernel::events::EventKind;
use render::{AdapterChoice, Camera, Renderer};
use replay::{Case, Recording};
use serde_json::Value;
use tests::files::contents;
use tests::recordings::{ALONE, record};
use tests::scenes::scene;
use tests::toy::all_road;

const TRUTH: CheckpointChoice = CheckpointChoice::Truth;
const SIZE: (u32, u32) = (64, 32);

/// A folder with cases of drives that nobody kept from a collision with a road user.
fn library(folder: &Path) -> PathBuf {
    static CASES: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    let library = folder.join("library");
    fs::create_dir(&library).unwrap();
    for (number, bytes) in CASES.get_or_init(|| (3..100).filter_map(collision).take(3).collect()).iter().enumerate() {
        fs::write(library.join(format!("{number}.case.mcap")), bytes).unwrap();
    }
    library
}

/// The case of a drive of the city with this seed, if it hits a road user.
fn collision(seed: u64) -> Option<Vec<u8>> {
    let scene = scene(&format!("map = \"city\"\nseed = {seed}\n[traffic]\ncars = 60\npedestrians = 60\n"));
    let recording = Recording::from_bytes(&record(&scene, 1500, ALONE)).unwrap();
    let hit = recording.log().events.iter().any(|(_, event)| event.kind == EventKind::CollisionActor);
    let window = Case::window(recording.log()).filter(|_| hit)?;
    Some(Case::cut(&recording, &scene.network, window).unwrap().encode().unwrap())
}

fn args(files: &[&Path], checkpoint: &[CheckpointChoice], out: &Path) -> CompareArgs {
    CompareArgs {
        verdict: Vec::new(),
        files: files.iter().map(|file| file.to_path_buf()).collect(),
        checkpoint: checkpoint.to_vec(),
        gate: vec![],
        no_worse_than: None,
        size: Some(SIZE),
        imaging: ImagingArgs::default(),
        jobs: Some(2),
        shard: None,
        out: out.to_owned(),
    }
}

fn compared(args: &CompareArgs, expected: Verdict) -> Value {
    assert_eq!(compare::run(args, true).unwrap(), expected);
    serde_json::from_slice(&fs::read(args.out.join("compare.json")).unwrap()).unwrap()
}

/// Tick of the first frame that shows 8 pixels of a case's hazard, drawn without the lab.
fn first_visible(case: &Path, hazard: &str) -> Option<u64> {
    let instance: u16 = hazard.split(' ').next_back().unwrap().parse().unwrap();
    let recording = Recording::open(case).unwrap();
    let mut renderer = Renderer::new(&recording.network().unwrap(), &AdapterChoice::default()).unwrap();
    let mut pixels = |scene| {
        let frame = renderer.draw(scene, &Camera::driver(SIZE.0, SIZE.1)).unwrap();
        frame.instance_ids.iter().filter(|id| **id == instance).count()
    };
    recording.log().scenes.iter().find(|scene| pixels(scene) >= 8).map(|scene| scene.tick)
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn truth_fixes_what_a_network_breaks_that_sees_nothing_but_road() {
    let dir = tempfile::tempdir().unwrap();
    let library = library(dir.path());
    let road = CheckpointChoice::File(all_road(dir.path()));
    let gates = |texts: &[&str]| texts.iter().map(|text| text.parse().unwrap()).collect();
    let mut forth = args(&[&library], &[road.clone(), TRUTH], &dir.path().join("forth"));
    forth.gate = gates(&["miou>=1", "hazards_seen>0", "fixed>=1", "broken<=0"]);
    forth.no_worse_than = Some("road".into());
    let found = compared(&forth, Verdict::Ok);
    let [road_line, truth_line] = &found["checkpoints"].as_array().unwrap()[..] else { panic!("{found}") };
    assert_eq!((truth_line["miou"].as_f64(), road_line["hazards_seen"].as_f64()), (Some(1.0), Some(0.0)));
    assert_eq!(road_line["iou"]["Vehicles"].as_f64(), Some(0.0));
    let mut fixed = 0;
    for case in found["cases"].as_array().unwrap() {
        let [by_road, by_truth] = &case["checkpoints"].as_array().unwrap()[..] else { panic!("{case}") };
        let path = library.join(format!("{}.mcap", case["file"].as_str().unwrap()));
        let visible = case["hazard"].as_str().and_then(|hazard| first_visible(&path, hazard));
        assert_eq!(by_truth["first_seen_tick"].as_u64(), visible, "{case}");
        let end = Case::open(&path).unwrap().info().to;
        let in_time = visible.is_some_and(|tick| end - tick >= 60);
        let expected = if in_time {
            "fixed"
        } else if visible.is_some() {
            "unchanged"
        } else {
            "no_hazard"
        };
        assert_eq!(by_truth["verdict"], expected, "{case}");
        assert!(by_road["first_seen_tick"].is_null() && by_road["verdict"].is_null(), "{case}");
        fixed += u64::from(in_time);
    }
    assert!(fixed >= 1);
    assert_eq!(truth_line["against_baseline"]["fixed"].as_u64(), Some(fixed));

    let mut back = args(&[&library], &[TRUTH, road], &dir.path().join("back"));
    back.no_worse_than = Some("truth".into());
    let found = compared(&back, Verdict::CheckFailed);
    let against = &found["checkpoints"][1]["against_baseline"];
    assert_eq!((against["broken"].as_u64(), against["fixed"].as_u64()), (Some(fixed), Some(0)));
    let failed: Vec<_> = found["gates"].as_array().unwrap().iter().filter(|gate| gate["passed"] == false).collect();
    assert!(failed.iter().any(|gate| gate["gate"] == "miou no worse than truth"), "{failed:?}");
    back.no_worse_than = None;
    for (gate, expected) in
        [("miou<0.5", Verdict::Ok), ("miou>=0.5", Verdict::CheckFailed), ("broken<1", Verdict::CheckFailed)]
    {
        back.gate = gates(&[gate]);
        let found = compared(&back, expected);
        assert!(found["gates"][0]["sentence"].as_str().unwrap().starts_with("road "), "{found}");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_comparison_in_pieces_is_the_one_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let library = library(dir.path());
    let road = CheckpointChoice::File(all_road(dir.path()));
    let all = [road.clone(), TRUTH, CheckpointChoice::Bundled("early")];
    let (once, pieces) = (dir.path().join("once"), dir.path().join("pieces"));
    compared(&CompareArgs { jobs: Some(1), ..args(&[&library], &all, &once) }, Verdict::Ok);
    let first = fs::read_dir(&library).unwrap().map(|entry| entry.unwrap().path()).min().unwrap();
    compared(&args(&[&first], &all[..2], &pieces), Verdict::Ok);
    let mark = pieces.join(".compare").join(first.file_stem().unwrap()).join("checkpoints/road.json");
    let whole = fs::read(&mark).unwrap();
    fs::write(&mark, &whole[..whole.len() / 2]).unwrap();
    fs::create_dir(pieces.join(".compare/.aeye-killed")).unwrap();
    compared(&CompareArgs { jobs: Some(3), ..args(&[&library], &all, &pieces) }, Verdict::Ok);
    let (once, pieces) = (contents(&once), contents(&pieces));
    assert_eq!(once.keys().collect::<Vec<_>>(), pieces.keys().collect::<Vec<_>>());
    assert!(once == pieces, "the same bytes");
    let page = String::from_utf8(once[Path::new("report.html")].clone()).unwrap();
    let pictures = page.matches("data:image/png;base64,").count();
    assert!(pictures >= 5 && pictures.is_multiple_of(5), "{pictures} pictures: camera, truth, three checkpoints");
    assert!(["src=\"http", "href=\"http", "src=\"/", "@import", "url("].iter().all(|link| !page.contains(link)));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn what_cannot_be_compared_is_said_and_another_kernels_case_counts_by_its_pictures() {
    let dir = tempfile::tempdir().unwrap();
    let library = library(dir.path());
    let (case, out) = (fs::read_dir(&library).unwrap().next().unwrap().unwrap().path(), dir.path().join("out"));
    let said = |args: &CompareArgs| {
        let result = compare::run(args, true);
        assert_eq!(exit::number(&result), 2);
        sentence(&result.unwrap_err())
    };
    let sentence = said(&args(&[&case], &[TRUTH], &out));
    assert!(sentence.contains("two or more checkpoints"), "{sentence}");
    let other = CompareArgs {
        no_worse_than: Some("late".into()),
        ..args(&[&case], &[TRUTH, CheckpointChoice::Bundled("early")], &out)
    };
    assert_eq!(said(&other), "--no-worse-than late: no such checkpoint; expected one of truth, early");
    assert!(!out.exists());

    let mut log = Recording::open(&case).unwrap().into_log();
    log.manifest.kernel = "0.0.1".into();
    fs::write(&case, log.encode().unwrap()).unwrap();
    let road = CheckpointChoice::File(all_road(dir.path()));
    let found = compared(&args(&[&case], &[road, TRUTH], &out), Verdict::Ok);
    let [case] = &found["cases"].as_array().unwrap()[..] else { panic!("{found}") };
    assert_eq!((case["frames"].as_u64(), case["hazard"].is_null()), (Some(30), true));
    assert_eq!(
        (case["checkpoints"][1]["miou"].as_f64(), &case["checkpoints"][1]["verdict"]),
        (Some(1.0), &"no_hazard".into())
    );
}
