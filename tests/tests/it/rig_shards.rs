//! Shares of files and scenes: their folders, copied together, are what one process makes.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use tests::command::aeye;
use tests::files::contents;
use tests::recordings::recorded_in;
use tests::scenes::{Scene, busy_city, country_road};

/// The commands that part, with small pictures.
const OF_FILES: [&str; 3] = [
    "rerender --checkpoint truth --size 64x32 --last 0.2s",
    "compare --checkpoint truth,early --size 64x32",
    "redrive --checkpoint truth --after 1s",
];
const NATURAL: &str =
    "dataset natural --scenes 2 --val-scenes 1 --test-scenes 1 --frames 2 --test-frames 1 --size 32x16 --maps city";

fn case(scene: &Scene, folder: &Path) -> PathBuf {
    fs::create_dir_all(folder).unwrap();
    let (recording, case) = recorded_in(scene, folder, "x");
    fs::remove_file(recording).unwrap();
    case
}

/// Copies a folder into another one, as `cp -r FROM/. TO`.
fn copy_into(from: &Path, to: &Path) {
    for path in contents(from).into_keys() {
        let target = to.join(&path);
        fs::create_dir_all(target.parent().unwrap()).unwrap();
        fs::copy(from.join(&path), target).unwrap();
    }
}

/// What tells a file from another that took its place.
fn inodes(folder: &Path) -> BTreeMap<PathBuf, u64> {
    contents(folder).into_keys().map(|path| (path.clone(), fs::metadata(folder.join(path)).unwrap().ino())).collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn copied_together_they_are_what_one_process_makes_and_nothing_is_done_twice() {
    let dir = tempfile::tempdir().unwrap();
    let cases = dir.path().join("cases");
    case(&busy_city(), &cases.join("1"));
    case(&country_road(), &cases.join("2"));
    let of_files = OF_FILES.map(|command| (command, vec![&*cases]));
    for (number, (command, files)) in of_files.into_iter().chain([(NATURAL, vec![])]).enumerate() {
        let place = dir.path().join(number.to_string());
        let (once, together) = (place.join("once"), place.join("together"));
        assert_eq!(aeye(command, &files, &once).0, 0, "{command}");
        let whole = contents(&once);
        for shard in ["3/3", "1/3", "2/3", "2/2"] {
            let folder = place.join(shard);
            assert_eq!(aeye(&format!("{command} --shard {shard}"), &files, &folder), (0, String::new()), "{command}");
            // Of two files the third shard has none.
            assert_eq!(folder.exists(), shard != "3/3" || files.is_empty(), "{command}");
            if folder.exists() {
                assert!(contents(&folder).len() < whole.len(), "{command}: a share, and no table");
                copy_into(&folder, &together);
            }
        }
        let before = inodes(&together);
        assert_eq!(aeye(command, &files, &together).0, 0, "{command}");
        let (got, after) = (contents(&together), inodes(&together));
        assert_eq!(whole.keys().collect::<Vec<_>>(), got.keys().collect::<Vec<_>>(), "{command}");
        assert!(whole == got, "{command}: the same bytes");
        let mut stayed = before.iter().filter(|(path, _)| !path.starts_with("parts"));
        assert!(stayed.all(|(path, inode)| after[path] == *inode), "{command}: nothing is done twice");

        // A shard of what is complete leaves it as it is.
        for shard in ["1/2", "1/1"] {
            assert_eq!(aeye(&format!("{command} --shard {shard}"), &files, &together).0, 0, "{command}");
            assert!(contents(&together) == whole, "{command}: complete");
        }
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_file_that_cannot_be_opened_is_told_by_the_first_shard() {
    let dir = tempfile::tempdir().unwrap();
    let cases = dir.path().join("cases");
    let good = case(&busy_city(), &cases);
    let mut bytes = fs::read(&good).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(cases.join("a-bad.case.mcap"), bytes).unwrap();
    for command in OF_FILES {
        let out = dir.path().join(command.split(' ').next().unwrap());
        let shard = |shard: &str| aeye(&format!("{command} --shard {shard}"), &[&cases], &out.join(&shard[..1]));
        assert_eq!(shard("2/2"), (0, String::new()), "{command}");
        assert_eq!(shard("1/2"), (1, "1 of 2 files failed".into()), "{command}");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn scenes_of_another_dataset_are_refused_and_lost_pictures_are_made_again() {
    let dir = tempfile::tempdir().unwrap();
    let place = |name: &str| dir.path().join(name);
    assert_eq!(aeye(NATURAL, &[], &place("once")).0, 0);
    assert_eq!(aeye(&format!("{NATURAL} --shard 1/2"), &[], &place("1")).0, 0);
    assert_eq!(aeye(&format!("{NATURAL} --seed 6 --shard 2/2"), &[], &place("other")).0, 0);
    for (first, last) in [("1", "other"), ("other", "1")] {
        let both = place(&format!("{first} before {last}"));
        copy_into(&place(first), &both);
        copy_into(&place(last), &both);
        let (code, said) = aeye(NATURAL, &[], &both);
        let is_told = said.contains("is a scene of another dataset") || said.contains("begun with other arguments");
        assert!(code == 1 && is_told, "{said}");
        assert!(!both.join("dataset.json").exists(), "nothing is half right");
    }
    let picture = contents(&place("1")).into_keys().find(|path| path.starts_with("gtFine")).expect("a picture");
    fs::remove_file(place("1").join(picture)).unwrap();
    assert_eq!(aeye(NATURAL, &[], &place("1")).0, 0);
    assert!(contents(&place("1")) == contents(&place("once")), "the same bytes");
}
