//! Results under a hidden name until they are complete. What a killed process had begun of a result is
//! removed when that result is begun again.

use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, IntoInnerError, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use tempfile::{Builder, NamedTempFile, TempDir};

use super::{create_folder, folder_of, make_readable};

/// How many characters end a hidden name.
const RANDOM_CHARACTERS: usize = 6;

/// A file that gets its name only when it is complete; dropped before, nothing remains.
pub struct PendingFile {
    temporary: BufWriter<NamedTempFile>,
    path: PathBuf,
    _claim: Option<Claim>,
}

impl PendingFile {
    /// Starts a file.
    pub fn new(path: &Path) -> anyhow::Result<Self> {
        let (temporary, claim) = begin(path, |builder, folder| builder.tempfile_in(folder))?;
        make_readable(temporary.path(), 0o644)?;
        Ok(Self { temporary: BufWriter::new(temporary), path: path.to_owned(), _claim: claim })
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

/// Writes a file in one step, as a [`PendingFile`].
pub fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut file = PendingFile::new(path)?;
    file.write_all(bytes)?;
    file.finish()
}

/// A folder that gets its name only when it is complete; dropped before, nothing remains.
pub struct PendingFolder {
    temporary: TempDir,
    path: PathBuf,
    _claim: Option<Claim>,
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
        create_folder(&folder_of(path))?;
        let (temporary, claim) = begin(path, |builder, folder| builder.tempdir_in(folder))?;
        Ok(Self { temporary, path: path.to_owned(), _claim: claim })
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

/// A locked file or folder: a sign that its process still runs, which ends with the process.
type Claim = File;

/// Begins something under a hidden name beside a result. Where the file system knows no locks there is no
/// claim, and nothing is ever swept.
fn begin<T: AsRef<Path>>(
    path: &Path,
    make: impl Fn(&Builder<'_, '_>, &Path) -> io::Result<T>,
) -> anyhow::Result<(T, Option<Claim>)> {
    let (folder, prefix) = (folder_of(path), prefix(path));
    sweep(&folder, &prefix);
    loop {
        let begun = make(Builder::new().prefix(&prefix).rand_bytes(RANDOM_CHARACTERS), &folder)
            .with_context(|| folder.display().to_string())?;
        let claim = match File::open(&begun) {
            Ok(claim) => claim,
            Err(e) if e.kind() == io::ErrorKind::NotFound => continue,
            Err(_) => return Ok((begun, None)),
        };
        match claim.try_lock() {
            Ok(()) if begun.as_ref().exists() => return Ok((begun, Some(claim))),
            // Another process took it for a leftover before it was locked.
            Ok(()) | Err(TryLockError::WouldBlock) => {}
            Err(TryLockError::Error(_)) => return Ok((begun, None)),
        }
    }
}

/// How the hidden names of a result begin. Names may not be longer than 255 bytes.
fn prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    format!(".aeye-{}-", name.chars().take(40).collect::<String>())
}

/// Removes what processes that are gone had begun of a result, where that is possible.
fn sweep(folder: &Path, prefix: &str) {
    let is_hidden = |name: &str| name.strip_prefix(prefix).is_some_and(|rest| rest.len() == RANDOM_CHARACTERS);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| is_hidden(&entry.file_name().to_string_lossy())) {
        let path = entry.path();
        let Ok(claim) = File::open(&path) else { continue };
        if claim.try_lock().is_ok() {
            let _ = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_process_that_is_gone_had_begun_is_removed() {
        let dir = tempfile::tempdir().expect("a folder");
        let (path, other) = (dir.path().join("out"), dir.path().join("out-2"));
        let at = |name: &str| dir.path().join(name);
        fs::create_dir(at(".aeye-out-abcdef")).expect("writable");
        fs::write(at(".aeye-out-abcdef/half"), "").expect("writable");
        fs::write(at(".aeye-out-ghijkl"), "").expect("writable");
        fs::write(at(".aeye-out-2-mnopqr"), "").expect("writable");
        let folder = PendingFolder::new(&path).expect("free");
        assert!(!at(".aeye-out-abcdef").exists() && !at(".aeye-out-ghijkl").exists());
        assert!(at(".aeye-out-2-mnopqr").exists(), "is of another result");
        let _file = PendingFile::new(&other).expect("free");
        assert!(!at(".aeye-out-2-mnopqr").exists());
        let _another = PendingFolder::new(&path).expect("free");
        assert!(folder.path().exists(), "its process still runs");
        PendingFolder::new(&dir.path().join("n".repeat(255))).expect("the longest name there may be");
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
