//! Files that are the same as another.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::bail;
use kernel::time::Tick;
use replay::Recording;

/// A file, whichever way leads to it.
#[derive(Debug, PartialEq, Eq, Hash)]
pub enum Place {
    #[cfg(unix)]
    /// Where it lies on its disk.
    Disk {
        /// Number of the disk.
        device: u64,
        /// Number of the file there.
        inode: u64,
    },
    /// The way to it without links.
    Path(PathBuf),
}

impl Place {
    /// That of a path.
    pub fn of(path: &Path) -> Self {
        #[cfg(unix)]
        if let Ok(found) = path.metadata() {
            use std::os::unix::fs::MetadataExt;
            return Self::Disk { device: found.dev(), inode: found.ino() };
        }
        Self::Path(fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()))
    }
}

/// What makes a file the same as another: its bytes, or the recording and tick of the case that it is.
type Identity = ([u8; 32], Option<Tick>);

/// What is remembered of a file that was opened.
pub struct Opened {
    /// BLAKE3 of the file.
    pub digest: [u8; 32],
    /// Whether it is a corner case.
    pub is_case: bool,
    identity: Identity,
}

impl Opened {
    /// Reads a file, every byte of which is checked.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let recording = Recording::open(path)?;
        let digest = recording.digest();
        let case = recording.log().manifest.case.as_ref();
        let identity = case.map_or((digest, None), |case| (case.source, Some(case.to)));
        Ok(Self { digest, is_case: case.is_some(), identity })
    }
}

/// The files that were met so far.
#[derive(Default)]
pub struct Twins(HashMap<Identity, PathBuf>);

impl Twins {
    /// Refuses the twin of a file: the same case twice would count twice.
    pub fn meet(&mut self, path: &Path, opened: Opened) -> anyhow::Result<Opened> {
        if let Some(twin) = self.0.get(&opened.identity) {
            let what = if opened.is_case { "case" } else { "recording" };
            bail!("{}: holds the same {what} as {}; expected each once", path.display(), twin.display());
        }
        self.0.insert(opened.identity, path.to_owned());
        Ok(opened)
    }
}
