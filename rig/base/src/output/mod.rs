//! Files that appear only when they are whole.

mod folder;
mod pending;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

pub use folder::OutputFolder;
pub use pending::{PendingFile, PendingFolder, write_file};

/// Writes a file in one step where no other process writes: under the one hidden name that it has each time, so that
/// what a killed process left goes without a look at the folder, which may hold thousands.
pub fn write_claimed(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let hidden = path.with_file_name(format!(".aeye-{name}"));
    let written = fs::write(&hidden, bytes).and_then(|()| fs::rename(&hidden, path));
    written.with_context(|| {
        let _ = fs::remove_file(&hidden);
        path.display().to_string()
    })
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

/// Refuses a place where no file can be written, before the work whose result it is for.
pub fn check_file(path: &Path) -> anyhow::Result<()> {
    let folder = folder_of(path);
    if path.is_dir() || path.as_os_str().as_encoded_bytes().ends_with(b"/") {
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

/// Refuses a place inside a folder that is there.
pub fn check_outside(path: &Path, folder: &Path) -> anyhow::Result<()> {
    let context = || path.display().to_string();
    let absolute = std::path::absolute(path).with_context(context)?;
    let there = absolute.ancestors().find(|above| above.exists()).unwrap_or(&absolute);
    let folder_there = folder.canonicalize().with_context(|| folder.display().to_string())?;
    if there.canonicalize().with_context(context)?.starts_with(folder_there) {
        bail!("{}: lies inside {}; expected a place outside of it", path.display(), folder.display());
    }
    Ok(())
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
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
    fn what_a_killed_process_had_begun_of_a_file_goes_with_the_next_one() {
        let dir = tempfile::tempdir().expect("a folder");
        let at = |name: &str| dir.path().join(name);
        let names = || {
            let mut names: Vec<_> = fs::read_dir(dir.path()).expect("readable").map(|e| e.expect("one")).collect();
            names.sort_by_key(fs::DirEntry::file_name);
            names.into_iter().map(|entry| entry.file_name().into_string().expect("UTF-8")).collect::<Vec<_>>()
        };
        for begun in [".aeye-a.json-abcdef", ".aeye-b.png", ".aeye-c-ghijkl"] {
            fs::write(at(begun), "half").expect("writable");
        }
        write_file(&at("a.json"), b"a").expect("writable");
        write_claimed(&at("b.png"), b"b").expect("writable");
        assert_eq!(names(), [".aeye-c-ghijkl", "a.json", "b.png"]);
        assert_eq!(fs::read(at("b.png")).expect("there"), b"b");
        fs::create_dir(at("folder")).expect("writable");
        let said = format!("{:#}", write_claimed(&at("folder"), b"c").expect_err("is a folder"));
        assert!(said.contains("folder: ") && names().len() == 4, "{said}");
    }

    #[test]
    fn places_inside_are_told_from_places_beside() {
        let dir = tempfile::tempdir().expect("a folder");
        let at = |name: &str| dir.path().join(name);
        fs::create_dir_all(at("a/b")).expect("writable");
        assert!(check_outside(&at("a/new/er"), &at("a")).is_err());
        assert!(check_outside(&at("a/b/../c"), &at("a")).is_err());
        check_outside(&at("ab"), &at("a")).expect("beside");
        check_outside(&at("a/c"), &at("a/b")).expect("beside");
    }
}
