//! What recordings, corner cases and forks are called.

use std::path::{Path, PathBuf};

use super::names::ENDING;

/// What the names of corner cases end with.
const CASE_ENDING: &str = ".case.mcap";

/// What a command takes from folders. Files that are named are taken whatever they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Corner cases, about each of which there will be results.
    Cases,
    /// Recordings of drives: no cases, and no forks of `aeye redrive`, which nobody drove.
    Drives,
    /// Recordings of drives, and cases.
    DrivesAndCases,
    /// Recordings, forks too, and cases.
    All,
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

/// Whether a file is named so that folders give it as the recording of a drive.
pub fn is_drive_name(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| !name.starts_with('.') && Kind::Drives.takes(name))
}

/// Whether a file is named as corner cases are.
pub fn is_case_name(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(CASE_ENDING))
}

impl Kind {
    /// Whether a file of this name in a folder is taken.
    pub fn takes(self, name: &str) -> bool {
        match self {
            Self::Cases => name.ends_with(CASE_ENDING),
            Self::Drives => Self::DrivesAndCases.takes(name) && !name.ends_with(CASE_ENDING),
            Self::DrivesAndCases => name.ends_with(ENDING) && !is_fork_name(name),
            Self::All => name.ends_with(ENDING),
        }
    }

    /// What it is called, and what its names end with.
    pub fn expected(self) -> (&'static str, &'static str) {
        match self {
            Self::Cases => ("corner case", CASE_ENDING),
            Self::Drives => ("recording", ENDING),
            Self::DrivesAndCases | Self::All => ("recording or corner case", ENDING),
        }
    }
}

/// `NAME.fork.mcap`, `NAME.fork-1.mcap` and so on.
fn is_fork_name(name: &str) -> bool {
    let stem = name.strip_suffix(ENDING).unwrap_or(name);
    let number = stem.rsplit_once(".fork").map(|(_, number)| number.strip_prefix('-').unwrap_or(number));
    number.is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drives_are_named_so_that_they_are_found_again() {
        let is_found = |name: &str| is_drive_name(Path::new(name));
        assert!(["a.mcap", "d/a-2.mcap", "a.fork.b.mcap"].into_iter().all(is_found));
        assert!(
            !["a", "a.MCAP", "d.mcap/a", ".mcap", ".a.mcap", "a.case.mcap", "a.fork.mcap", "a.fork-2.mcap", ""]
                .into_iter()
                .any(is_found)
        );
    }
}
