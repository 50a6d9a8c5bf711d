//! What can go wrong with a log.

use std::path::{Path, PathBuf};

use crate::layout::{FORMAT_VERSION, OLDEST_VERSION};
use crate::program::release;

/// Why a log could not be written, read or replayed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file named, and what is wrong with it.
    #[error("{}: {error}", path.display())]
    In {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: Box<Error>,
    },
    /// The bytes are no log, or not the ones that were written.
    #[error("damaged at {place}: {reason}")]
    Damaged {
        /// Where: a byte offset, and the record there.
        place: String,
        /// What is wrong, and what was expected.
        reason: String,
    },
    /// A valid file of a kind that this version cannot read, or that is not what was asked for.
    #[error("{0}")]
    Unsuited(String),
    /// A log of a layout that this version does not know.
    #[error("layout version {version}; this program reads versions {OLDEST_VERSION} to {FORMAT_VERSION}")]
    Layout {
        /// Version of the file.
        version: u16,
    },
    /// Only the kernel that made a log can drive it again.
    #[error(
        "made by kernel {made}, this is {this}; only the kernel that made a log can drive it again{}",
        release(program.as_deref())
    )]
    Kernel {
        /// [`kernel::identity`] of the writer.
        made: String,
        /// [`kernel::identity`] of this program.
        this: String,
        /// The program that has it, where the log names it.
        program: Option<String>,
    },
    /// The foreign map of the log is not at hand.
    #[error("its map {map} is not in it, and {file} is not beside it")]
    NoMap {
        /// Name of the map.
        map: String,
        /// Name that the map's file would have.
        file: String,
    },
    /// What [`crate::Exporter`] wrote for viewers.
    #[error("is an export of aeye for viewers, not a recording")]
    Export,
    /// The log asks for another map than the one at hand.
    #[error("map {map}: the log was made on the map with digest {expected:032x}, this one has {got:032x}")]
    Map {
        /// Name of the map.
        map: String,
        /// Digest in the manifest.
        expected: u128,
        /// Digest of the map given.
        got: u128,
    },
    /// The map in the log is no usable map.
    #[error("map in the log: {0}")]
    Bake(#[from] kernel::map::BakeError),
    /// The world cannot start from the log.
    #[error(transparent)]
    World(#[from] kernel::WorldError),
    /// The replay is not the run that was recorded.
    #[error(transparent)]
    Diverged(#[from] Box<crate::Divergence>),
    /// Reading or writing failed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

impl Error {
    pub(crate) fn damaged(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Damaged { place: place.into(), reason: reason.into() }
    }

    pub(crate) fn within(self, path: &Path) -> Self {
        Self::In { path: path.to_owned(), error: Box::new(self) }
    }
}
