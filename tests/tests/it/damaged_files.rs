//! Every file that people hand to the program may be damaged: it is read, or refused in one sentence that names
//! it. Nothing panics, ends the program or takes more memory than its limit. `PROPTEST_CASES` says how many are tried.

use std::fs;
use std::path::Path;

use base::failure::sentence;
use base::maps::ScenarioFile;
use base::png;
use lab::dataset::Manifest;
use live::units::{calibration, carla};
use perception::Checkpoint;
use proptest::collection::vec;
use proptest::prelude::*;
use study::Questionnaire;

/// What is put into texts: numbers at which things break, and signs that mean something.
const ODD: [&str; 22] = [
    "0",
    "-1",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "1e999",
    "nan",
    "inf",
    "null",
    "\"../../x\"",
    "\"\"",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "\\",
    "\n",
    "=",
    "\0",
    "\u{202e}",
];

/// A change of a file: where, how much of it goes, and what comes instead.
type Change = (u16, u8, Option<prop::sample::Index>, u8);

fn changes() -> impl Strategy<Value = Vec<Change>> {
    vec((any::<u16>(), 0..20u8, any::<Option<prop::sample::Index>>(), any::<u8>()), 0..6)
}

fn changed(valid: &[u8], changes: &[Change]) -> Vec<u8> {
    let mut bytes = valid.to_vec();
    for (at, gone, odd, byte) in changes {
        let from = usize::from(*at) % (bytes.len() + 1);
        let to = (from + usize::from(*gone)).min(bytes.len());
        let with = odd.map_or(vec![*byte], |odd| odd.get(&ODD).as_bytes().to_vec());
        bytes.splice(from..to, with);
    }
    bytes
}

/// Reads a changed file; an error must be one sentence that names it.
fn try_out(valid: &[u8], changes: &[Change], ending: &str, read: impl Fn(&Path) -> anyhow::Result<()>) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(format!("damaged.{ending}"));
    fs::write(&path, changed(valid, changes)).expect("writable");
    if let Err(error) = read(&path) {
        let text = sentence(&error);
        assert!(text.contains("damaged") && text.chars().all(|c| !c.is_control()), "{text:?}");
    }
}

/// A dataset's description with a recipe.
fn described(kind: &str, recipe: &str) -> String {
    format!(
        r#"{{"kind":"{kind}","recipe":{recipe},"kernel":"1","renderer":"1","adapter":"a","train_frames":4,"val_frames":1,
        "test_frames":1,"pedestrian_pixels":1.5,"classes":["road"],"labels_digest":"ab","digest":"cd"}}"#
    )
}

const NATURAL: &str = r#"{"seed":1,"scenes":2,"val_scenes":1,"test_scenes":1,"frames":2,"test_frames":2,
    "size":[256,128],"pedestrians":null,"maps":[{"name":"city","digest":"ab"}]}"#;
const CASES: &str = r#"{"split":"train","size":[256,128],"cases":[{"name":"a","digest":"ab","recording":"cd","to":180,
    "map":"city","seed":7,"label":"pedestrian"}]}"#;
const SIDECAR: &str = "classes = \"aeye\"\nmean = [0.5, 0.25, 0.125]\nstd = [0.2, 0.3, 0.4]\nlayout = \"nchw\"\n";
const WHEEL: &str =
    "[G29 Racing Wheel]\nsteering_wheel = 0\nclutch = 1\nthrottle = 2\nbrake = 3\nhandbrake = 4\nreverse = 5\n";
const ANSWERS: &str = "[semantic]\nexperience_years = 9\nremark = \"none\"\n\n[semantic.before]\nfatigue = 3\n";

proptest! {
    #[test]
    fn pictures(changes in changes(), samples in 1..4usize, is_plain in any::<bool>()) {
        let colours: Vec<u8> = (0..3 * 16 * 8).map(|i| i as u8).collect();
        let valid = [png::rgb((16, 8), &colours), png::tags((16, 8), &colours[..16 * 8])];
        for valid in valid {
            let damaged = changed(&valid.expect("a picture"), &changes);
            let damaged = if is_plain { damaged } else { with_checksums(damaged) };
            try_out(&damaged, &[], "png", |path| png::read(path, samples).map(drop));
        }
    }

    #[test]
    fn recipes_of_datasets(changes in changes()) {
        let natural = described("natural", NATURAL);
        let mix = format!(
            r#"{{"seed":1,"replace":1,"natural":{{"kind":"natural","recipe":{NATURAL}}},"set":"corner-case",
            "cases":{{"kind":"cases","recipe":{CASES}}}}}"#
        );
        for valid in [natural, described("cases", CASES), described("mix", &mix)] {
            try_out(valid.as_bytes(), &changes, "json", |path| Manifest::read_file(path).map(drop));
        }
    }

    #[test]
    fn sidecars_of_checkpoints(changes in changes()) {
        let network = perception_network();
        try_out(SIDECAR.as_bytes(), &changes, "toml", |path| {
            fs::write(path.with_extension("onnx"), network)?;
            Ok(Checkpoint::load(path.with_extension("onnx")).map(drop)?)
        });
    }

    #[test]
    fn scenarios(changes in changes()) {
        let valid = kernel::Scenario::default_for("city", 7).to_toml();
        try_out(valid.as_bytes(), &changes, "toml", |path| ScenarioFile::read(path).map(drop));
    }

    #[test]
    fn calibrations(changes in changes(), raw in any::<i32>()) {
        let valid = live::units::presets::g29().to_toml().expect("a calibration");
        try_out(valid.as_bytes(), &changes, "toml", |path| {
            let wheel = calibration::read(path)?;
            assert!((-1.0..=1.0).contains(&wheel.steer(raw)), "{wheel:?} at {raw}");
            assert!((0.0..=1.0).contains(&wheel.throttle.pressed(raw)), "{wheel:?} at {raw}");
            Ok(())
        });
    }

    #[test]
    fn wheels_of_carla(changes in changes()) {
        try_out(WHEEL.as_bytes(), &changes, "ini", |path| {
            let text = base::files::read_text(path, base::files::most::TEXT)?;
            carla::import(&text, None).map(drop).map_err(|reason| anyhow::anyhow!("{}: {reason}", path.display()))
        });
    }

    #[test]
    fn questionnaires(changes in changes()) {
        try_out(ANSWERS.as_bytes(), &changes, "toml", |path| Questionnaire::read(path).map(drop));
    }
}

/// A network that comes with the program.
fn perception_network() -> &'static [u8] {
    include_bytes!("../../../perception/checkpoints/early.onnx")
}

#[test]
fn what_is_changed_is_valid_before() {
    let read = |text: String| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("valid");
        fs::write(&path, text).expect("writable");
        (Manifest::read_file(&path).is_ok(), Questionnaire::read(&path).is_ok())
    };
    assert!(read(described("natural", NATURAL)).0 && read(described("cases", CASES)).0);
    assert!(read(ANSWERS.into()).1);
    assert!(carla::import(WHEEL, None).is_ok());
    assert!(perception::Metadata::from_toml(SIDECAR).is_ok());
}

#[test]
fn pictures_that_claim_more_than_they_hold_are_refused() {
    let mut file = png::rgb((4, 4), &[0; 48]).expect("a picture");
    // Width and height.
    for (at, side) in [(16, 60_000u32), (20, 60_000)] {
        file[at..at + 4].copy_from_slice(&side.to_be_bytes());
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("claims.png");
    fs::write(&path, with_checksums(file)).expect("writable");
    let said = sentence(&png::read(&path, 3).expect_err("it is refused"));
    assert!(said.contains("claims.png: 60000x60000; expected at most"), "{said}");
}

/// A picture whose parts all have their checksums again, so that more than these is looked at.
fn with_checksums(mut file: Vec<u8>) -> Vec<u8> {
    let mut at = 8;
    while let Some(head) = file.get(at..at + 8) {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let end = at + 8 + length;
        let Some(part) = file.get(at + 4..end) else { break };
        let checksum = crc32(part).to_be_bytes();
        let Some(place) = file.get_mut(end..end + 4) else { break };
        place.copy_from_slice(&checksum);
        at = end + 4;
    }
    file
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

#[test]
fn recipes_that_ask_for_too_much_or_lead_elsewhere_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("dataset.json");
    let said = |kind: &str, valid: &str, from: &str, to: &str| {
        assert!(valid.contains(from));
        fs::write(&path, described(kind, &valid.replacen(from, to, 1))).expect("writable");
        let said = sentence(&Manifest::read_file(&path).expect_err("it is refused"));
        assert!(said.contains("dataset.json: "), "{said}");
        said
    };
    assert!(said("natural", NATURAL, "\"scenes\":2", "\"scenes\":4000000000").contains("at most 100000 scenes"));
    assert!(said("natural", NATURAL, "\"frames\":2", "\"frames\":4000000000").contains("at most 100000 scenes"));
    assert!(said("natural", NATURAL, "[256,128]", "[60000,60000]").contains("pictures of 60000x60000"));
    assert!(said("natural", NATURAL, "[256,128]", "[0,128]").contains("pictures of 0x128"));
    assert!(said("natural", NATURAL, "\"city\"", "\"../../x\"").contains("cannot be a file's"));
    let no_map = "[{\"name\":\"city\",\"digest\":\"ab\"}]";
    assert!(said("natural", NATURAL, no_map, "[]").contains("at least one map"));
    assert!(said("cases", CASES, "\"city\"", "\"../../x\"").contains("cannot be a file's"));
    assert!(said("cases", CASES, "\"train\"", "\"/tmp/x\"").contains("cannot be a file's"));
}

#[test]
fn files_without_end_are_refused() {
    let endless = Path::new("/dev/zero");
    if !endless.exists() {
        return;
    }
    let reads: [fn(&Path) -> anyhow::Result<()>; 6] = [
        |path| ScenarioFile::read(path).map(drop),
        |path| calibration::read(path).map(drop),
        |path| Questionnaire::read(path).map(drop),
        |path| Manifest::read_file(path).map(drop),
        |path| png::read(path, 3).map(drop),
        |path| Ok(Checkpoint::load(path).map(drop)?),
    ];
    for read in reads {
        let said = sentence(&read(endless).expect_err("it has no end"));
        assert_eq!(said, "/dev/zero: is no regular file");
    }
}
