//! The folder that a command fills for a while.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::create_folder;
use crate::failure::InUse;

/// A folder of results while its command works there: no other process can have it, or only such as share it. Dropped,
/// folders that were made for it and hold nothing are gone.
#[derive(Debug)]
pub struct OutputFolder {
    /// Outer ones first.
    made: Mutex<Vec<PathBuf>>,
    /// Locked as long as its process works here; none where the file system knows no locks.
    _claim: Option<File>,
}

impl OutputFolder {
    /// Takes a folder, which is made with those above it unless it is there.
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        Self::take(path, File::try_lock)
    }

    /// Takes it together with others who share it, and keeps out who wants it alone.
    pub fn share(path: &Path) -> anyhow::Result<Self> {
        Self::take(path, File::try_lock_shared)
    }

    fn take(path: &Path, lock: Lock) -> anyhow::Result<Self> {
        loop {
            let folder = Self { made: Mutex::default(), _claim: None };
            folder.make(path)?;
            let claim = claim(path, lock)?;
            // One whose process just ended may be gone with it.
            if path.is_dir() {
                return Ok(Self { made: Mutex::new(folder.take_made()), _claim: claim });
            }
        }
    }

    /// Makes a folder in it with those above, unless it is there.
    pub fn make(&self, path: &Path) -> anyhow::Result<()> {
        let is_new = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let new: Vec<PathBuf> = path.ancestors().take_while(is_new).map(Path::to_owned).collect();
        self.made.lock().unwrap_or_else(PoisonError::into_inner).extend(new.into_iter().rev());
        create_folder(path)
    }

    fn take_made(&self) -> Vec<PathBuf> {
        std::mem::take(&mut *self.made.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        for folder in self.take_made().iter().rev() {
            // One with anything in it stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

type Lock = fn(&File) -> Result<(), TryLockError>;

fn claim(path: &Path, lock: Lock) -> anyhow::Result<Option<File>> {
    let Ok(folder) = File::open(path) else { return Ok(None) };
    match lock(&folder) {
        Ok(()) => Ok(Some(folder)),
        Err(TryLockError::WouldBlock) => {
            let path = path.display();
            Err(InUse(format!("{path}: another aeye is at work there; expected another folder, or to wait")).into())
        }
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_of_one_process_and_goes_where_nothing_came_of_it() {
        let dir = tempfile::tempdir().expect("a folder");
        let at = |name: &str| dir.path().join(name);
        let folder = OutputFolder::open(&at("a/b")).expect("free");
        folder.make(&at("a/b/c/d")).expect("writable");
        let said = OutputFolder::open(&at("a/b")).expect_err("in use").to_string();
        assert!(said.ends_with("a/b: another aeye is at work there; expected another folder, or to wait"), "{said}");
        assert!(at("a/b/c/d").is_dir(), "the other process still runs");
        OutputFolder::open(&at("a")).expect("one above is another");
        drop(folder);
        assert!(!at("a").exists());

        fs::create_dir(at("there")).expect("writable");
        let folder = OutputFolder::open(&at("there")).expect("free again");
        folder.make(&at("there/c/d")).expect("writable");
        fs::write(at("there/c/result"), "").expect("writable");
        drop(folder);
        assert!(at("there/c/result").is_file() && !at("there/c/d").exists());
        drop(OutputFolder::open(&at("there")).expect("free again"));
        assert!(at("there").is_dir(), "is not ours to take away");
    }

    #[test]
    fn who_shares_a_folder_keeps_out_who_wants_it_alone() {
        let dir = tempfile::tempdir().expect("a folder");
        let (one, another) = (OutputFolder::share(dir.path()), OutputFolder::share(dir.path()));
        drop(one.expect("free"));
        OutputFolder::open(dir.path()).expect_err("the other is still there");
        drop(another.expect("shared"));
        let _alone = OutputFolder::open(dir.path()).expect("free again");
        OutputFolder::share(dir.path()).expect_err("somebody has it alone");
    }
}
