//! A recording replays bit-exactly, and any run that is not the recorded one is told apart.

use std::sync::LazyLock;

use kernel::Keyframe;
use kernel::world::FieldDifference;
use replay::{Divergence, Error, Log, Recording, Replayer, against, resumes, rewind, verify};
use tests::recordings::{TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::{Scene, busy_city};

static CITY: LazyLock<Scene> = LazyLock::new(busy_city);
static FILE: LazyLock<Vec<u8>> = LazyLock::new(|| record(&CITY, 2000, WITH_TAKEOVER));
static RECORDING: LazyLock<Recording> = LazyLock::new(|| Recording::from_bytes(&FILE).expect("a recording"));

fn log() -> &'static Log {
    RECORDING.log()
}

/// The log with a change, written and read again.
fn rewritten(change: impl FnOnce(&mut Log)) -> Log {
    let mut log = log().clone();
    change(&mut log);
    let bytes = log.encode().expect("a valid log");
    Recording::from_bytes(&bytes).expect("a valid file").into_log()
}

fn divergence(log: &Log) -> Divergence {
    let report = verify(log, &CITY.network).expect("a log that can be simulated");
    report.divergence.expect("the change is found")
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    assert_eq!(record(&CITY, 2000, WITH_TAKEOVER), *FILE);
    assert_eq!(log().encode().expect("a valid log"), *FILE);
}

#[test]
fn every_tick_is_simulated_and_equal() {
    let report = verify(log(), &RECORDING.network().expect("a bundled map")).expect("a log that can be simulated");
    assert_eq!(report.divergence, None);
    assert_eq!(report.ticks, log().last_tick());
    assert!(report.ticks > TAKEOVER && report.keyframes >= 2);
    assert_eq!(log().intervention.map(|i| i.tick), Some(TAKEOVER));
}

#[test]
fn the_run_resumes_from_every_keyframe() {
    let report = resumes(log(), &CITY.network).expect("a log that can be simulated");
    assert_eq!(report.divergence, None);
    assert_eq!((report.ticks, report.keyframes), (log().last_tick(), log().keyframes.len()));
}

#[test]
fn going_back_changes_nothing() {
    for n in [1, 8, 61] {
        let report = rewind(log(), &CITY.network, n).expect("a log that can be simulated");
        assert_eq!(report.divergence, None, "--rewind {n}");
        assert_eq!(report.ticks, log().last_tick());
    }
}

#[test]
fn a_control_changed_by_one_diverges_at_its_tick() {
    for tick in [1, 59, 60, 61, 500, 600, 601, TAKEOVER - 1, TAKEOVER, log().last_tick()] {
        for field in 0..4 {
            let changed = rewritten(|log| {
                let input = &mut log.inputs[tick as usize - 1];
                match field {
                    0 => input.semantic.steer ^= 1,
                    1 => input.semantic.throttle ^= 1,
                    // Without effect: the safety driver's pedal is not listened to unless it brakes.
                    2 => input.safety.throttle ^= 1,
                    _ => input.safety.steer ^= 1,
                }
            });
            let found = divergence(&changed);
            assert_eq!(found.tick, tick, "{found}");
        }
    }
}

#[test]
fn a_control_without_effect_is_named_as_input() {
    let found = divergence(&rewritten(|log| log.inputs[299].safety.throttle += 1));
    assert_eq!((found.tick, found.part.as_str()), (300, "input"), "{found}");
}

#[test]
fn a_control_with_effect_is_followed_to_actor_and_field() {
    let found = divergence(&rewritten(|log| log.inputs[299].semantic.steer += 3000));
    assert_eq!((found.tick, found.seen_at), (300, log().keyframes[1].tick), "{found}");
    assert_ne!(found.field, "hash", "{found}");
    assert_ne!(found.expected, found.got);
}

/// The keyframe with a bit changed in a vehicle, and what must be said about it.
fn with_changed_vehicle(keyframe: &Keyframe) -> (Keyframe, Divergence) {
    let changed = (0..keyframe.bytes.len()).rev().find_map(|at| {
        let mut changed = keyframe.clone();
        changed.bytes[at] ^= 1;
        let field = changed.difference(keyframe).ok()??;
        (field.part == "vehicles" && field.actor.is_some()).then_some((changed, field))
    });
    let (changed, FieldDifference { part, actor, field, expected, got }) = changed.expect("a keyframe with vehicles");
    (changed, Divergence { tick: keyframe.tick, part, actor, field, expected, got, seen_at: keyframe.tick })
}

#[test]
fn an_actor_changed_in_a_keyframe_is_named_with_both_values() {
    for at in 0..log().keyframes.len() {
        let (keyframe, expected) = with_changed_vehicle(&log().keyframes[at]);
        let found = divergence(&rewritten(|log| log.keyframes[at] = keyframe));
        assert_eq!(found, expected);
        assert!(found.actor.is_some() && found.expected != found.got, "{found}");
    }
}

#[test]
fn whatever_else_follows_from_the_run_is_compared() {
    let tick = |change: fn(&mut Log)| divergence(&rewritten(change)).tick;
    assert_eq!(tick(|log| log.marks[3].odometer_mm += 1), log().marks[3].tick);
    assert_eq!(tick(|log| log.marks[3].parts[2] ^= 1), log().marks[3].tick);
    assert_eq!(tick(|log| log.marks[3].hash.0 ^= 1 << 100), log().marks[3].tick);
    assert_eq!(tick(|log| log.events[0].1.speed_mps += 1.0), log().events[0].0);
    assert_eq!(tick(|log| log.hashes[76] ^= 1), 77);
    assert_eq!(tick(|log| drop(log.keyframes.remove(1))), log().keyframes[1].tick);
    assert_eq!(tick(|log| log.summary.as_mut().expect("a summary").odometer_mm += 1), log().last_tick());
    assert_eq!(tick(|log| log.summary.as_mut().expect("a summary").outcome = None), log().last_tick());
}

#[test]
fn two_recordings_are_compared_to_the_exact_field() {
    let same = against(log(), &CITY.network, log(), &CITY.network).expect("two logs");
    assert_eq!((same.divergence, same.ticks), (None, log().last_tick()));
    let changed = rewritten(|log| log.inputs[299].semantic.steer += 3000);
    let found = against(&changed, &CITY.network, log(), &CITY.network).expect("two logs").divergence.expect("differs");
    assert_eq!((found.tick, found.seen_at, found.part.as_str()), (300, 300, "input"), "{found}");
    assert!(found.field.contains("steer"), "{found}");
    assert_eq!(found.expected, log().inputs[299].semantic.steer.to_string());
}

#[test]
fn seeking_gives_the_world_of_that_tick() {
    let mut replayer = Replayer::new(log(), CITY.network.clone()).expect("a log that can be simulated");
    for tick in [700, 650, 30, 599, 600, 601, log().last_tick(), 0] {
        replayer.seek(tick).expect("a tick of the log");
        assert_eq!(replayer.world().tick(), tick);
        if let Some(hash) = log().hash(tick) {
            assert_eq!(replayer.world().hash().0 as u32, hash);
        }
    }
    assert!(matches!(replayer.seek(log().last_tick() + 1), Err(Error::Unsuited(_))));
}

#[test]
fn another_map_or_kernel_is_refused() {
    let other = rewritten(|log| log.manifest.map_digest ^= 1);
    assert!(matches!(verify(&other, &CITY.network), Err(Error::Map { .. })));
    let other = rewritten(|log| log.manifest.kernel = "0.0.0".into());
    assert!(verify(&other, &CITY.network).is_err_and(|e| e.to_string().contains("0.0.0")));
}
