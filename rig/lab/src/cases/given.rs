//! The folders of a call, and what their files are called there.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;

/// A folder as it was given, and the way to it without links.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Given {
    given: PathBuf,
    whole: PathBuf,
}

impl Given {
    /// A folder that is there.
    pub fn open(folder: &Path) -> anyhow::Result<Self> {
        let whole = fs::canonicalize(folder).with_context(|| folder.display().to_string())?;
        Ok(Self { given: folder.to_owned(), whole })
    }

    /// The way to it without links.
    pub fn whole(&self) -> &Path {
        &self.whole
    }

    /// What a file below it is called, beginning as the folder was given.
    pub fn shown(&self, absolute: &Path) -> PathBuf {
        absolute.strip_prefix(&self.whole).map_or_else(|_| absolute.to_owned(), |way| self.given.join(way))
    }
}
