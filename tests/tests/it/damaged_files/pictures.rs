//! Pictures, and folders of them as networks learn from them and are measured on them.

use std::path::Path;

use base::png;
use base::progress::Interrupt;
use drivers::checkpoint::CheckpointChoice;
use perception::cityscapes::{Kind, Place};
use perception::training::Split;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

use super::changes::{Change, changed, changes};
use super::{CASES, check, check_files, described, with_checksums};

const SIZE: (u32, u32) = (16, 8);
const PIXELS: usize = 16 * 8;

fn rgb() -> Vec<u8> {
    png::rgb(SIZE, &(0..3 * PIXELS).map(|i| i as u8).collect::<Vec<_>>()).expect("a picture")
}

fn ids(most: u8) -> Vec<u8> {
    png::tags(SIZE, &(0..PIXELS).map(|i| i as u8 % most).collect::<Vec<_>>()).expect("a picture")
}

/// A picture with changes, whose checksums fit if asked.
fn damaged(valid: &[u8], changes: &[Change], is_plain: bool) -> Vec<u8> {
    let bytes = changed(valid, changes);
    if is_plain { bytes } else { with_checksums(bytes) }
}

#[test]
fn pictures() {
    let valid = [rgb(), ids(23)];
    hunt::hunt("picture", 300, (0..2usize, changes(), 1..4usize, any::<bool>()), |(which, changes, samples, plain)| {
        check("damaged.png", &damaged(&valid[which], &changes, plain), |path| png::read(path, samples).map(drop))
    });
}

/// What becomes of one file of a folder.
#[derive(Clone, Debug)]
enum Fate {
    Damaged(Vec<Change>, bool),
    Gone,
    /// It holds what another one holds.
    Another(Index),
    /// It lies elsewhere: another name of the last part of its path.
    Named(Index),
}

/// Names that files get.
const NAMES: [&str; 6] =
    ["x_leftImg8bit.png", "_leftImg8bit.png", "\u{1b}[2J_leftImg8bit.png", "a.png", "city_leftImg8bit.png", "ä"];

/// A dataset of two frames in each of two splits.
fn dataset() -> Vec<(String, Vec<u8>)> {
    let mut files = vec![("dataset.json".to_owned(), described("cases", CASES).into_bytes())];
    for (split, frame) in [("train", 0), ("train", 1), ("val", 0), ("val", 1)] {
        let place = Place { split, city: "city", scene: 0, frame, camera: None };
        for kind in Kind::ALL {
            let bytes = match kind {
                Kind::Image | Kind::Color => rgb(),
                Kind::LabelIds => ids(23),
                Kind::TrainIds => ids(16),
                Kind::InstanceIds => instances(),
            };
            files.push((place.path(kind), bytes));
        }
    }
    files
}

fn instances() -> Vec<u8> {
    png::grey16(SIZE, &(0..PIXELS).map(|i| i as u16 * 100).collect::<Vec<_>>()).expect("a picture")
}

fn listed(files: &[(String, Vec<u8>)]) -> Vec<(&str, &[u8])> {
    files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())).collect()
}

fn read_dataset(folder: &Path) -> anyhow::Result<()> {
    let trained = Split::read(folder, "train", 16, 8).map(drop).map_err(anyhow::Error::new);
    lab::eval::evaluate(&CheckpointChoice::Truth, folder, "val", Some(1), &Interrupt::default()).map(drop).and(trained)
}

#[test]
fn folders_of_pictures() {
    let valid = dataset();
    let fate = prop_oneof![
        6 => (changes(), any::<bool>()).prop_map(|(changes, plain)| Fate::Damaged(changes, plain)),
        1 => Just(Fate::Gone),
        1 => any::<Index>().prop_map(Fate::Another),
        1 => any::<Index>().prop_map(Fate::Named),
    ];
    hunt::hunt("folder", 60, vec((any::<Index>(), fate), 1..4), |fates| {
        let mut files = valid.clone();
        for (at, fate) in fates {
            let at = at.index(files.len());
            match fate {
                Fate::Damaged(changes, plain) => files[at].1 = damaged(&files[at].1, &changes, plain),
                Fate::Gone => drop(files.remove(at)),
                Fate::Another(other) => files[at].1 = valid[other.index(valid.len())].1.clone(),
                Fate::Named(name) => {
                    let folder = files[at].0.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
                    files[at].0 = format!("{folder}/{}", name.get(&NAMES)).trim_start_matches('/').to_owned();
                }
            }
        }
        check_files(&listed(&files), read_dataset)
    });
}

#[test]
fn the_folder_is_valid_before() {
    read_dataset(&hunt::trying(&listed(&dataset()))).expect("a dataset");
}
