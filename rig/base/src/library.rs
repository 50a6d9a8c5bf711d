//! The files that a command over many recordings or cases is about.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use kernel::time::Tick;
use replay::Recording;

use crate::failure::Usage;

/// What the names of recordings and corner cases end with, and of corner cases alone.
const ENDING: &str = ".mcap";
const CASE_ENDING: &str = ".case.mcap";

/// A recording or case whose bytes have been checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Whether it is a corner case.
    pub is_case: bool,
    /// Where it is.
    pub path: PathBuf,
    /// Its file name without `.mcap`, of a file found in a folder with the way from there.
    pub name: String,
    /// BLAKE3 of the file.
    pub digest: blake3::Hash,
}

/// Files as they are given and, of folders, every corner case below, by path. Each name and each case
/// may come once.
pub fn find(paths: &[PathBuf]) -> anyhow::Result<Vec<Entry>> {
    let mut found = Vec::new();
    for path in paths {
        let folder = if path.is_dir() { path } else { path.parent().unwrap_or(Path::new("")) };
        found.extend(below(path, CASE_ENDING)?.into_iter().map(|file| (name_of(&file, folder), file)));
    }
    check_names(&found)?;
    open(found)
}

/// As [`find`], unopened.
pub fn cases(paths: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    paths.iter().map(|path| below(path, CASE_ENDING)).collect::<Result<Vec<_>, _>>().map(|files| files.concat())
}

/// Files as they are given and, of folders, every recording and corner case below, by path.
pub fn recordings(paths: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    paths.iter().map(|path| below(path, ENDING)).collect::<Result<Vec<_>, _>>().map(|files| files.concat())
}

/// Whether a file is named as corner cases are.
pub fn is_case_name(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(CASE_ENDING))
}

/// A file, or what has this ending below a folder, by path.
fn below(path: &Path, ending: &str) -> anyhow::Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut files = Vec::new();
    collect(path, ending, &mut files)?;
    if files.is_empty() {
        let what = if ending == CASE_ENDING { "corner case" } else { "recording" };
        bail!("{}: holds no {what}; expected at least one *{ending}", path.display());
    }
    files.sort();
    Ok(files)
}

fn collect(folder: &Path, ending: &str, files: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let place = || folder.display().to_string();
    for entry in fs::read_dir(folder).with_context(place)? {
        let entry = entry.with_context(place)?;
        // A link to a folder is not followed, so that no circle is.
        if entry.file_type().with_context(place)?.is_dir() {
            collect(&entry.path(), ending, files)?;
        } else if entry.file_name().to_string_lossy().ends_with(ending) {
            files.push(entry.path());
        }
    }
    Ok(())
}

fn name_of(path: &Path, folder: &Path) -> String {
    let name = path.strip_prefix(folder).unwrap_or(path).to_string_lossy();
    name.strip_suffix(".mcap").unwrap_or(&name).to_owned()
}

/// Results are filed under these names, so none may be another's folder either.
fn check_names(found: &[(String, PathBuf)]) -> anyhow::Result<()> {
    let mut names = HashSet::new();
    for (name, _) in found {
        if !names.insert(Path::new(name)) {
            return Err(Usage(format!("two files are named {name}; expected names that differ")).into());
        }
    }
    for (name, path) in found {
        if let Some(folder) = Path::new(name).ancestors().skip(1).find(|above| names.contains(above)) {
            let (folder, path) = (folder.display(), path.display());
            return Err(Usage(format!("{path}: its folder and a file are both named {folder}")).into());
        }
    }
    Ok(())
}

/// Opens the files; the same case twice would count twice.
fn open(found: Vec<(String, PathBuf)>) -> anyhow::Result<Vec<Entry>> {
    let mut known: HashMap<([u8; 32], Option<Tick>), PathBuf> = HashMap::new();
    let mut entries = Vec::new();
    for (name, path) in found {
        let recording = Recording::open(&path)?;
        let case = recording.log().manifest.case.as_ref();
        let identity = case.map_or((recording.digest(), None), |case| (case.source, Some(case.to)));
        if let Some(twin) = known.insert(identity, path.clone()) {
            let what = if identity.1.is_some() { "case" } else { "recording" };
            bail!("{}: holds the same {what} as {}; expected each once", path.display(), twin.display());
        }
        entries.push(Entry {
            is_case: identity.1.is_some(),
            path,
            name,
            digest: blake3::Hash::from_bytes(recording.digest()),
        });
    }
    Ok(entries)
}

/// Refuses recordings.
pub fn check_cases(entries: &[Entry]) -> anyhow::Result<()> {
    match entries.iter().find(|entry| !entry.is_case) {
        Some(entry) => bail!("{}: is a recording, expected a corner case", entry.path.display()),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_the_way_from_the_folder_that_was_given() {
        assert_eq!(name_of(Path::new("runs/a/x.case.mcap"), Path::new("runs")), "a/x.case");
        assert_eq!(name_of(Path::new("x.mcap"), Path::new("")), "x");
    }

    #[test]
    fn no_name_is_taken_twice_or_as_a_folder() {
        let check = |names: &[&str]| {
            let found: Vec<_> = names.iter().map(|name| (name.to_string(), PathBuf::from(name))).collect();
            check_names(&found).map_err(|e| e.to_string())
        };
        assert!(check(&["a", "b/a", "b/c"]).is_ok());
        assert!(check(&["a", "b", "a"]).unwrap_err().contains("two files are named a"));
        assert!(check(&["b/a/c", "b"]).unwrap_err().contains("both named b"));
    }

    #[test]
    fn a_folder_without_cases_is_refused() {
        let dir = tempfile::tempdir().expect("a folder");
        fs::create_dir(dir.path().join("below")).expect("writable");
        fs::write(dir.path().join("below/run.mcap"), "").expect("writable");
        let said = find(&[dir.path().to_owned()]).unwrap_err().to_string();
        assert!(said.ends_with("holds no corner case; expected at least one *.case.mcap"), "{said}");
    }
}
