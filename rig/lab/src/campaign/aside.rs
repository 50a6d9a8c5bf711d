//! Where the files of runs wait for their turn. Only then it is known whether a run counts, so they are no results
//! yet; but a campaign that is killed does not have to drive them again.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use base::output;

use crate::store::remove_folder;

/// `OUT/.waiting/CHECKPOINT`; it is gone when the checkpoint has driven enough.
pub struct Aside {
    folder: PathBuf,
}

impl Aside {
    /// That of a checkpoint.
    pub fn new(out: &Path, checkpoint: &str) -> Self {
        Self { folder: out.join(".waiting").join(checkpoint) }
    }

    /// Where a result waits.
    pub fn place(&self, result: &Path) -> PathBuf {
        self.folder.join(result.file_name().unwrap_or_default())
    }

    /// Where a result is: in its place, or where it waits if it is not there.
    pub fn find(&self, result: &Path) -> PathBuf {
        if result.exists() { result.to_owned() } else { self.place(result) }
    }

    /// Lets a result wait.
    pub fn put(&self, result: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        fs::create_dir_all(&self.folder).with_context(|| self.folder.display().to_string())?;
        output::write_file(&self.place(result), bytes)
    }

    /// Gives a result its place, unless it is there.
    pub fn release(&self, result: &Path) -> anyhow::Result<()> {
        let waiting = self.place(result);
        if !waiting.exists() {
            return Ok(());
        }
        fs::rename(&waiting, result).with_context(|| result.display().to_string())
    }

    /// Drops whatever waits, as nothing of it counts.
    pub fn clear(&self) -> anyhow::Result<()> {
        remove_folder(&self.folder)?;
        // That of other checkpoints stays.
        let _ = self.folder.parent().map(fs::remove_dir);
        Ok(())
    }
}
