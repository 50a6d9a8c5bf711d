//! Long results under a hidden name until they are complete. What a killed process had begun of a result is
//! removed when that result is begun again.

use std::fs::{self, File};
use std::io::{self, BufWriter, IntoInnerError, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use tempfile::{NamedTempFile, TempDir};

use super::{create_folder, folder_of, make_readable};

/// A file that gets its name only when it is complete; dropped before, nothing remains.
pub struct PendingFile {
    temporary: BufWriter<NamedTempFile>,
    path: PathBuf,
}

impl PendingFile {
    /// Starts a file.
    pub fn new(path: &Path) -> anyhow::Result<Self> {
        let parent = folder_of(path);
        sweep(path)?;
        let temporary = tempfile::Builder::new().prefix(&prefix(path)).tempfile_in(&parent);
        let temporary = temporary.with_context(|| parent.display().to_string())?;
        claim(temporary.as_file());
        make_readable(temporary.path(), 0o644)?;
        Ok(Self { temporary: BufWriter::new(temporary), path: path.to_owned() })
    }

    /// Gives the file its name; whatever had it before is gone.
    pub fn finish(self) -> anyhow::Result<()> {
        let context = || self.path.display().to_string();
        let file = self.temporary.into_inner().map_err(IntoInnerError::into_error).with_context(context)?;
        file.persist(&self.path).with_context(context)?;
        Ok(())
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.temporary.write(bytes).map_err(|error| named(&self.path, &error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.temporary.flush().map_err(|error| named(&self.path, &error))
    }
}

fn named(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// A folder that gets its name only when it is complete; dropped before, nothing remains.
pub struct PendingFolder {
    temporary: TempDir,
    path: PathBuf,
    /// The folder opened, where the system can; holds its lock.
    _claimed: Option<File>,
}

impl PendingFolder {
    /// Starts a folder; `path` must not exist, or be an empty folder.
    pub fn new(path: &Path) -> anyhow::Result<Self> {
        let is_free = match fs::read_dir(path) {
            Ok(mut entries) => entries.next().is_none(),
            Err(_) => !path.exists(),
        };
        if !is_free {
            bail!("{}: exists already; expected a new or an empty folder", path.display());
        }
        let parent = folder_of(path);
        create_folder(&parent)?;
        sweep(path)?;
        let temporary = tempfile::Builder::new().prefix(&prefix(path)).tempdir_in(&parent);
        let temporary = temporary.with_context(|| parent.display().to_string())?;
        let claimed = File::open(temporary.path()).ok();
        claimed.iter().for_each(claim);
        Ok(Self { temporary, path: path.to_owned(), _claimed: claimed })
    }

    /// Where to write until [`PendingFolder::finish`].
    pub fn path(&self) -> &Path {
        self.temporary.path()
    }

    /// Gives the folder its name.
    pub fn finish(self) -> anyhow::Result<()> {
        make_readable(self.temporary.path(), 0o755)?;
        if self.path.exists() {
            fs::remove_dir(&self.path).with_context(|| self.path.display().to_string())?;
        }
        fs::rename(self.temporary.path(), &self.path).with_context(|| self.path.display().to_string())?;
        // It has moved away: nothing is left to delete.
        let _ = self.temporary.keep();
        Ok(())
    }
}

/// How the hidden names of a result begin.
fn prefix(path: &Path) -> String {
    format!(".aeye-{}-", path.file_name().unwrap_or_default().to_string_lossy())
}

/// Marks what is being made until the process ends, however it ends. Where a file system knows no locks,
/// nothing is marked, and nothing removed.
fn claim(begun: &File) {
    let _ = begun.try_lock();
}

/// Removes what processes that are gone had begun of a result.
fn sweep(path: &Path) -> anyhow::Result<()> {
    let (folder, prefix) = (folder_of(path), prefix(path));
    let place = || folder.display().to_string();
    for entry in fs::read_dir(&folder).with_context(place)? {
        let entry = entry.with_context(place)?;
        let is_ours = entry.file_name().to_string_lossy().starts_with(&prefix);
        if !is_ours || !File::open(entry.path()).is_ok_and(|begun| begun.try_lock().is_ok()) {
            continue;
        }
        let is_folder = entry.file_type().with_context(place)?.is_dir();
        let removed = if is_folder { fs::remove_dir_all(entry.path()) } else { fs::remove_file(entry.path()) };
        removed.with_context(|| entry.path().display().to_string())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_process_that_is_gone_had_begun_is_removed() {
        let dir = tempfile::tempdir().expect("a folder");
        let (path, other) = (dir.path().join("out"), dir.path().join("out2"));
        let begun = |name: &str| dir.path().join(name);
        fs::create_dir(begun(".aeye-out-x")).expect("writable");
        fs::write(begun(".aeye-out-x/half"), "").expect("writable");
        fs::write(begun(".aeye-out-y"), "").expect("writable");
        fs::write(begun(".aeye-out2-z"), "").expect("writable");
        let (folder, _file) = (PendingFolder::new(&path).expect("free"), PendingFile::new(&other).expect("free"));
        assert!(!begun(".aeye-out-x").exists() && !begun(".aeye-out-y").exists() && !begun(".aeye-out2-z").exists());
        let _another = PendingFolder::new(&path).expect("free");
        assert!(folder.path().exists(), "its process still runs");
    }

    #[test]
    fn a_folder_appears_only_when_finished() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("out");
        drop(PendingFolder::new(&path).expect("free"));
        assert_eq!(fs::read_dir(dir.path()).expect("readable").count(), 0);
        let pending = PendingFolder::new(&path).expect("free");
        fs::write(pending.path().join("a"), "b").expect("writable");
        pending.finish().expect("renamed");
        assert_eq!(fs::read_to_string(path.join("a")).expect("there"), "b");
        assert!(PendingFolder::new(&path).is_err());
    }

    #[test]
    fn a_file_appears_only_when_finished() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("out");
        let written = |content: &[u8]| {
            let mut file = PendingFile::new(&path).expect("a writable folder");
            file.write_all(content).expect("written");
            file
        };
        drop(written(b"a"));
        assert_eq!(fs::read_dir(dir.path()).expect("readable").count(), 0);
        written(b"b").finish().expect("renamed");
        drop(written(b"c"));
        assert_eq!(fs::read_to_string(&path).expect("there"), "b");
        assert_eq!(fs::read_dir(dir.path()).expect("readable").count(), 1, "nothing temporary remains");
    }
}
