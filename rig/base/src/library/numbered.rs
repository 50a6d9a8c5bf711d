//! Recordings of a session under one name: `NAME` for the first run, `NAME-2`, `NAME-3` and so on.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::case_path;

/// The numbers of the runs under a name of which there is a recording, or at least the case.
pub fn numbers(record: &Path) -> BTreeSet<u32> {
    let folder = record.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    names.filter_map(|name| number_of(record, &name.to_string_lossy())).collect()
}

fn number_of(record: &Path, name: &str) -> Option<u32> {
    let is_run = |number: &u32| {
        let path = numbered(record, *number);
        [&path, &case_path(&path)].iter().any(|path| path.file_name().is_some_and(|n| n.to_string_lossy() == name))
    };
    let stem = record.file_stem()?.to_string_lossy();
    let rest = name.strip_prefix(&*stem)?.trim_start_matches('-');
    let digits = rest.split(|c: char| !c.is_ascii_digit()).next().unwrap_or_default();
    let number = if digits.is_empty() { 1 } else { digits.parse().ok()? };
    Some(number).filter(is_run)
}

/// The recording of a run.
pub fn numbered(record: &Path, number: u32) -> PathBuf {
    if number == 1 {
        return record.to_owned();
    }
    let stem = record.file_stem().unwrap_or_default().to_string_lossy();
    let ending = record.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
    record.with_file_name(format!("{stem}-{number}{ending}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_found_by_their_recordings_or_at_least_their_cases() {
        let dir = tempfile::tempdir().expect("a folder");
        let record = dir.path().join("drive.mcap");
        assert_eq!(numbers(&record), BTreeSet::new());
        assert_eq!(numbered(&record, 1), record);
        let write = |name: &str| std::fs::write(dir.path().join(name), "anything").expect("written");
        write("drive-2.mcap");
        write("drive-3.mcap");
        for other in ["drive-x.mcap", "drive-04.mcap", "drive--7.mcap", "drives.mcap", "drive-8.txt"] {
            write(other);
        }
        // Its recording is elsewhere.
        write("drive-5.case.mcap");
        assert_eq!(numbers(&record), BTreeSet::from([2, 3, 5]));
        assert_eq!(numbered(&record, 2), dir.path().join("drive-2.mcap"));
        assert_eq!(case_path(&numbered(&record, 2)), dir.path().join("drive-2.case.mcap"));
        assert_ne!(case_path(Path::new("run.1")), case_path(Path::new("run.2")));
    }
}
