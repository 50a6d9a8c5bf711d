//! A log read back from its file.

use std::path::Path;
use std::sync::Arc;

use kernel::RoadNetwork;

use crate::{Error, Log};

/// A recording or case whose bytes have all been checked.
#[derive(Clone, Debug)]
pub struct Recording {
    log: Log,
    finished: bool,
    digest: [u8; 32],
}

impl Recording {
    /// Reads a file. Any changed byte is an error that says where; a file whose writer was stopped is
    /// read up to its last whole block ([`Recording::finished`] tells).
    pub fn open(path: &Path) -> Result<Self, Error> {
        Self::from_bytes(&std::fs::read(path).map_err(|e| Error::from(e).within(path))?).map_err(|e| e.within(path))
    }

    /// As [`Recording::open`], from memory.
    pub fn from_bytes(_bytes: &[u8]) -> Result<Self, Error> {
        todo!()
    }

    /// The content.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// Whether the writer came to its end; if not, up to a second is missing.
    pub fn finished(&self) -> bool {
        self.finished
    }

    /// blake3 of the file.
    pub fn digest(&self) -> [u8; 32] {
        self.digest
    }

    /// The map of the run: a bundled one, or the one embedded in the log; its digest is checked.
    pub fn network(&self) -> Result<Arc<RoadNetwork>, Error> {
        todo!()
    }
}
