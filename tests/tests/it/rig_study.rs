//! Drives as a study: what recordings say about people, and measures that follow from the log alone.

use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::Cli;
use aeye::exit;
use base::failure::sentence;
use clap::Parser;
use drivers::Driver;
use drivers::checkpoint::CheckpointChoice;
use drivers::safety::{LOOK_TICKS, SafetyBot};
use kernel::arbiter::{Intervention, Outcome, Phase};
use kernel::events::EventKind;
use kernel::{Controls, TickInput, World};
use lab::report;
use measures::{Measures, Tally};
use replay::{Annotation, Case, Label, Manifest, Provenance, Recorder, Recording};
use tests::recordings::{ALONE, TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::{Scene, busy_city, follow_route, scene};

/// Exit code and sentence of a command.
fn aeye(arguments: &[&str]) -> (u8, String) {
    let result = aeye::run(&Cli::try_parse_from([&["aeye"], arguments].concat()).expect("a valid command line"));
    (exit::number(&result), result.err().map(|e| sentence(&e)).unwrap_or_default())
}

fn city(seed: u64) -> Scene {
    let mut scene = busy_city();
    scene.scenario.seed = seed;
    scene
}

/// A recording of a scene, driven tick by tick until it is over.
fn drive(scene: &Scene, mut act: impl FnMut(&World) -> TickInput) -> Recording {
    let manifest = Manifest::new(&scene.scenario, &scene.network, None, Provenance::default());
    let mut world = scene.world();
    let mut recorder = Recorder::new(Vec::new(), &manifest, &world.initial_keyframe()).expect("a new log");
    while world.tick() < 6000 && world.arbiter().phase != Phase::Done {
        let input = act(&world);
        let output = world.step(&input);
        recorder.tick(&input, &output, &world.part_hashes()).expect("the log grows");
    }
    let bytes = recorder.finish(world.arbiter().outcome).expect("the log ends");
    Recording::from_bytes(&bytes).expect("a recording")
}

fn measures(recording: &Recording, scene: &Scene) -> Measures {
    Measures::of(recording.log(), &scene.network).expect("a log that can be simulated")
}

/// The bot's own account of why it took over against what is measured from the log alone.
#[test]
fn a_bot_that_fears_an_encroachment_takes_over_within_a_human_reaction_time() {
    let mut compared = 0;
    for seed in 1..=6 {
        let scene = city(seed);
        let mut bot = SafetyBot::default();
        let recording = drive(&scene, |world| TickInput { safety: bot.controls(world), ..follow_route(world) });
        let (Some(taken), Some(reason)) = (recording.log().intervention, bot.reason()) else { continue };
        if !reason.comment.contains("before contact") {
            continue;
        }
        let measures = measures(&recording, &scene);
        let hazard =
            measures.decisive().unwrap_or_else(|| panic!("seed {seed}: {} is no hazard: {measures:?}", reason.comment));
        let (reaction_ms, onset) = (hazard.intervention_ms.expect("it led to one"), hazard.episode.onset);
        assert_eq!(hazard.safety.reaction_ms, Some(reaction_ms), "seed {seed}");
        assert_eq!((hazard.safety.by, ((taken.tick - onset) * 1000 + 30) / 60), (Some("brake"), reaction_ms));
        // From 0.35 to 2.5 s, and up to a look of 0.1 s before it is noticed.
        assert!((350..=2650).contains(&reaction_ms), "seed {seed}: {reaction_ms} ms");
        compared += 1;
    }
    assert!(compared >= 2, "{compared}");
}

/// An oracle that predicts nothing: what was hit was a hazard, from well before until the collision.
#[test]
fn a_collision_follows_a_hazard() {
    let (mut collisions, mut named, mut steered) = (0, 0, 0);
    for seed in 1..=8 {
        let scene = city(seed);
        let mut stood = 0;
        let recording = drive(&scene, |world| {
            stood = if world.scene().ego.speed_mps < 0.5 { world.tick() } else { stood };
            follow_route(world)
        });
        let log = recording.log();
        if log.summary.as_ref().and_then(|s| s.outcome) != Some(Outcome::Missed) {
            continue;
        }
        let measures = measures(&recording, &scene);
        let last = &measures.hazards.last().expect("a hazard").episode;
        // In the tick of the collision itself they may part again.
        assert!((log.last_tick() - 1..=log.last_tick()).contains(&last.end), "seed {seed}: {last:?}");
        // Or since it moves at all: who stands touches nobody.
        let just_started = last.onset <= stood + 2 * LOOK_TICKS;
        assert!(last.onset + 60 < log.last_tick() || just_started, "seed {seed}: {last:?}");
        let hit =
            log.events.iter().find(|(_, event)| event.kind == EventKind::CollisionActor).expect("somebody was hit");
        named += u32::from(last.what.contains(&format!(" {}, 2.0 s before contact", hit.1.actor)));
        steered += measures.hazards.iter().filter(|hazard| hazard.semantic.by == Some("steering")).count();
        collisions += 1;
    }
    // He follows the route through every curve and sees nobody; once he swings out of a sharp one and steers back.
    assert!(steered <= 1, "{steered} reactions of the wheel");
    // A hazard may begin with one actor and end with another.
    assert!(collisions >= 5 && named + 2 >= collisions, "{named} of {collisions}");
}

#[test]
fn measures_of_a_scripted_takeover_are_those_of_its_script() {
    let scene = busy_city();
    let recording = Recording::from_bytes(&record(&scene, 2000, WITH_TAKEOVER)).expect("a recording");
    let whole = measures(&recording, &scene);
    let age = whole.mask_age.as_ref().expect("masks");
    // A new mask every sixth tick, a picture of the sixth tick before.
    assert_eq!((age.ticks.max, age.ticks.p99, age.ms), (11.0, 11.0, None));
    assert!((8.0..=9.0).contains(&age.ticks.median), "{:?}", age.ticks);
    assert!(whole.hazards.iter().all(|hazard| hazard.episode.onset <= TAKEOVER));
    assert_eq!(whole.steering_reversals_per_min.safety, 0.0);

    // A case knows less of the past; what it knows is the same.
    let window = Case::window(recording.log()).expect("an intervention");
    let case = Case::cut(&recording, &scene.network, window).expect("a case");
    let cut = Measures::of(case.log(), &scene.network).expect("a case can be simulated");
    let known_from = case.log().first_tick() + 60;
    let late = |m: &Measures| m.hazards.iter().filter(|h| h.episode.onset > known_from).cloned().collect::<Vec<_>>();
    assert_eq!(late(&cut), late(&whole));
}

#[test]
fn a_recording_that_was_changed_has_no_measures() {
    let scene = scene("map = \"rural\"\nseed = 7\n");
    let mut log = Recording::from_bytes(&record(&scene, 300, ALONE)).expect("a recording").into_log();
    log.inputs[200].semantic.steer ^= 1;
    assert!(Measures::of(&log, &scene.network).is_err());
}

#[test]
fn an_intervention_that_the_log_does_not_hold_ends_nothing() {
    let scene = scene("map = \"rural\"\nseed = 7\n");
    let recording = Recording::from_bytes(&record(&scene, 300, ALONE)).expect("a recording");
    let mut log = recording.log().clone();
    let (controls, by_brake, by_steering, speed_mps) = (Controls::default(), true, false, 0.0);
    log.intervention = Some(Intervention { tick: 10_000, controls, by_brake, by_steering, speed_mps });
    assert_eq!(Measures::of(&log, &scene.network).expect("ticks are compared"), measures(&recording, &scene));
}

/// A recording with a label, of a drive with the given provenance; the seed tells drives apart.
fn labelled(folder: &Path, seed: u64, label: Label, entries: &[(&str, &str)]) -> String {
    let scene = city(seed);
    let mut log = Recording::from_bytes(&record(&scene, TAKEOVER + 30, WITH_TAKEOVER)).expect("a recording").into_log();
    log.annotation = Some(Annotation { label, comment: String::new(), perception_caused: None });
    log.manifest.provenance = entries.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let path = folder.join(format!("run-{seed}.mcap"));
    fs::write(&path, log.encode().expect("a log")).expect("writable");
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn boredom_is_counted_over_recordings_that_count_and_cases_only_once() {
    let dir = tempfile::tempdir().expect("a folder");
    let practice = [("familiarisation", "true")];
    let paths = [
        labelled(dir.path(), 1, Label::Boredom, &[]),
        labelled(dir.path(), 2, Label::Walker, &[]),
        labelled(dir.path(), 3, Label::Boredom, &practice),
    ];
    let mut recordings = paths.map(|path| Recording::open(Path::new(&path)).expect("a recording")).to_vec();
    let window = Case::window(recordings[0].log()).expect("an intervention");
    let network = recordings[0].network().expect("bundled");
    let case = Case::cut(&recordings[0], &network, window).expect("a case").encode().expect("a log");
    recordings.push(Recording::from_bytes(&case).expect("a case"));
    // A cut of the case, and one of the recording without its takeover.
    let again = Case::cut(&recordings[3], &network, TAKEOVER - 60..=TAKEOVER).expect("a case").encode().expect("a log");
    recordings.push(Recording::from_bytes(&again).expect("a case"));
    let calm = Case::cut(&recordings[0], &network, 200..=300).expect("a case").encode().expect("a log");
    recordings.push(Recording::from_bytes(&calm).expect("a case"));
    assert!(recordings[5].log().intervention.is_none());
    for _ in 0..recordings.len() {
        recordings.rotate_left(1);
        let tally = Tally::of(recordings.iter().map(|recording| (recording, None)));
        assert_eq!((tally.runs, tally.familiarisation_runs), (2, 1));
        assert_eq!((tally.interventions, tally.labelled, tally.boredom), (2, 2, 1));
        assert_eq!((tally.boredom_share, tally.hazards), (Some(0.5), 0));
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_report_reveals_and_leaves_familiarisation_out() {
    let dir = tempfile::tempdir().expect("a folder");
    let blind = [("blind", "one of 2 checkpoints"), ("checkpoint", "network-x"), ("semantic_name", "P07")];
    let counts = labelled(dir.path(), 1, Label::Boredom, &blind);
    let practice = labelled(dir.path(), 2, Label::Walker, &[("familiarisation", "true")]);
    let case = |file: &String| {
        let recording = Recording::open(file.as_ref()).expect("a recording");
        let window = Case::window(recording.log()).expect("an intervention");
        let case = Case::cut(&recording, &recording.network().expect("bundled"), window).expect("a case");
        let path = base::library::case_path(file.as_ref());
        fs::write(&path, case.encode().expect("a log")).expect("writable");
        path
    };
    let (counts, practice) = (case(&counts), case(&practice));
    let render = |files: &[&PathBuf]| {
        let files: Vec<_> = files.iter().map(|file| file.to_path_buf()).collect();
        report::render(&files, &[CheckpointChoice::Truth], Some((64, 32)), None)
    };
    let html = render(&[&counts, &practice]).expect("a page").html;
    for words in ["network-x, and the drivers did not know it", "P07", "1 of 1", "takeovers out of boredom", "Mask age"]
    {
        assert!(html.contains(words), "{words}");
    }
    assert_eq!(html.matches("<h2 id=").count(), 1);
    assert_eq!(html.matches("<b>1</b>runs").count(), 1);
    let error = render(&[&practice]).err().expect("nothing is left");
    assert!(error.to_string().contains("no case is left"), "{error}");
}

#[test]
fn answers_are_attached_beside_a_recording_and_never_to_another() {
    let dir = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| {
        let path = dir.path().join(name);
        fs::write(&path, text).expect("writable");
        path.to_str().expect("UTF-8").to_owned()
    };
    let first = labelled(dir.path(), 1, Label::Walker, &[("questionnaire.safety.before.stress", "2")]);
    let second = labelled(dir.path(), 2, Label::Walker, &[]);
    let bytes = fs::read(&first).expect("there");
    let after = file("after.toml", "[safety.after]\nstress = 6\n[semantic]\nremark = \"tired\"\n");
    let wrong = file("wrong.toml", "[safety.after]\nstress = 60\n");
    let other = file("other.toml", "[safety.before]\nstress = 3\n");

    let (code, sentence) = aeye(&["questionnaire", &first, "--answers", &wrong]);
    assert!(code == 1 && sentence.contains("wrong.toml: safety.after.stress is 60"), "{sentence}");
    let (code, sentence) = aeye(&["questionnaire", &second, &first, "--answers", &other]);
    assert!(code == 1 && sentence.contains("run-1.mcap: safety.before.stress is 3"), "{sentence}");
    let beside = dir.path().join("run-1.questionnaire.toml");
    assert!(!beside.exists() && !dir.path().join("run-2.questionnaire.toml").exists(), "all or nothing");

    let swapped = labelled(dir.path(), 3, Label::Walker, &[("seats_swapped", "true")]);
    let (code, sentence) = aeye(&["questionnaire", &second, &swapped, "--answers", &after]);
    assert!(code == 1 && sentence.contains("run-3.mcap: the operators had swapped seats"), "{sentence}");
    assert_eq!(aeye(&["questionnaire", &swapped, "--answers", &after]), (0, String::new()));

    assert_eq!(aeye(&["questionnaire", &first, "--answers", &after]), (0, String::new()));
    assert_eq!(fs::read(&first).expect("there"), bytes, "the recording is as it was");
    let recording = Recording::open(Path::new(&first)).expect("a recording");
    let answers = study::answers_of(Path::new(&first), &recording).expect("valid");
    let answers: Vec<String> = answers.answers().map(|(key, answer)| format!("{key} {answer}")).collect();
    assert_eq!(answers, ["safety.after.stress 6", "safety.before.stress 2", "semantic.remark tired"]);
    assert_eq!(aeye(&["inspect", &first]).0, 0);

    fs::copy(&beside, dir.path().join("run-2.questionnaire.toml")).expect("copied");
    let (code, sentence) = aeye(&["inspect", &second]);
    assert!(code == 1 && sentence.contains("run-2.questionnaire.toml: is about another recording"), "{sentence}");
}
