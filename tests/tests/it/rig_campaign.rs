//! A campaign is a function of its arguments: not of the number of jobs, nor of interruptions. A drive
//! that is killed leaves what it said.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;

use base::maps::Map;
use base::progress::Interrupt;
use drivers::simulate;
use drivers::vision::{Eye, Vision};
use lab::campaign::{Plan, RunLine, Task, Until, drive_all};
use lab::share::Share;
use render::{AdapterChoice, Renderer};
use replay::Recording;

fn plan(out: &Path) -> Plan {
    let maps = Map::find_all(&["all".to_owned()]).expect("bundled maps");
    Plan {
        maps,
        scenario: None,
        vary: false,
        pedestrians: None,
        hazards: None,
        weather: None,
        run_seconds: 10,
        seed: 5,
        goal: Until::Runs(2).into(),
        out: out.to_owned(),
    }
}

fn drive(out: &Path, jobs: usize) -> Vec<RunLine> {
    drive_as(&plan(out), jobs).expect("a campaign")
}

fn drive_as(plan: &Plan, jobs: usize) -> anyhow::Result<Vec<RunLine>> {
    drive_through(plan, jobs, &[Eye::Truth]).map(|mut lines| lines.remove(0))
}

fn drive_through(plan: &Plan, jobs: usize, eyes: &[Eye]) -> anyhow::Result<Vec<Vec<RunLine>>> {
    let interrupt = &Interrupt::default();
    drive_all(&Task { plan, share: Share::WHOLE, adapters: &[], jobs, interrupt }, eyes)
}

fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a readable folder").map(|e| e.expect("an entry"));
    entries.map(|e| (e.file_name().to_string_lossy().into_owned(), fs::read(e.path()).expect("a file"))).collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn jobs_and_interruptions_do_not_change_a_campaign() {
    let dir = tempfile::tempdir().expect("a folder");
    let (one, two) = (dir.path().join("one"), dir.path().join("two"));
    fs::create_dir_all(&one).expect("writable");
    fs::create_dir_all(&two).expect("writable");
    let eyes = [Eye::Truth, Eye::open(&"early".parse().expect("a name")).expect("it is bundled")];
    let drive = |out: &Path, jobs| drive_through(&plan(out), jobs, &eyes).expect("a campaign");
    let lines = drive(&one, 1);
    assert_eq!(lines.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    assert_eq!(lines, drive(&two, 3), "who has no run left goes on with the next checkpoint");
    let whole = contents(&one);
    assert!(whole.len() >= 4 && whole == contents(&two));

    lines.iter().for_each(|lines| fs::remove_file(one.join(&lines[1].file)).expect("it was there"));
    assert_eq!(lines, drive(&one, 2));
    assert_eq!(whole, contents(&one));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn runs_that_do_not_count_leave_nothing_behind() {
    let dir = tempfile::tempdir().expect("a folder");
    // The first run is enough, but others are driven beside it until that is known.
    let plan = Plan { goal: Until::Km(0.01).into(), ..plan(dir.path()) };
    let lines = drive_as(&plan, 3).expect("a campaign");
    assert_eq!(lines.len(), 1);
    let names: Vec<String> = contents(dir.path()).into_keys().filter(|name| !name.contains("-0000.")).collect();
    assert!(names.is_empty(), "{names:?}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn runs_that_were_done_before_their_turn_are_not_driven_again() {
    let dir = tempfile::tempdir().expect("a folder");
    let lines = drive(dir.path(), 1);
    let (whole, waiting) = (contents(dir.path()), dir.path().join(".waiting/truth"));
    let at = |name: &str| dir.path().join(name);
    // As a kill leaves it that comes before the first run is done.
    let wait = |name: &String| fs::rename(at(name), waiting.join(name)).expect("it was there");
    let modified = |path: &Path| fs::metadata(path).and_then(|about| about.modified()).expect("a file");
    fs::create_dir_all(&waiting).expect("writable");
    whole.keys().filter(|name| name.contains("-0001.")).for_each(wait);
    fs::remove_file(at(&lines[0].file)).expect("it was there");
    let when = modified(&waiting.join(&lines[1].file));
    assert_eq!(drive(dir.path(), 2), lines);
    assert_eq!(contents(dir.path()), whole, "nothing waits any more");
    assert_eq!(modified(&at(&lines[1].file)), when, "it is the same file");

    // Of another campaign, they are none of this one's.
    let other = Plan { seed: 6, ..plan(dir.path()) };
    fs::create_dir_all(&waiting).expect("writable");
    whole.keys().for_each(wait);
    let others = drive_as(&other, 1).expect("a campaign");
    assert!(others.iter().zip(&lines).all(|(other, line)| other.figures.seed != line.figures.seed));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn recordings_of_another_campaign_are_not_taken_for_this_one() {
    let dir = tempfile::tempdir().expect("a folder");
    drive(dir.path(), 1);
    let other = Plan { seed: 6, ..plan(dir.path()) };
    let error = drive_as(&other, 1).expect_err("another seed");
    assert!(error.to_string().contains("another campaign"), "{error}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_run_that_is_cut_off_is_told_and_driven_again_when_it_is_gone() {
    let dir = tempfile::tempdir().expect("a folder");
    let whole = drive(dir.path(), 1);
    let path = dir.path().join(&whole[0].file);
    let bytes = fs::read(&path).expect("a recording");
    fs::write(&path, &bytes[..bytes.len() - 9]).expect("writable");
    let error = drive_as(&plan(dir.path()), 1).expect_err("cut off").to_string();
    assert!(error.starts_with(path.to_str().expect("UTF-8")) && error.contains("is cut off"), "{error}");
    fs::remove_file(&path).expect("there");
    assert_eq!(drive(dir.path(), 1), whole);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn at_any_moment_the_file_holds_all_but_the_last_second() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("run.mcap");
    let map = Map::find("rural").expect("bundled");
    let mut scenario = map.scenario(3);
    scenario.rules.max_seconds = 8;
    let vision = Vision::new(Renderer::new(&map.network, &AdapterChoice::default()).expect("an adapter"), Eye::Truth);
    let file = File::create(&path).expect("writable");
    let mut looked = 0;
    // What a process killed at this moment leaves is what the file system holds now.
    let keep_on = |world: &kernel::World| {
        if world.tick() % 37 == 36 {
            let left = Recording::open(&path).expect("readable at any moment");
            assert!(!left.finished() && left.log().last_tick() + 60 >= world.tick(), "tick {}", world.tick());
            let report = replay::verify(left.log(), &left.network().expect("its map")).expect("a log");
            assert_eq!(report.divergence, None);
            looked += 1;
        }
        true
    };
    simulate::drive(&scenario, &map, vision, file, keep_on).expect("a drive");
    assert!(looked > 5);
    assert!(Recording::open(&path).expect("readable").finished());
}
