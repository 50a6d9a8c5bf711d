//! The files that a command over many recordings or cases is about, by one rule for all commands: a file stands
//! for itself, and a folder for what the command reads anywhere below it.

mod kind;
mod listed;
mod names;
mod numbered;
mod twins;

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};

pub use self::kind::{Kind, case_path, fork_name, is_case_name, is_drive_name};
pub use self::listed::expand;
use self::names::{Way, tell_apart};
pub use self::numbered::{numbered, numbers};
use self::twins::{Opened, Place, Twins};
use crate::failure::{Failed, Failure};
use crate::say::say;
use crate::spread::{collect_in_order, jobs};

/// What was found, and what could not be read.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The files.
    pub files: Vec<Entry>,
    /// What is left out.
    pub failed: Vec<Failure>,
}

/// A recording or case whose bytes have been checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Whether it is a corner case.
    pub is_case: bool,
    /// Where it is.
    pub path: PathBuf,
    /// Its file name without `.mcap`, of a file found in a folder with the way from there. Results are filed
    /// under it; where two would be the same, both have as many folders before it as tell them apart.
    pub name: String,
    /// BLAKE3 of the file.
    pub digest: blake3::Hash,
}

impl Found {
    /// Refuses when nothing is left.
    pub fn or_failed(self) -> anyhow::Result<Self> {
        if self.files.is_empty() {
            return Err(Failed::new(self.failed).into());
        }
        Ok(self)
    }

    /// With recordings left out as failures.
    pub fn only_cases(mut self) -> Self {
        self.leave_out(|entry| (!entry.is_case).then(|| anyhow!("is a recording, expected a corner case")));
        self
    }

    /// With those left out whose results would take the place of a file that all have in common.
    pub fn apart_from(mut self, shared: &str) -> Self {
        let sentence = || anyhow!("its results would be filed as {shared}, which tells of all; expected another name");
        self.leave_out(|entry| (entry.name.split('/').next() == Some(shared)).then(sentence));
        self
    }

    fn leave_out(&mut self, why: impl Fn(&Entry) -> Option<anyhow::Error>) {
        let (failed, why) = (&mut self.failed, &why);
        self.files.retain(|entry| match why(entry) {
            Some(error) => {
                failed.push(Failure::new(&entry.path, &error));
                false
            }
            None => true,
        });
    }
}

/// Files as they are given and, of folders, those of a kind anywhere below, in the order of their paths and
/// numbers (`drive-2` comes before `drive-10`), opened. A file that is reached twice comes once, and so do its
/// copies and other cuts of a case, which are told. What is hidden, links to folders, and exports for viewers are
/// passed over in folders. `@FILE` stands for the paths in a file ([`expand`]).
pub fn find(paths: &[PathBuf], kind: Kind) -> Found {
    let (paths, unlisted) = expand(paths);
    let (ways, mut failed) = list(&paths, kind);
    failed.extend(unlisted);
    let (mut files, mut twins) = (Vec::new(), Twins::default());
    let opened = collect_in_order(jobs(None), ways.len(), |index| Opened::read(&ways[index].path));
    for (way, opened) in ways.into_iter().zip(opened) {
        match opened.and_then(|opened| twins.meet(&way.path, opened)) {
            Ok(Opened { digest, is_case, .. }) => {
                let (name, digest) = (way.name(), blake3::Hash::from_bytes(digest));
                files.push(Entry { is_case, path: way.path, name, digest });
            }
            Err(error) => failed.push(Failure::new(&way.path, &error)),
        }
    }
    Found { files, failed }
}

/// What [`find`] opens.
fn list(paths: &[PathBuf], kind: Kind) -> (Vec<Way>, Vec<Failure>) {
    let (mut found, mut failed, mut known) = (Vec::new(), Vec::new(), HashSet::new());
    for path in paths {
        let folder = if path.is_dir() { path } else { path.parent().unwrap_or(Path::new("")) };
        match below(path, kind) {
            Ok(files) => {
                for file in files.into_iter().filter(|file| known.insert(Place::of(file))) {
                    match check(&file) {
                        Ok(()) => found.push(Way::new(file, folder)),
                        Err(error) => failed.push(Failure::new(&file, &error)),
                    }
                }
            }
            Err(error) => failed.push(Failure::new(path, &error)),
        }
    }
    tell_apart(&mut found);
    if kind == Kind::Cases {
        found.retain(|way| match way.check() {
            Ok(()) => true,
            Err(error) => {
                failed.push(Failure::new(&way.path, &error));
                false
            }
        });
    }
    (found, failed)
}

/// Refuses what would not end to be read, and what cannot be named in results.
fn check(file: &Path) -> anyhow::Result<()> {
    let place = file.display();
    if file.metadata().is_ok_and(|is| !is.is_file()) {
        bail!("{place}: is no regular file; expected a recording or case");
    }
    if file.to_str().is_none() {
        bail!("{place}: its name is not UTF-8; expected one that is");
    }
    Ok(())
}

/// The recordings of drives in a folder itself, unopened.
pub fn drives_in(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    collect(folder, Kind::Drives, false, &mut files)?;
    files.retain(|file| !is_export(file));
    files.sort_by_cached_key(|path| order(path));
    Ok(files)
}

/// A file, or what a folder holds.
fn below(path: &Path, kind: Kind) -> anyhow::Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut files = Vec::new();
    collect(path, kind, true, &mut files)?;
    for export in files.extract_if(.., |file| is_export(file)) {
        say(format_args!("{}: left out, an export of aeye for viewers", export.display()));
    }
    if files.is_empty() {
        let (what, ending) = kind.expected();
        bail!("{}: holds no {what}; expected at least one *{ending}", path.display());
    }
    files.sort_by_cached_key(|path| order(path));
    Ok(files)
}

fn collect(folder: &Path, kind: Kind, deep: bool, files: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let place = || folder.display().to_string();
    for entry in fs::read_dir(folder).with_context(place)? {
        let entry = entry.with_context(place)?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        // A link to a folder is not followed, so that no circle is. Results keep their books in hidden folders.
        if name.starts_with('.') {
            continue;
        } else if entry.file_type().with_context(place)?.is_dir() {
            if deep {
                collect(&entry.path(), kind, deep, files)?;
            }
        } else if kind.takes(&name) {
            files.push(entry.path());
        }
    }
    Ok(())
}

/// What files are sorted by, folder by folder: `drive.mcap`, `drive-2.mcap` ... `drive-10.mcap` were driven in this order.
/// The keys of all files below a folder begin with that of the folder ([`order_below`]).
pub fn order(path: &Path) -> String {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (stem, ending) = name.split_once('.').unwrap_or((&name, ""));
    let numbered = stem.rsplit_once('-').and_then(|(stem, number)| Some((stem, number.parse::<u64>().ok()?)));
    let (stem, number) = numbered.unwrap_or((stem, 1));
    format!("{}{BETWEEN}{stem}.{ending}{BETWEEN}{number:020}", order_below(folder))
}

/// What the keys of all files below a folder begin with; nothing for no folder.
pub fn order_below(folder: &Path) -> String {
    folder.components().map(|part| format!("{}{BETWEEN}", part.as_os_str().to_string_lossy())).collect()
}

/// Comes before whatever a name may hold, so that a folder comes before others whose names begin as its own does.
const BETWEEN: char = '\u{1}';

/// What a folder holds of a kind anywhere below it, in no order, unopened: exports for viewers are among it.
pub fn walk(folder: &Path, kind: Kind) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    collect(folder, kind, true, &mut files)?;
    Ok(files)
}

/// Whether a file is an export of aeye for viewers.
pub fn is_export(file: &Path) -> bool {
    // What is no regular file may never end to be read.
    file.is_file() && replay::exported(file).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_would_file_results_elsewhere_are_refused_and_pipes_are_not_read() {
        let dir = tempfile::tempdir().expect("a folder");
        let at = |name: &str| dir.path().join(name);
        let names = ["...mcap", "..mcap", ".mcap", ".rerender.mcap"];
        names.iter().chain(&["a.case.mcap"]).for_each(|name| fs::write(at(name), "").expect("writable"));
        let given: Vec<_> = names.iter().chain(&["a.case.mcap"]).map(|name| at(name)).collect();
        let (files, failed) = list(&given, Kind::Cases);
        assert_eq!((files.len(), failed.len()), (1, names.len()));
        assert_eq!(list(&given, Kind::All).1.len(), 0, "they can be verified");
        let pipe = std::process::Command::new("mkfifo").arg(at("pipe.mcap")).status();
        if pipe.is_ok_and(|status| status.success()) {
            let (files, failed) = list(&[dir.path().to_owned()], Kind::All);
            assert_eq!((files.len(), failed.len()), (1, 1));
            assert!(format!("{:?}", failed[0]).contains("is no regular file"));
        }
    }

    #[test]
    fn runs_of_a_session_come_in_their_order() {
        let driven = ["drive.mcap", "drive-2.mcap", "drive-10.mcap", "early-0002.case.mcap", "early-0010.case.mcap"];
        let mut paths: Vec<PathBuf> = driven.iter().rev().map(PathBuf::from).collect();
        paths.sort_by_cached_key(|path| order(path));
        assert_eq!(paths, driven.map(PathBuf::from));
    }

    #[test]
    fn what_lies_below_a_folder_stands_together() {
        let order_of = |path: &str| super::order(Path::new(path));
        let paths = ["x-2.mcap", "x-10.mcap", "a/z.mcap", "a/b/c.mcap", "a-b/c.mcap", "/a/b.mcap"];
        let mut sorted = paths.map(order_of);
        sorted.sort();
        assert_eq!(
            sorted,
            ["x-2.mcap", "x-10.mcap", "/a/b.mcap", "a/z.mcap", "a/b/c.mcap", "a-b/c.mcap"].map(order_of)
        );
        let below = order_below(Path::new("a"));
        let found: Vec<_> = paths.into_iter().filter(|path| order_of(path).starts_with(&below)).collect();
        assert_eq!(found, ["a/z.mcap", "a/b/c.mcap"]);
        assert_eq!(order_below(Path::new("")), "");
    }

    #[test]
    fn folders_give_what_is_asked_for_anywhere_below_and_nothing_hidden() {
        let dir = tempfile::tempdir().expect("a folder");
        for file in ["a.mcap", "below/b.case.mcap", "below/c.fork-2.mcap", ".aeye/d.mcap", "e.txt"] {
            let path = dir.path().join(file);
            fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
            fs::write(path, "").expect("writable");
        }
        let given = [dir.path().to_owned(), dir.path().join("a.mcap")];
        let names = |kind| list(&given, kind).0.iter().map(Way::name).collect::<Vec<_>>();
        assert_eq!(names(Kind::All), ["a", "below/b.case", "below/c.fork-2"]);
        assert_eq!(names(Kind::Drives), ["a"]);
        assert_eq!(names(Kind::DrivesAndCases), ["a", "below/b.case"]);
        assert_eq!(drives_in(dir.path()).expect("readable"), [dir.path().join("a.mcap")]);
        assert_eq!(names(Kind::Cases), ["below/b.case", "a"], "files that are named are taken whatever they are");
    }

    #[test]
    fn a_folder_without_cases_is_left_out() {
        let dir = tempfile::tempdir().expect("a folder");
        fs::create_dir(dir.path().join("below")).expect("writable");
        fs::write(dir.path().join("below/run.mcap"), "").expect("writable");
        let said = find(&[dir.path().to_owned()], Kind::Cases).or_failed().unwrap_err().to_string();
        assert!(said.ends_with("holds no corner case; expected at least one *.case.mcap"), "{said}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn links_are_one_file_and_names_that_cannot_be_told_are_refused() {
        use std::os::unix::ffi::OsStrExt;
        let dir = tempfile::tempdir().expect("a folder");
        let at = |name: &[u8]| dir.path().join(std::ffi::OsStr::from_bytes(name));
        fs::write(at(b"a.mcap"), "").expect("writable");
        fs::hard_link(at(b"a.mcap"), at(b"b.mcap")).expect("linked");
        std::os::unix::fs::symlink(at(b"a.mcap"), at(b"c.mcap")).expect("linked");
        fs::create_dir(at(b"d\xff")).expect("writable");
        fs::write(at(b"d\xff/e.mcap"), "").expect("writable");
        fs::write(at(b"\xff.mcap"), "").expect("writable");
        let (files, failed) = list(&[dir.path().to_owned()], Kind::All);
        assert_eq!(files.iter().map(Way::name).collect::<Vec<_>>(), ["a"]);
        assert_eq!(failed.len(), 2);
        assert!(failed.iter().all(|failure| failure.error.ends_with("its name is not UTF-8; expected one that is")));
    }
}
