//! The offline lab: the same inputs give the same bytes, and what fails leaves nothing behind.

use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::{ImagingArgs, InspectArgs, RerenderArgs};
use aeye::commands::{inspect, rerender};
use aeye::exit::{self, Verdict};
use drivers::checkpoint::CheckpointChoice;
use lab::report;
use replay::Recording;
use tests::files::contents;
use tests::recordings::{ALONE, TAKEOVER, record, recorded, recorded_in};
use tests::scenes::busy_city;

fn rerender_args(file: &Path, out: PathBuf) -> RerenderArgs {
    let checkpoint = vec![CheckpointChoice::Truth];
    RerenderArgs {
        files: vec![file.to_owned()],
        checkpoint,
        last: 180,
        fps: 10,
        size: Some((128, 64)),
        imaging: ImagingArgs::default(),
        cameras: None,
        jobs: None,
        shard: None,
        out,
    }
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
    let diverged = rerender::run(&rerender_args(&forged, out.clone()), true);
    assert_eq!(exit::number(&diverged), 3, "{diverged:?}");
    let looked_at = inspect::run(&InspectArgs { files: vec![forged.clone()], reveal: false, jobs: None }, true);
    assert_eq!(exit::number(&looked_at), 3, "{looked_at:?}");
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
    let html = report::render(&[case], &[CheckpointChoice::Truth], Some((64, 32)), None).unwrap().html;
    assert_eq!(html.matches("data:image/png;base64,").count(), 90);
    assert!(html.contains("a &lt;test&gt;") && !html.contains("<test>"));
    assert!(html.contains("<svg") && html.contains("<circle") && html.contains("15.8 s"));
    let columns = |class: &str| html.matches(&format!("<div class=\"{class}\">")).count();
    assert_eq!((columns("time "), columns("time more")), (6, 24), "one in five frames is always on the page");
    let outside = ["src=\"http", "href=\"http", "src=\"/", "@import", "url("];
    assert!(outside.iter().all(|link| !html.contains(link)));
}

/// A page about one of two cases, beside three recordings: its kilometres a case are those of the recordings.
#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn kilometres_a_case_do_not_depend_on_how_many_cases_are_shown() {
    let dir = tempfile::tempdir().unwrap();
    let (first, case) = recorded(dir.path());
    let mut other = busy_city();
    other.scenario.seed += 1;
    let (second, another) = recorded_in(&other, dir.path(), "b");
    let calm = dir.path().join("calm.mcap");
    fs::write(&calm, record(&busy_city(), 600, ALONE)).unwrap();
    fs::copy(&calm, dir.path().join("calm again.mcap")).unwrap();
    let km = |path: &PathBuf| Recording::open(path).unwrap().log().odometer_mm() as f64 / 1e6;
    let per_case =
        format!("<b>{:.2}</b>km per corner case", [&first, &second, &calm].map(km).iter().sum::<f64>() / 2.0);
    let page =
        |cases: &[PathBuf]| report::render(cases, &[CheckpointChoice::Truth], Some((64, 32)), None).unwrap().html;
    let (one, both) = (page(std::slice::from_ref(&case)), page(&[case, another]));
    assert!(one.contains(&per_case) && both.contains(&per_case), "{per_case}");
    assert!(one.contains("<b>1</b>corner cases shown") && one.contains("<b>2</b>corner cases in these runs"));
    let alone = report::render(&[dir.path().to_owned()], &[CheckpointChoice::Truth], Some((64, 32)), Some(1));
    let three = report::render(&[dir.path().to_owned()], &[CheckpointChoice::Truth], Some((64, 32)), Some(3));
    assert!(alone.unwrap().html == three.unwrap().html, "the page does not depend on the number of threads");
    assert!(one.contains("a selection of them") && !both.contains("a selection of them"));
}

/// Rides through two checkpoints, of which one had the case.
#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn kilometres_a_case_are_those_of_each_checkpoint() {
    let dir = tempfile::tempdir().unwrap();
    let folder = |name: &str| dir.path().join(name);
    [folder("early"), folder("full")].iter().for_each(|folder| fs::create_dir(folder).unwrap());
    let (ridden, _) = recorded(&folder("early"));
    let mut log = Recording::from_bytes(&record(&busy_city(), 600, ALONE)).unwrap().into_log();
    log.manifest.provenance.insert("checkpoint".into(), "full".into());
    fs::write(folder("full").join("a.mcap"), log.encode().unwrap()).unwrap();
    let report = |places: &[PathBuf]| report::render(places, &[CheckpointChoice::Truth], Some((64, 32)), None);
    let page = report(&[folder("full"), folder("early")]).unwrap();
    assert_eq!((page.cases, page.failed), (1, vec![]), "a folder without cases has kilometres");
    let km = Recording::open(&ridden).unwrap().log().odometer_mm() as f64 / 1e6;
    for tile in [format!("<b>{km:.2}</b>km per corner case of these runs (unknown)<"), {
        "<b>-</b>km per corner case of these runs (full)<".to_owned()
    }] {
        assert!(page.html.contains(&tile), "{tile}");
    }
    let (one, none) = (report(&[folder("early"), ridden]), report(&[folder("full")]));
    assert_eq!(one.unwrap().cases, 1, "a recording is no case");
    let said = none.err().expect("nothing to show").to_string();
    assert_eq!(said, "none of the files and folders holds a corner case; expected at least one *.case.mcap");
}
