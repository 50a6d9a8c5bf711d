//! Scenarios, recipes, descriptions of datasets, sidecars, calibrations and answers.

use std::fs;

use base::scenario_file::ScenarioFile;
use lab::dataset::Manifest;
use lab::experiment::{Preset, Recipe};
use lab::map;
use live::units::{calibration, carla};
use perception::{Checkpoint, Metadata};
use proptest::prelude::*;
use study::Questionnaire;

use super::changes::{changed, changes};
use super::{CASES, NATURAL, check, check_files, described};

const SIDECAR: &str = "classes = \"aeye\"\nmean = [0.5, 0.25, 0.125]\nstd = [0.2, 0.3, 0.4]\nlayout = \"nchw\"\n";
const WHEEL: &str =
    "[G29 Racing Wheel]\nsteering_wheel = 0\nclutch = 1\nthrottle = 2\nbrake = 3\nhandbrake = 4\nreverse = 5\n";
const ANSWERS: &str = "[semantic]\nexperience_years = 9\nremark = \"none\"\n\n[semantic.before]\nfatigue = 3\n";

/// A network that comes with the program.
const NETWORK: &[u8] = include_bytes!("../../../../perception/checkpoints/early.onnx");

fn mix() -> String {
    let mix = format!(
        r#"{{"seed":1,"replace":1,"natural":{{"kind":"natural","recipe":{NATURAL}}},"set":"corner-case",
        "cases":{{"kind":"cases","recipe":{CASES}}}}}"#
    );
    described("mix", &mix)
}

#[test]
fn descriptions_of_datasets() {
    let valid = [described("natural", NATURAL), described("cases", CASES), mix()];
    hunt::hunt("dataset", 300, (0..3usize, changes()), |(which, changes)| {
        let damaged = changed(valid[which].as_bytes(), &changes);
        check("damaged.json", &damaged, |path| Manifest::read_file(path).map(drop))
    });
}

#[test]
fn recipes_of_experiments() {
    let valid = Preset::ALL.map(|preset| preset.recipe().expect("valid").to_toml().expect("text"));
    hunt::hunt("recipe", 300, (0..4usize, changes()), |(which, changes)| {
        let damaged = changed(valid[which].as_bytes(), &changes);
        check("damaged.toml", &damaged, |path| Recipe::read(path).map(drop))
    });
}

#[test]
fn sidecars_of_checkpoints() {
    hunt::hunt("sidecar", 300, changes(), |changes| {
        let damaged = changed(SIDECAR.as_bytes(), &changes);
        let files = [("damaged.onnx", NETWORK), ("damaged.toml", damaged.as_slice())];
        check_files(&files, |folder| Ok(Checkpoint::load(folder.join("damaged.onnx")).map(drop)?))
    });
}

#[test]
fn scenarios() {
    let valid = kernel::Scenario::default_for("city", 7).to_toml();
    hunt::hunt("scenario", 300, changes(), |changes| {
        let damaged = changed(valid.as_bytes(), &changes);
        check("damaged.toml", &damaged, |path| {
            let file = ScenarioFile::read(path)?;
            // What is read can be written, and says the same.
            let again = kernel::Scenario::from_toml(&file.scenario.to_toml()).expect("its own text");
            assert_eq!(again, file.scenario);
            Ok(())
        })
    });
}

#[test]
fn maps() {
    let valid = include_str!("../../../maps/cross_lights.xodr");
    hunt::hunt("drawn", 60, changes(), |changes| {
        let damaged = changed(valid.as_bytes(), &changes);
        check("damaged.xodr", &damaged, |path| {
            let file = path.to_str().expect("UTF-8").to_owned();
            let told = map::inspect(&file)?;
            assert!(told.reach.outside_km <= told.reach.km && told.not_understood.iter().all(|group| group.count > 0));
            let folder = tempfile::tempdir().expect("a folder");
            let out = folder.path().join("damaged.svg");
            map::draw(&map::Options { file, size_px: 300, out: out.clone() })?;
            let picture = fs::read_to_string(&out).expect("a text");
            assert!(!picture.contains("NaN") && !picture.contains("inf "), "{picture}");
            Ok(())
        })
    });
}

#[test]
fn calibrations() {
    let valid = live::units::presets::g29().to_toml().expect("a calibration");
    hunt::hunt("calibration", 300, (changes(), any::<i32>()), |(changes, raw)| {
        let damaged = changed(valid.as_bytes(), &changes);
        check("damaged.toml", &damaged, |path| {
            let wheel = calibration::read(path)?;
            assert!((-1.0..=1.0).contains(&wheel.steer(raw)), "{wheel:?} at {raw}");
            assert!((0.0..=1.0).contains(&wheel.throttle.pressed(raw)), "{wheel:?} at {raw}");
            Ok(())
        })
    });
}

#[test]
fn wheels_of_carla() {
    hunt::hunt("wheel", 300, changes(), |changes| {
        let damaged = changed(WHEEL.as_bytes(), &changes);
        check("damaged.ini", &damaged, |path| {
            let text = base::files::read_text(path, base::files::most::TEXT)?;
            carla::import(&text, None).map(drop).map_err(|reason| anyhow::anyhow!("{}: {reason}", path.display()))
        })
    });
}

#[test]
fn questionnaires() {
    hunt::hunt("questionnaire", 300, changes(), |changes| {
        let damaged = changed(ANSWERS.as_bytes(), &changes);
        check("damaged.toml", &damaged, |path| Questionnaire::read(path).map(drop))
    });
}

#[test]
fn what_is_changed_is_valid_before() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("valid");
    let reads = |text: &str, read: &dyn Fn(&std::path::Path) -> bool| {
        fs::write(&path, text).expect("writable");
        assert!(read(&path), "{text}");
    };
    for text in [described("natural", NATURAL), described("cases", CASES), mix()] {
        reads(&text, &|path| Manifest::read_file(path).is_ok());
    }
    reads(ANSWERS, &|path| Questionnaire::read(path).is_ok());
    assert!(carla::import(WHEEL, None).is_ok());
    assert!(Metadata::from_toml(SIDECAR).is_ok());
}
