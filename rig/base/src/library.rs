//! The files that a command over many recordings or cases is about, by one rule for all commands: a file stands
//! for itself, and a folder for what the command reads anywhere below it.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use kernel::time::Tick;
use replay::Recording;

use crate::failure::{Failed, Failure};

/// What the names of recordings and corner cases end with, and of corner cases alone.
const ENDING: &str = ".mcap";
const CASE_ENDING: &str = ".case.mcap";

/// What a command takes from folders. Files that are named are taken whatever they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Corner cases.
    Cases,
    /// Recordings of drives: no cases, and no forks of `aeye redrive`, which nobody drove.
    Drives,
    /// Recordings and cases.
    All,
}

/// What was found, and what could not be read.
#[derive(Clone, Debug, PartialEq)]
pub struct Found<T> {
    /// The files.
    pub files: Vec<T>,
    /// What is left out.
    pub failed: Vec<Failure>,
}

/// A file, unopened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Where it is.
    pub path: PathBuf,
    /// Its file name without `.mcap`, of a file found in a folder with the way from there. Results are filed
    /// under it; where two would be the same, both have as many folders before it as tell them apart.
    pub name: String,
}

/// A recording or case whose bytes have been checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Whether it is a corner case.
    pub is_case: bool,
    /// Where it is.
    pub path: PathBuf,
    /// As [`Listed::name`].
    pub name: String,
    /// BLAKE3 of the file.
    pub digest: blake3::Hash,
}

impl<T> Found<T> {
    /// How many there are with those that are left out.
    pub fn total(&self) -> usize {
        self.files.len() + self.failed.len()
    }

    /// Refuses when nothing is left.
    pub fn or_failed(self) -> anyhow::Result<Self> {
        if self.files.is_empty() {
            return Err(Failed::new(self.failed).into());
        }
        Ok(self)
    }
}

/// Files as they are given and, of folders, those of a kind anywhere below, in the order of their paths and
/// numbers (`drive-2` comes before `drive-10`). A file that is reached twice comes once. What is hidden, and
/// links to folders, are passed over.
pub fn list(paths: &[PathBuf], kind: Kind) -> Found<Listed> {
    let (mut found, mut failed, mut known) = (Vec::new(), Vec::new(), HashSet::new());
    for path in paths {
        let folder = if path.is_dir() { path } else { path.parent().unwrap_or(Path::new("")) };
        match below(path, kind) {
            Ok(files) => {
                for file in files.into_iter().filter(|file| known.insert(absolute(file))) {
                    match check(&file, kind) {
                        Ok(()) => found.push(Way::new(file, folder)),
                        Err(error) => failed.push(Failure::new(&file, &error)),
                    }
                }
            }
            Err(error) => failed.push(Failure::new(path, &error)),
        }
    }
    tell_apart(&mut found);
    Found { files: found.into_iter().map(Way::into_listed).collect(), failed }
}

/// Refuses what would not end to be read, and names under which results cannot be filed: `...mcap` would be
/// filed above the results, `.mcap` as all of them, and hidden ones among their books.
fn check(file: &Path, kind: Kind) -> anyhow::Result<()> {
    let place = file.display();
    if file.metadata().is_ok_and(|is| !is.is_file()) {
        bail!("{place}: is no regular file; expected a recording or case");
    }
    let Some(name) = file.file_name().and_then(|name| name.to_str()) else {
        bail!("{place}: its name is not UTF-8; expected one that is");
    };
    if kind == Kind::Cases && (name.starts_with('.') || name == ENDING) {
        bail!("{place}: its name begins with a dot; expected one under which results can be filed");
    }
    Ok(())
}

/// As [`list`], opened, and each case once.
pub fn find(paths: &[PathBuf], kind: Kind) -> Found<Entry> {
    let Found { files: listed, mut failed } = list(paths, kind);
    let mut known: HashMap<Identity, PathBuf> = HashMap::new();
    let mut files = Vec::new();
    for listed in listed {
        match open(&listed, &mut known) {
            Ok(entry) => files.push(entry),
            Err(error) => failed.push(Failure::new(&listed.path, &error)),
        }
    }
    Found { files, failed }
}

/// As [`find`], with recordings left out as failures.
pub fn find_cases(paths: &[PathBuf]) -> Found<Entry> {
    let mut found = find(paths, Kind::Cases);
    for entry in found.files.extract_if(.., |entry| !entry.is_case) {
        let error = anyhow!("{}: is a recording, expected a corner case", entry.path.display());
        found.failed.push(Failure::new(&entry.path, &error));
    }
    found
}

/// The path of a corner case beside its recording.
pub fn case_path(recording: &Path) -> PathBuf {
    let name = recording.file_name().unwrap_or_default().to_string_lossy();
    recording.with_file_name(format!("{}{CASE_ENDING}", name.strip_suffix(ENDING).unwrap_or(&name)))
}

/// The name of a fork of what has this name, and of variations of the fork.
pub fn fork_name(name: &str, variation: u16) -> String {
    if variation == 0 { format!("{name}.fork{ENDING}") } else { format!("{name}.fork-{variation}{ENDING}") }
}

/// Whether a file is named as corner cases are.
pub fn is_case_name(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(CASE_ENDING))
}

impl Kind {
    fn takes(self, name: &str) -> bool {
        match self {
            Self::Cases => name.ends_with(CASE_ENDING),
            Self::Drives => name.ends_with(ENDING) && !name.ends_with(CASE_ENDING) && !is_fork_name(name),
            Self::All => name.ends_with(ENDING),
        }
    }

    fn expected(self) -> (&'static str, &'static str) {
        match self {
            Self::Cases => ("corner case", CASE_ENDING),
            Self::Drives | Self::All => ("recording", ENDING),
        }
    }
}

/// `NAME.fork.mcap`, `NAME.fork-1.mcap` and so on.
fn is_fork_name(name: &str) -> bool {
    let stem = name.strip_suffix(ENDING).unwrap_or(name);
    let number = stem.rsplit_once(".fork").map(|(_, number)| number.strip_prefix('-').unwrap_or(number));
    number.is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()))
}

/// A file, or what a folder holds.
fn below(path: &Path, kind: Kind) -> anyhow::Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut files = Vec::new();
    collect(path, kind, &mut files)?;
    if files.is_empty() {
        let (what, ending) = kind.expected();
        bail!("{}: holds no {what}; expected at least one *{ending}", path.display());
    }
    files.sort_by_cached_key(|path| turn(path));
    Ok(files)
}

fn collect(folder: &Path, kind: Kind, files: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let place = || folder.display().to_string();
    for entry in fs::read_dir(folder).with_context(place)? {
        let entry = entry.with_context(place)?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        // A link to a folder is not followed, so that no circle is. Results keep their books in hidden folders.
        if name.starts_with('.') {
            continue;
        } else if entry.file_type().with_context(place)?.is_dir() {
            collect(&entry.path(), kind, files)?;
        } else if kind.takes(&name) {
            files.push(entry.path());
        }
    }
    Ok(())
}

/// What files are sorted by: `drive.mcap`, `drive-2.mcap` ... `drive-10.mcap` were driven in this order.
fn turn(path: &Path) -> (PathBuf, String, u64) {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (stem, ending) = name.split_once('.').unwrap_or((&name, ""));
    let numbered = stem.rsplit_once('-').and_then(|(stem, number)| Some((stem, number.parse().ok()?)));
    let (stem, number) = numbered.unwrap_or((stem, 1));
    (folder, format!("{stem}.{ending}"), number)
}

fn absolute(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// A file and how much of the way to it is its name.
struct Way {
    path: PathBuf,
    /// Every folder above, and the name without `.mcap`.
    parts: Vec<String>,
    /// How many of them, from the end.
    taken: usize,
}

impl Way {
    fn new(path: PathBuf, folder: &Path) -> Self {
        let whole = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
        let normal = |part: Component<'_>| match part {
            Component::Normal(part) => Some(part.to_string_lossy().into_owned()),
            _ => None,
        };
        let mut parts: Vec<String> = whole.components().filter_map(normal).collect();
        if let Some(last) = parts.last_mut() {
            *last = last.strip_suffix(ENDING).unwrap_or(last).to_owned();
        }
        let taken = path.strip_prefix(folder).unwrap_or(&path).components().count().clamp(1, parts.len().max(1));
        Self { path, parts, taken }
    }

    fn name(&self) -> String {
        self.parts[self.parts.len().saturating_sub(self.taken)..].join("/")
    }

    fn into_listed(self) -> Listed {
        Listed { name: self.name(), path: self.path }
    }
}

/// Gives names that are the same one more folder each, until none is; nor may one be the folder of another.
fn tell_apart(ways: &mut [Way]) {
    loop {
        let mut known: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (index, way) in ways.iter().enumerate() {
            known.entry(way.name()).or_default().push(index);
        }
        let is_folder =
            |name: &str| known.keys().any(|other| Path::new(other).ancestors().skip(1).any(|a| a == Path::new(name)));
        let clashes = known.iter().filter(|(name, ways)| ways.len() > 1 || is_folder(name));
        let longer: Vec<usize> = clashes.flat_map(|(_, ways)| ways.iter().copied()).collect();
        let mut is_done = true;
        for index in longer {
            let way = &mut ways[index];
            if way.taken < way.parts.len() {
                way.taken += 1;
                is_done = false;
            }
        }
        if is_done {
            return;
        }
    }
}

/// What makes a file the same as another: its bytes, or the case that it is.
type Identity = ([u8; 32], Option<Tick>);

/// Opens a file; the same case twice would count twice.
fn open(listed: &Listed, known: &mut HashMap<Identity, PathBuf>) -> anyhow::Result<Entry> {
    let Listed { path, name } = listed.clone();
    let recording = Recording::open(&path)?;
    let case = recording.log().manifest.case.as_ref();
    let identity = case.map_or((recording.digest(), None), |case| (case.source, Some(case.to)));
    let is_case = identity.1.is_some();
    if let Some(twin) = known.get(&identity) {
        let what = if is_case { "case" } else { "recording" };
        bail!("{}: holds the same {what} as {}; expected each once", path.display(), twin.display());
    }
    known.insert(identity, path.clone());
    Ok(Entry { is_case, path, name, digest: blake3::Hash::from_bytes(recording.digest()) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(given: &[(&str, &str)]) -> Vec<String> {
        let mut ways: Vec<Way> = given.iter().map(|(path, folder)| Way::new(path.into(), Path::new(folder))).collect();
        tell_apart(&mut ways);
        ways.iter().map(Way::name).collect()
    }

    #[test]
    fn names_that_would_file_results_elsewhere_are_refused_and_pipes_are_not_read() {
        let dir = tempfile::tempdir().expect("a folder");
        let at = |name: &str| dir.path().join(name);
        let names = ["...mcap", "..mcap", ".mcap", ".rerender.mcap"];
        names.iter().chain(&["a.case.mcap"]).for_each(|name| fs::write(at(name), "").expect("writable"));
        let given: Vec<_> = names.iter().chain(&["a.case.mcap"]).map(|name| at(name)).collect();
        let Found { files, failed } = list(&given, Kind::Cases);
        assert_eq!((files.len(), failed.len()), (1, names.len()));
        assert_eq!(list(&given, Kind::All).failed.len(), 0, "they can be verified");
        let pipe = std::process::Command::new("mkfifo").arg(at("pipe.mcap")).status();
        if pipe.is_ok_and(|status| status.success()) {
            let Found { files, failed } = list(&[dir.path().to_owned()], Kind::All);
            assert_eq!((files.len(), failed.len()), (1, 1));
            assert!(format!("{:?}", failed[0]).contains("is no regular file"));
        }
    }

    #[test]
    fn names_say_the_way_from_the_folder_that_was_given() {
        assert_eq!(names(&[("runs/a/x.case.mcap", "runs"), ("y.mcap", "")]), ["a/x.case", "y"]);
    }

    #[test]
    fn names_that_are_the_same_get_the_folders_that_tell_them_apart() {
        let two = [("/r/1/x.mcap", "/r/1"), ("/r/2/x.mcap", "/r/2"), ("/r/2/y.mcap", "/r/2")];
        assert_eq!(names(&two), ["1/x", "2/x", "y"]);
        assert_eq!(names(&[("/r/1/b/x.mcap", "/r/1"), ("/s/b.mcap", "/s")]), ["b/x", "s/b"], "no name is a folder");
    }

    #[test]
    fn runs_of_a_session_come_in_their_order() {
        let order = ["drive.mcap", "drive-2.mcap", "drive-10.mcap", "early-0002.case.mcap", "early-0010.case.mcap"];
        let mut paths: Vec<PathBuf> = order.iter().rev().map(PathBuf::from).collect();
        paths.sort_by_cached_key(|path| turn(path));
        assert_eq!(paths, order.map(PathBuf::from));
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
        let names = |kind| list(&given, kind).files.into_iter().map(|file| file.name).collect::<Vec<_>>();
        assert_eq!(names(Kind::All), ["a", "below/b.case", "below/c.fork-2"]);
        assert_eq!(names(Kind::Drives), ["a"]);
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
}
