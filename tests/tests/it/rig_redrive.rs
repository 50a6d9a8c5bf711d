//! Counterfactuals: forks are functions of the case, share its past, and are recordings like any other.

use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::{Cli, Command, RedriveArgs};
use aeye::commands::redrive;
use base::failure::sentence;
use base::progress::Interrupt;
use clap::Parser;
use drivers::checkpoint::CheckpointChoice;
use drivers::simulate::FORK_AFTER_TICKS;
use drivers::vision::{Eye, Vision};
use kernel::Controls;
use kernel::arbiter::Outcome;
use lab::redrive::Counterfactual;
use measures::Criticality;
use render::{AdapterChoice, Renderer};
use replay::{Case, Recording, verify};
use serde_json::Value;
use tests::files::contents;
use tests::recordings::{ALONE, TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::busy_city;

/// A case of the city, said to be driven with true masks, in a folder.
fn case(folder: &Path) -> PathBuf {
    let mut scene = busy_city();
    // The run would have ended within a second of the takeover: a fork goes on all the same.
    scene.scenario.rules.max_seconds = TAKEOVER as u32 / 60 + 1;
    let mut log = Recording::from_bytes(&record(&scene, TAKEOVER + 60, WITH_TAKEOVER)).unwrap().into_log();
    log.manifest.provenance.insert("checkpoint_digest".into(), "truth".into());
    let recording = Recording::from_bytes(&log.encode().unwrap()).unwrap();
    let window = Case::window(recording.log()).expect("an intervention");
    let path = folder.join("a.case.mcap");
    fs::write(&path, Case::cut(&recording, &scene.network, window).unwrap().encode().unwrap()).unwrap();
    path
}

fn args(file: PathBuf, checkpoint: Option<CheckpointChoice>, out: PathBuf) -> RedriveArgs {
    let without_intervention = checkpoint.is_none();
    RedriveArgs {
        files: vec![file],
        without_intervention,
        checkpoint,
        recorded: vec![],
        reveal: false,
        vary: 1,
        seconds: 4,
        jobs: None,
        models: Default::default(),
        shard: None,
        out,
    }
}

/// Whether perception caused a takeover, whether it was needed, and `aeye redrive` ask of the same time.
#[test]
fn every_fork_goes_on_for_the_same_time() {
    let line = ["aeye", "redrive", "a.case.mcap", "--without-intervention", "--out", "forks"];
    let Command::Redrive(args) = Cli::try_parse_from(line).expect("a valid command line").command else {
        panic!("another command");
    };
    assert_eq!((u64::from(args.seconds) * 60, FORK_AFTER_TICKS), (600, 600));
}

fn lines(out: &Path) -> Vec<Value> {
    let text = fs::read_to_string(out.join("redrive.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn without_the_intervention_the_past_is_the_same_and_the_fork_is_made_again() {
    let dir = tempfile::tempdir().unwrap();
    let path = case(dir.path());
    let case = Recording::open(&path).unwrap();
    // The last call finds the forks of the one before.
    for name in ["first", "second", "second"] {
        redrive::run(&args(path.clone(), None, dir.path().join(name)), true).unwrap();
    }
    let read = |name: &str, file: &str| fs::read(dir.path().join(name).join(file)).unwrap();
    for file in ["a.fork.mcap", "a.fork-1.mcap", "redrive.jsonl"] {
        assert_eq!(read("first", file), read("second", file), "{file}");
    }
    for (line, earlier) in lines(&dir.path().join("first")).iter().zip([0, 6]) {
        let fork_tick = TAKEOVER - earlier;
        assert_eq!(line["fork_tick"], fork_tick);
        let fork = Recording::open(&dir.path().join("first").join(line["recording"].as_str().unwrap())).unwrap();
        assert_eq!(verify(fork.log(), &case.network().unwrap()).unwrap().divergence, None);
        let first = fork.log().first_tick();
        assert!(first + 180 <= fork_tick, "{first}");
        for tick in first + 1..fork_tick {
            assert_eq!(fork.log().input(tick), case.log().input(tick));
        }
        // All parts but the first, which names the scenario: the fork's lasts longer.
        let marks: Vec<_> = fork.log().marks.iter().filter(|mark| mark.tick < fork_tick).collect();
        assert!(marks.len() >= 3, "{marks:?}");
        for mark in marks {
            assert_eq!(case.log().mark(mark.tick).map(|recorded| &recorded.parts[1..]), Some(&mark.parts[1..]));
        }
        assert_ne!(case.log().input(TAKEOVER).unwrap().safety, Controls::default());
        let missed = fork.log().summary.as_ref().unwrap().outcome == Some(Outcome::Missed);
        assert!(missed || fork.log().last_tick() == TAKEOVER + 4 * 60, "{}", fork.log().last_tick());
        assert_eq!(missed, !line["collision"].is_null());
        let rest = fork_tick..=fork.log().last_tick();
        let closest = Criticality::of(fork.log(), &case.network().unwrap(), rest.clone()).unwrap().extremes;
        let written: Value = serde_json::from_str(&serde_json::to_string(&closest).unwrap()).unwrap();
        assert_eq!(line["closest"], written);
        assert!(
            rest.clone().count() > 10
                && rest.clone().all(|t| fork.log().input(t).unwrap().safety == Controls::default())
        );
        assert_eq!(fork.log().intervention, None);
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn through_another_checkpoint_the_verdict_is_what_the_recording_shows() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    redrive::run(&args(case(dir.path()), Some(CheckpointChoice::Truth), out.clone()), true).unwrap();
    let line = &lines(&out)[0];
    let fork = Recording::open(&out.join("a.fork.mcap")).unwrap();
    assert_eq!(verify(fork.log(), &fork.network().unwrap()).unwrap().divergence, None);
    assert_eq!(line["intervention_again"].as_u64(), fork.log().intervention.map(|i| i.tick));
    assert_eq!(line["verdict"] == "again", fork.log().intervention.is_some() || !line["collision"].is_null());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn what_cannot_be_driven_again_is_said_and_leaves_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let (calm, unknown) = (dir.path().join("calm.mcap"), dir.path().join("unknown.mcap"));
    fs::write(&calm, record(&busy_city(), 300, ALONE)).unwrap();
    fs::write(&unknown, record(&busy_city(), TAKEOVER + 60, WITH_TAKEOVER)).unwrap();
    for (file, words) in
        [(calm, "calm.mcap: holds no intervention"), (unknown, "unknown.mcap: does not say through which")]
    {
        let out = dir.path().join("out");
        let said = format!("{:#}", redrive::run(&args(file, None, out.clone()), true).unwrap_err());
        assert!(said.starts_with(dir.path().to_str().unwrap()) && said.contains(words), "{said}");
        assert!(!out.exists());
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_counterfactual_is_kept_for_its_recording_alone() {
    let dir = tempfile::tempdir().unwrap();
    let case = Recording::open(&case(dir.path())).unwrap();
    let network = case.network().unwrap();
    let vision = Vision::new(Renderer::new(&network, &AdapterChoice::default()).unwrap(), Eye::Truth);
    let (found, vision) = Counterfactual::of(&case, &network, vision).unwrap();
    assert_eq!(found.harm.is_some(), found.harm_after_s.is_some());
    assert_eq!(Counterfactual::of(&case, &network, vision).unwrap().0, found);

    let path = dir.path().join("a.counterfactual.json");
    assert_eq!(Counterfactual::read(&path, &case).unwrap(), None);
    fs::write(&path, found.encode().unwrap()).unwrap();
    assert_eq!(Counterfactual::read(&path, &case).unwrap(), Some(found));
    let mut log = case.log().clone();
    log.manifest.provenance.insert("remark".into(), "another".into());
    let another = Recording::from_bytes(&log.encode().unwrap()).unwrap();
    assert_eq!(Counterfactual::read(&path, &another).unwrap(), None);
    fs::write(&path, "{").unwrap();
    assert_eq!(Counterfactual::read(&path, &case).unwrap(), None);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn forks_that_were_interrupted_go_on_and_are_never_those_of_other_options() {
    let dir = tempfile::tempdir().unwrap();
    let (path, out, whole) = (case(dir.path()), dir.path().join("out"), dir.path().join("whole"));
    let options = |out: &Path| lab::redrive::Options {
        files: vec![path.clone()],
        without_intervention: true,
        checkpoint: None,
        recorded: vec![],
        reveal: false,
        vary: 3,
        seconds: 1,
        jobs: None,
        out: out.to_owned(),
    };
    let interrupt = Interrupt::default();
    let first = out.join("a.fork.mcap");
    let interrupted = std::thread::scope(|scope| {
        let driving = scope.spawn(|| lab::redrive::redrive(&options(&out), &interrupt));
        while !first.exists() && !driving.is_finished() {
            std::thread::yield_now();
        }
        interrupt.raise();
        driving.join().unwrap()
    });
    let said = sentence(&interrupted.expect_err("three forks are left"));
    assert!(said.contains("interrupted; the same command goes on from there"), "{said}");
    assert!(!out.join("a.fork-3.mcap").exists() && !out.join("redrive.jsonl").exists());
    let driven = fs::metadata(&first).unwrap().modified().unwrap();
    lab::redrive::redrive(&options(&out), &Interrupt::default()).unwrap();
    lab::redrive::redrive(&options(&whole), &Interrupt::default()).unwrap();
    assert_eq!(fs::metadata(&first).unwrap().modified().unwrap(), driven, "what is whole is kept");
    let visible = |folder: &Path| {
        let mut files = contents(folder);
        files.retain(|path, _| !path.starts_with(".redrive"));
        files
    };
    let kept = contents(&out);
    assert!(visible(&out).len() == 5 && visible(&out) == visible(&whole));

    let other = lab::redrive::Options { vary: 1, ..options(&out) };
    let through = lab::redrive::Options {
        checkpoint: Some(CheckpointChoice::Truth),
        without_intervention: false,
        ..options(&out)
    };
    for (options, held, asked) in [
        (other, "holds results of --vary 3; expected", "another folder for --vary 1"),
        (through, "holds results of --without-intervention; expected", "another folder for --checkpoint truth"),
    ] {
        let said = sentence(&lab::redrive::redrive(&options, &Interrupt::default()).unwrap_err());
        assert!(said.contains(held) && said.contains(asked), "{said}");
    }
    assert!(contents(&out) == kept, "what is there stays");
}
