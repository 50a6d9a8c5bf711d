//! What a command prints, and files that appear only when they are whole.

use std::fs;
use std::io::{self, BufWriter, IntoInnerError, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use serde::Serialize;

/// Version of everything that `--json` prints; raised when a field changes its meaning or goes.
pub const JSON_VERSION: u32 = 2;

#[derive(Serialize)]
struct Versioned<'a, T> {
    version: u32,
    #[serde(flatten)]
    value: &'a T,
}

/// One line of JSON with its `version`.
pub fn json_line<T: Serialize>(value: &T) -> anyhow::Result<String> {
    Ok(serde_json::to_string(&Versioned { version: JSON_VERSION, value })?)
}

/// Indented JSON with its `version`, for files.
pub fn json_file<T: Serialize>(value: &T) -> anyhow::Result<String> {
    let mut text = serde_json::to_string_pretty(&Versioned { version: JSON_VERSION, value })?;
    text.push('\n');
    Ok(text)
}

/// Prints a command's result: one line of JSON, or the text.
pub fn print<T: Serialize>(json: bool, value: &T, text: impl FnOnce() -> String) -> anyhow::Result<()> {
    let line = if json { json_line(value)? } else { text() };
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}").and_then(|()| out.flush()).context("stdout")
}

/// Writes a file in one step: under a temporary name beside it, then renamed.
pub fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    temporary(path, bytes)?.persist(path).with_context(|| path.display().to_string())?;
    Ok(())
}

/// Writes a file in one step under the first of `STEM.ENDING`, `STEM-2.ENDING`, `STEM-3.ENDING` ... that
/// is free, and gives its name. Nothing is ever overwritten.
pub fn write_new(stem: &Path, ending: &str, bytes: &[u8]) -> anyhow::Result<PathBuf> {
    let mut file = temporary(stem, bytes)?;
    for number in 1..100_000 {
        let mut path = stem.as_os_str().to_owned();
        path.push(if number == 1 { format!(".{ending}") } else { format!("-{number}.{ending}") });
        let path = PathBuf::from(path);
        file = match file.persist_noclobber(&path) {
            Ok(_) => return Ok(path),
            Err(e) if e.error.kind() == std::io::ErrorKind::AlreadyExists => e.file,
            Err(e) => return Err(e.error).with_context(|| path.display().to_string()),
        };
    }
    bail!("{}: no number is free", stem.display())
}

/// A file beside a path, with its content, that disappears unless it gets a name.
fn temporary(path: &Path, bytes: &[u8]) -> anyhow::Result<tempfile::NamedTempFile> {
    let folder = folder_of(path);
    let mut file = tempfile::NamedTempFile::new_in(&folder).with_context(|| folder.display().to_string())?;
    file.as_file_mut().write_all(bytes).with_context(|| path.display().to_string())?;
    make_readable(file.path(), 0o644)?;
    Ok(file)
}

/// A file that gets its name only when it is complete; dropped before, nothing remains.
pub struct PendingFile {
    temporary: BufWriter<tempfile::NamedTempFile>,
    path: PathBuf,
}

impl PendingFile {
    /// Starts a file.
    pub fn new(path: &Path) -> anyhow::Result<Self> {
        Ok(Self { temporary: BufWriter::new(temporary(path, &[])?), path: path.to_owned() })
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

/// Refuses a place where no file can be written, before the work whose result it is for.
pub fn check_file(path: &Path) -> anyhow::Result<()> {
    let folder = folder_of(path);
    if path.is_dir() {
        bail!("{}: is a folder; expected a file", path.display());
    }
    if !folder.is_dir() {
        bail!("{}: the folder {} does not exist", path.display(), folder.display());
    }
    tempfile::tempfile_in(&folder).with_context(|| path.display().to_string())?;
    Ok(())
}

/// Makes a folder that results can be written to, with those above it, unless it is there.
pub fn create_folder(path: &Path) -> anyhow::Result<()> {
    if let Some(file) = path.ancestors().find(|above| above.exists()).filter(|above| !above.is_dir()) {
        bail!("{}: is a file; expected a folder", file.display());
    }
    let context = || path.display().to_string();
    fs::create_dir_all(path).with_context(context)?;
    tempfile::tempfile_in(path).with_context(context)?;
    Ok(())
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
}

/// A folder that gets its name only when it is complete; dropped before, nothing remains.
pub struct PendingFolder {
    temporary: tempfile::TempDir,
    path: PathBuf,
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
        let temporary = tempfile::Builder::new().prefix(".aeye-").tempdir_in(&parent);
        Ok(Self { temporary: temporary.with_context(|| parent.display().to_string())?, path: path.to_owned() })
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

/// What is temporary is private; results are not.
fn make_readable(path: &Path, mode: u32) -> anyhow::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(path, fs::Permissions::from_mode(mode)).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn a_new_file_takes_the_first_name_that_is_free() {
        let dir = tempfile::tempdir().expect("a folder");
        let stem = dir.path().join("run.1");
        for (content, name) in [("a", "run.1.png"), ("b", "run.1-2.png"), ("c", "run.1-3.png")] {
            let path = write_new(&stem, "png", content.as_bytes()).expect("writable");
            assert_eq!(path, dir.path().join(name));
        }
        assert_eq!(fs::read_to_string(dir.path().join("run.1.png")).expect("there"), "a");
        assert_eq!(fs::read_dir(dir.path()).expect("readable").count(), 3, "nothing temporary remains");
    }

    #[test]
    fn json_carries_its_version() {
        #[derive(Serialize)]
        struct Ticks {
            ticks: u64,
        }
        assert_eq!(json_line(&Ticks { ticks: 3 }).expect("serialises"), r#"{"version":2,"ticks":3}"#);
    }
}
