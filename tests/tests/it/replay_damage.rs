//! Damaged and cut-off files are never taken for whole ones.

use std::io::{self, Write};
use std::sync::LazyLock;

use kernel::time::TICK_HZ;
use proptest::prelude::*;
use replay::{Error, Manifest, Provenance, Recorder, Recording, verify};
use tests::recordings::{ALONE, record};
use tests::scenes::{Scene, busy_city};

static CITY: LazyLock<Scene> = LazyLock::new(busy_city);
static FILE: LazyLock<Vec<u8>> = LazyLock::new(|| record(&CITY, 700, ALONE));

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_one_changed_byte_is_found(at in any::<prop::sample::Index>(), flip in 1u8..) {
        let mut bytes = FILE.clone();
        bytes[at.index(FILE.len())] ^= flip;
        match Recording::from_bytes(&bytes) {
            Err(Error::Damaged { place, reason }) => prop_assert!(place.contains("byte") && !reason.is_empty()),
            other => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn bytes_that_are_no_log_are_errors(bytes in prop::collection::vec(any::<u8>(), 0..2000)) {
        prop_assert!(Recording::from_bytes(&bytes).is_err());
    }

    #[test]
    fn torn_pieces_of_a_log_are_no_panic(
        pieces in prop::collection::vec((any::<prop::sample::Index>(), 0usize..3000), 1..5),
    ) {
        let mut bytes = FILE[..8].to_vec();
        for (at, length) in pieces {
            let at = at.index(FILE.len());
            bytes.extend(&FILE[at..FILE.len().min(at + length)]);
        }
        prop_assume!(bytes != FILE[..bytes.len().min(FILE.len())]);
        prop_assert!(!Recording::from_bytes(&bytes).is_ok_and(|r| r.finished()));
    }

    #[test]
    fn a_cut_off_file_holds_the_ticks_up_to_its_last_block(lengths in any::<[prop::sample::Index; 2]>()) {
        let mut lengths = lengths.map(|length| length.index(FILE.len()));
        lengths.sort_unstable();
        let [shorter, longer] = lengths.map(|length| Recording::from_bytes(&FILE[..length]));
        let Ok(shorter) = shorter else { return Ok(()) };
        prop_assert!(!shorter.finished());
        let longer = longer.expect("readable as the shorter one is");
        let ticks = shorter.log().inputs.len();
        prop_assert!(ticks <= longer.log().inputs.len());
        prop_assert_eq!(&shorter.log().inputs, &longer.log().inputs[..ticks]);
    }
}

#[test]
fn a_cut_off_file_verifies_and_lacks_a_second_at_most() {
    let cut = Recording::from_bytes(&FILE[..FILE.len() - 1]).expect("all but its end is there");
    assert!(!cut.finished() && cut.log().last_tick() + u64::from(TICK_HZ) >= 700, "{}", cut.log().last_tick());
    assert_eq!(verify(cut.log(), &CITY.network).expect("a log").divergence, None);
}

/// A stream that remembers what had been handed to the operating system when the process died.
#[derive(Default)]
struct Killed {
    written: Vec<u8>,
    flushed: usize,
}

impl Write for &mut Killed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.written.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.flushed = self.written.len();
        Ok(())
    }
}

#[test]
fn a_killed_process_loses_at_most_a_second() {
    for killed_at in [1u64, 59, 60, 61, 130, 659] {
        let mut stream = Killed::default();
        let manifest = Manifest::new(&CITY.scenario, &CITY.network, None, Provenance::default());
        let mut world = CITY.world();
        let mut recorder = Recorder::new(&mut stream, &manifest, &world.initial_keyframe()).expect("a new log");
        while world.tick() < killed_at {
            let input = ALONE(&world);
            let output = world.step(&input);
            recorder.tick(&input, &output, &world.part_hashes()).expect("the log grows");
        }
        drop(recorder);
        let recording = Recording::from_bytes(&stream.written[..stream.flushed]).expect("a readable file");
        assert!(!recording.finished());
        assert!(recording.log().last_tick() + u64::from(TICK_HZ) > killed_at);
        let report = verify(recording.log(), &CITY.network).expect("a log that can be simulated");
        assert_eq!((report.divergence, report.ticks), (None, recording.log().last_tick()));
    }
}

/// A stream that is full after a number of bytes.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 = self.0.checked_sub(bytes.len()).ok_or_else(|| io::Error::from(io::ErrorKind::StorageFull))?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error_of_the_tick_that_meets_it() {
    let manifest = Manifest::new(&CITY.scenario, &CITY.network, None, Provenance::default());
    let mut world = CITY.world();
    let mut recorder = Recorder::new(Full(FILE.len() / 2), &manifest, &world.initial_keyframe()).expect("a new log");
    let failed = (0..700).find_map(|_| {
        let input = ALONE(&world);
        let output = world.step(&input);
        recorder.tick(&input, &output, &world.part_hashes()).err()
    });
    assert!(matches!(failed, Some(Error::Io(e)) if e.kind() == io::ErrorKind::StorageFull));
    assert!(recorder.finish(None).is_err());
}

#[test]
fn an_unreadable_file_is_named() {
    let missing = std::path::Path::new("no-such-recording.mcap");
    let said = Recording::open(missing).expect_err("it does not exist").to_string();
    assert!(said.starts_with("no-such-recording.mcap: "), "{said}");
}
