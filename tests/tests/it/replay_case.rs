//! A corner case is a small file that stands on its own.

use std::fs;
use std::sync::{Arc, LazyLock};

use kernel::Scenario;
use kernel::map::bake;
use kernel::time::{CLIP_FRAMES, CLIP_STRIDE_TICKS};
use replay::{Case, Error, ForeignMap, Log, Recording, resumes, rewind, verify};
use tests::recordings::{ALONE, TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::{Scene, busy_city, scene};

static CITY: LazyLock<Scene> = LazyLock::new(busy_city);
static RECORDING: LazyLock<Recording> =
    LazyLock::new(|| Recording::from_bytes(&record(&CITY, 2000, WITH_TAKEOVER)).expect("a recording"));

fn cut() -> Case {
    let window = Case::window(RECORDING.log()).expect("an intervention");
    Case::cut(&RECORDING, &CITY.network, window).expect("a case")
}

fn read(bytes: &[u8]) -> Case {
    Case::try_from(Recording::from_bytes(bytes).expect("a valid file")).expect("a case")
}

#[test]
fn a_case_is_at_most_64_kb_with_100_actors() {
    let bytes = cut().encode().expect("a valid log");
    assert_eq!(cut().scenes()[0].actors.len(), 100);
    assert!(bytes.len() <= 64 << 10, "{} bytes", bytes.len());
}

#[test]
fn its_window_is_the_last_three_seconds_up_to_the_intervention() {
    let case = cut();
    let ticks: Vec<u64> = case.scenes().iter().map(|s| s.tick).collect();
    let expected: Vec<u64> =
        (0..u64::from(CLIP_FRAMES)).rev().map(|back| TAKEOVER - back * CLIP_STRIDE_TICKS).collect();
    assert_eq!(ticks, expected);
    assert_eq!((case.info().from, case.info().to, case.info().source), (ticks[0], TAKEOVER, RECORDING.digest()));
    assert!(case.log().first_tick() <= ticks[0] && case.log().last_tick() == RECORDING.log().last_tick());
    assert_eq!(case.log().annotation, RECORDING.log().annotation);
}

#[test]
fn its_scenes_are_those_of_the_live_run() {
    let mut world = CITY.world();
    for scene in cut().scenes() {
        while world.tick() < scene.tick {
            world.step(RECORDING.log().input(world.tick() + 1).expect("a tick of the log"));
        }
        assert_eq!(world.scene(), *scene);
    }
}

#[test]
fn it_opens_and_verifies_as_a_recording_does() {
    let case = cut();
    let bytes = case.encode().expect("a valid log");
    assert_eq!(read(&bytes).log(), case.log());
    for check in [verify, resumes, |log: &Log, network: &_| rewind(log, network, 8)] {
        let report = check(case.log(), &CITY.network).expect("a log that can be simulated");
        assert_eq!(report.divergence, None);
        assert_eq!(report.ticks, case.log().inputs.len() as u64);
    }
}

#[test]
fn a_changed_case_is_told_apart() {
    let mut log = cut().log().clone();
    log.scenes[4].actors[7].position.x += 0.5;
    let found = verify(&log, &CITY.network).expect("a log").divergence.expect("differs");
    assert_eq!((found.tick, found.field.as_str()), (log.scenes[4].tick, "scene.actors[7].position.x"), "{found}");
    let mut log = cut().log().clone();
    log.inputs[100].safety.throttle ^= 1;
    let found = verify(&log, &CITY.network).expect("a log").divergence.expect("differs");
    assert_eq!(found.tick, log.first_tick() + 101);
}

#[test]
fn a_recording_is_no_case_and_a_run_without_intervention_has_none() {
    let recording = Recording::from_bytes(&record(&CITY, 300, ALONE)).expect("a recording");
    assert_eq!(Case::window(recording.log()), None);
    assert!(matches!(Case::try_from(recording), Err(Error::Unsuited(_))));
}

#[test]
fn a_window_beyond_the_recording_is_refused() {
    let last = RECORDING.log().last_tick();
    assert!(Case::cut(&RECORDING, &CITY.network, last..=last + 60).is_err());
}

#[test]
fn a_cut_that_ends_long_before_the_intervention_knows_nothing_of_it() {
    let case = Case::cut(&RECORDING, &CITY.network, 200..=300).expect("a window of the recording");
    let log = case.log();
    assert_eq!((log.intervention, &log.annotation, log.last_tick()), (None, &None, 900));
    let report = verify(log, &CITY.network).expect("a log that can be simulated");
    assert_eq!((report.divergence, case.scenes().len()), (None, 17));
}

/// A recording on a map that is not bundled: the rural one under another name.
fn on_a_foreign_map(embedded: bool) -> (Log, ForeignMap) {
    let text = include_str!("../../../kernel/maps/rural.xodr");
    let network = Arc::new(bake("elsewhere", text).expect("a map"));
    let scenario = Scenario { map: "elsewhere".into(), ..scene("map = \"rural\"\nseed = 3\n").scenario };
    let recording = Recording::from_bytes(&record(&Scene { scenario, network }, 20, ALONE)).expect("a recording");
    let map = ForeignMap::new(text, embedded);
    let mut log = recording.into_log();
    log.manifest.foreign_map = Some(map.clone());
    (log, map)
}

#[test]
fn a_foreign_map_travels_in_the_log_or_beside_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("drive.mcap");
    let written = |embedded| {
        let (log, map) = on_a_foreign_map(embedded);
        fs::write(&path, log.encode().expect("a log")).expect("written");
        map
    };
    let open = || Recording::open(&path).expect("a recording");

    let map = written(true);
    let bytes = fs::metadata(&path).expect("a file").len();
    assert_eq!(open().network().expect("its map").name, "elsewhere");

    written(false);
    assert!(fs::metadata(&path).expect("a file").len() + 4000 < bytes, "the map is not in it");
    let said = open().network().expect_err("its map is absent").to_string();
    assert_eq!(said, format!("its map elsewhere is not in it, and {} is not beside it", map.file_name()));

    let beside = folder.path().join(map.file_name());
    fs::write(&beside, map.text.as_deref().expect("a text")).expect("written");
    let recording = open();
    let report = verify(recording.log(), &recording.network().expect("its map")).expect("a log");
    assert_eq!((report.divergence, report.ticks), (None, 20));

    fs::write(&beside, "<OpenDRIVE/>").expect("written");
    let said = Recording::open(&path).expect_err("another map").to_string();
    assert!(said.ends_with("not the map of the recording: it was changed"), "{said}");
}

#[test]
fn a_map_that_is_no_map_or_unknown_is_an_error() {
    let mut log = RECORDING.log().clone();
    log.manifest.foreign_map = Some(ForeignMap::new("<OpenDRIVE>", true));
    let broken = Recording::from_bytes(&log.encode().expect("a valid log")).expect("a valid file");
    assert!(matches!(broken.network(), Err(Error::Bake(_))));
    log.manifest.foreign_map = None;
    log.manifest.scenario = Scenario { map: "nowhere".into(), ..log.manifest.scenario };
    let lost = Recording::from_bytes(&log.encode().expect("a valid log")).expect("a valid file");
    assert!(lost.network().is_err_and(|e| e.to_string().contains("nowhere")));
    assert!(bake("nothing", "").is_err());
}
