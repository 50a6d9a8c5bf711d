//! What a folder holds, and what of it may differ from a folder in which nothing was killed.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Files below a folder, by their paths below it; folders end with a slash and hold no bytes.
pub type Contents = BTreeMap<String, Vec<u8>>;

/// Everything below a folder in which nobody is at work.
pub fn contents(folder: &Path) -> Contents {
    let read = |name: String| {
        let path = folder.join(&name);
        let bytes = if name.ends_with('/') { Vec::new() } else { fs::read(&path).expect("readable") };
        (name, bytes)
    };
    names(folder).into_iter().map(read).collect()
}

/// The paths of everything below a folder, which may change meanwhile.
pub fn names(folder: &Path) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut folders = vec![String::new()];
    while let Some(above) = folders.pop() {
        for entry in fs::read_dir(folder.join(&above)).into_iter().flatten().flatten() {
            let mut name = format!("{above}{}", entry.file_name().to_string_lossy());
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                name.push('/');
                folders.push(name.clone());
            }
            names.insert(name);
        }
    }
    names
}

/// Whether it is what a process was just writing, under a name that is no result's.
pub fn is_temporary(name: &str) -> bool {
    name.split('/').any(|part| part.starts_with(".aeye-"))
}

/// What there is of the finished results, none of which differs from its whole.
pub fn finished(now: &Contents, whole: &Contents) -> BTreeSet<String> {
    let mut finished = BTreeSet::new();
    for (name, bytes) in now.iter().filter(|(name, _)| !name.ends_with('/') && !is_temporary(name)) {
        let (result, waits) = place(name);
        match whole.get(&result) {
            _ if grows(name) => {}
            Some(expected) => {
                assert!(bytes == expected, "{name}: differs from what it is without a kill");
                finished.insert(result);
            }
            None => assert!(waits || is_of_unfinished(name), "{name}: is no result"),
        }
    }
    finished
}

/// Every file and folder is the same, and there are no others.
pub fn assert_same(now: &Contents, whole: &Contents, context: &str) {
    let names = |contents: &Contents| contents.keys().cloned().collect::<BTreeSet<_>>();
    let (ours, theirs) = (names(now), names(whole));
    let (more, less): (Vec<_>, Vec<_>) = (ours.difference(&theirs).collect(), theirs.difference(&ours).collect());
    assert!(more.is_empty() && less.is_empty(), "{context}: left over: {more:?}; missing: {less:?}");
    let differing: Vec<_> = now.iter().filter(|(name, bytes)| whole[*name] != **bytes).map(|file| file.0).collect();
    assert!(differing.is_empty(), "{context}: differ: {differing:?}");
}

/// Where a result goes, and whether it waits for that: runs of campaigns do, for their turn.
fn place(name: &str) -> (String, bool) {
    match name.split_once(".waiting/").and_then(|(folder, rest)| Some((folder, rest.split_once('/')?.1))) {
        Some((folder, rest)) => (format!("{folder}{rest}"), true),
        None => (name.to_owned(), false),
    }
}

/// An unfinished training is written again with each epoch.
fn grows(name: &str) -> bool {
    name.ends_with(".onnx.part")
}

/// The scenes so far of a natural dataset, which are put together in the end.
fn is_of_unfinished(name: &str) -> bool {
    name.contains("/parts/")
}
