//! Every file that people hand to the program may be damaged: it is read, or refused in one sentence that names
//! it. Nothing panics, ends the program or takes more memory than its limit. `tests/fuzz.sh` tries for longer.

mod changes;
mod logs;
mod pictures;
mod texts;

use std::fs;
use std::path::Path;

use base::failure::sentence;
use base::png;
use base::scenario_file::ScenarioFile;
use lab::dataset::Manifest;
use live::units::calibration;
use perception::Checkpoint;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use study::Questionnaire;

/// Reads a file with this name; an error must be a sentence that names it.
fn check(name: &str, bytes: &[u8], read: impl Fn(&Path) -> anyhow::Result<()>) -> TestCaseResult {
    check_files(&[(name, bytes)], |folder| read(&folder.join(name)))
}

/// Reads a folder with these files; an error must be a sentence that names what is `damaged`.
fn check_files(files: &[(&str, &[u8])], read: impl Fn(&Path) -> anyhow::Result<()>) -> TestCaseResult {
    if let Err(error) = read(&hunt::trying(files)) {
        let text = sentence(&error);
        prop_assert!(text.contains("damaged") && text.len() < 3_000, "{}", text);
    }
    Ok(())
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
