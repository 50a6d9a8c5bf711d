//! Recordings and cases whose checksums, indexes and seals fit: only what they say is wrong.

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use replay::{Recording, verify};

use super::changes::{changed, changes};
use super::check;
use crate::replay_changes::parts::Parts;
use crate::replay_changes::{FILES, change, network};

/// Reads and drives what a file holds.
fn read(path: &Path) -> anyhow::Result<()> {
    let recording = Recording::open(path)?;
    let place = |error| anyhow::Error::new(error).context(path.display().to_string());
    verify(recording.log(), network()).map(drop).map_err(place)
}

#[test]
fn what_recordings_and_cases_say() {
    let strategy = (0..2usize, vec(change(), 1..5), any::<bool>());
    hunt::hunt("log", 150, strategy, |(which, changes, is_sealed)| {
        let mut parts = Parts::of(&FILES[which]);
        for change in &changes {
            if parts.messages().next().is_some() {
                change.make(&mut parts);
            }
        }
        if is_sealed {
            parts.seal();
        }
        check("damaged.mcap", &parts.file(), read)
    });
}

#[test]
fn bytes_of_recordings_and_cases() {
    hunt::hunt("log-bytes", 150, (0..2usize, changes()), |(which, changes)| {
        check("damaged.mcap", &changed(&FILES[which], &changes), read)
    });
}
