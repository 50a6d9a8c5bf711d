//! Recordings of the shared scenes.

use std::fs;
use std::path::{Path, PathBuf};

use kernel::arbiter::{Outcome, Phase};
use kernel::time::Tick;
use kernel::{Controls, Seat, TickInput, World};
use replay::{Annotation, Case, Label, Manifest, MaskShown, Note, NoteKind, Provenance, Recorder, Recording};

use crate::scenes::{Scene, busy_city, follow_route};

/// How a run is driven: the controls of the next tick.
pub type Script = fn(&World) -> TickInput;

/// The route is followed; there is no safety driver.
pub const ALONE: Script = follow_route;

/// As [`ALONE`], and the safety driver brakes at tick [`TAKEOVER`].
pub const WITH_TAKEOVER: Script = |world| {
    let braking = world.tick() + 1 >= TAKEOVER;
    TickInput { safety: Controls::from_fractions(0.0, 0.0, f32::from(u8::from(braking))), ..follow_route(world) }
};

/// As [`WITH_TAKEOVER`], soon after the run is armed.
pub const WITH_TAKEOVER_SOON: Script = |world| {
    let braking = world.tick() >= 200;
    TickInput { safety: Controls::from_fractions(0.0, 0.0, f32::from(u8::from(braking))), ..follow_route(world) }
};

/// The tick of the intervention in [`WITH_TAKEOVER`].
pub const TAKEOVER: Tick = 950;

/// The file of a run of `ticks` ticks, or of fewer if it ends before.
pub fn record(scene: &Scene, ticks: Tick, script: Script) -> Vec<u8> {
    write(scene, ticks, script, &[])
}

/// As [`record`], with notes as well: a file with something of everything.
pub fn record_all(scene: &Scene, ticks: Tick, script: Script) -> Vec<u8> {
    let note = |tick, kind| Note { tick, kind, seat: Some(Seat::Safety) };
    write(scene, ticks, script, &[note(1, NoteKind::UnitBound), note(40, NoteKind::UnitArmed)])
}

fn write(scene: &Scene, ticks: Tick, script: Script, notes: &[Note]) -> Vec<u8> {
    let mut world = scene.world();
    let mut recorder = Recorder::new(Vec::new(), &manifest(scene), &world.initial_keyframe()).expect("a new log");
    notes.iter().for_each(|note| recorder.note(*note).expect("in order"));
    while world.tick() < ticks && world.arbiter().phase != Phase::Done {
        recorder.mask_shown(mask_at(world.tick() + 1)).expect("in order");
        let input = script(&world);
        let output = world.step(&input);
        recorder.tick(&input, &output, &world.part_hashes()).expect("the log grows");
    }
    let outcome = world.arbiter().outcome;
    if outcome == Some(Outcome::Intervened) {
        let label = Label::Vehicle;
        recorder.annotate(Annotation { label, comment: "as scripted".into(), perception_caused: None });
    }
    recorder.finish(outcome).expect("the log ends")
}

fn manifest(scene: &Scene) -> Manifest {
    let provenance: Provenance = [("semantic".to_owned(), "script".to_owned())].into();
    Manifest::new(&scene.scenario, &scene.network, None, provenance)
}

/// A new mask every sixth tick, one frame old.
fn mask_at(tick: Tick) -> MaskShown {
    let tick_of_frame = (tick / 6 * 6).saturating_sub(6);
    let digest = (tick_of_frame + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    MaskShown { tick_shown: tick, tick_of_frame, camera: 0, digest, times: None }
}

/// Writes a recording of the city whose safety driver brakes, and the case cut from it.
pub fn recorded(folder: &Path) -> (PathBuf, PathBuf) {
    recorded_in(&busy_city(), folder, "a")
}

/// The same in any scene, as `NAME.mcap` and `NAME.case.mcap`.
pub fn recorded_in(scene: &Scene, folder: &Path, name: &str) -> (PathBuf, PathBuf) {
    let run = record(scene, TAKEOVER + 60, WITH_TAKEOVER);
    let mut log = Recording::from_bytes(&run).expect("a recording").into_log();
    let comment = "a <test>".into();
    log.annotation = Some(Annotation { label: Label::Rules, comment, perception_caused: None });
    let (path, case_path) = (folder.join(format!("{name}.mcap")), folder.join(format!("{name}.case.mcap")));
    fs::write(&path, log.encode().expect("a log")).expect("written");
    let recording = Recording::open(&path).expect("a recording");
    let window = Case::window(recording.log()).expect("an intervention");
    let case = Case::cut(&recording, &scene.network, window).expect("a case");
    fs::write(&case_path, case.encode().expect("a log")).expect("written");
    (path, case_path)
}
