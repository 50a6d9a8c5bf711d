//! Recordings of earlier versions are told what they are. Their files are `tests/old_recordings`, named by the
//! version of the layout; a change that makes a new version adds files of the one before it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use kernel::map::bundled;
use replay::{Error, Recording, verify};

/// What is expected of a file: its kernel, its ticks, whether it was finished, and scenes of a case.
type Expected = (&'static str, u64, u64, bool, usize);

fn expected() -> BTreeMap<&'static str, Expected> {
    [
        ("1-corner.case.mcap", ("0.1.0", 0, 706, true, 30)),
        ("1-drive.mcap", ("0.1.0", 0, 1200, true, 0)),
        ("1-foreign-map.mcap", ("0.1.0", 0, 472, true, 0)),
        ("1-intervened.mcap", ("0.1.0", 0, 706, true, 0)),
        ("1-stopped.mcap", ("0.1.0", 0, 1020, false, 0)),
    ]
    .into()
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("old_recordings")
}

#[test]
fn every_old_recording_opens_and_holds_what_it_held() {
    let files = fs::read_dir(folder()).expect("the old recordings").map(|entry| entry.expect("an entry").file_name());
    let names: Vec<_> = files.map(|name| name.to_string_lossy().into_owned()).collect();
    assert_eq!(names.len(), expected().len(), "{names:?}");
    for (name, (kernel, first, last, finished, scenes)) in expected() {
        let recording = Recording::open(&folder().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let log = recording.log();
        assert_eq!((log.manifest.kernel.as_str(), log.first_tick(), log.last_tick()), (kernel, first, last), "{name}");
        assert_eq!((recording.finished(), log.scenes.len()), (finished, scenes), "{name}");
    }
}

#[test]
fn none_is_said_to_diverge() {
    for name in expected().keys() {
        let recording = Recording::open(&folder().join(name)).expect("it opens");
        // Maps are baked otherwise than they were, which is said; who has one as it was hears of the kernel.
        let network = recording.network().unwrap_or_else(|error| {
            assert!(matches!(error, Error::Map { .. }), "{name}: {error}");
            bundled("city").expect("a bundled map")
        });
        let error = verify(recording.log(), &network).expect_err("another kernel made it");
        assert!(matches!(error, Error::Kernel { .. }), "{name}: {error}");
        let (made, this) = (&recording.log().manifest.kernel, kernel::identity());
        let sentence =
            format!("made by kernel {made}, this is {this}; only the kernel that made a log can drive it again");
        assert_eq!(error.to_string(), sentence);
    }
}
