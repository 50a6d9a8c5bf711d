//! Reads files that may be anything, of bounded length (see [`intake`]); what is wrong names the file.

use std::io::{ErrorKind, Result};
use std::path::Path;

use anyhow::Context;
pub use intake::{check_name, most};

/// The bytes of a file that holds at most so many.
pub fn read(path: &Path, most: u64) -> anyhow::Result<Vec<u8>> {
    intake::read(path, most).with_context(|| path.display().to_string())
}

/// The text of a file that holds at most so many bytes.
pub fn read_text(path: &Path, most: u64) -> anyhow::Result<String> {
    intake::read_text(path, most).with_context(|| path.display().to_string())
}

/// As [`read_text`]; `None` without such a file.
pub fn read_text_if_there(path: &Path, most: u64) -> anyhow::Result<Option<String>> {
    if_there(intake::read_text(path, most)).with_context(|| path.display().to_string())
}

/// As [`read`]; `None` without such a file.
pub fn read_if_there(path: &Path, most: u64) -> anyhow::Result<Option<Vec<u8>>> {
    if_there(intake::read(path, most)).with_context(|| path.display().to_string())
}

fn if_there<T>(read: Result<T>) -> Result<Option<T>> {
    match read {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        read => read.map(Some),
    }
}
