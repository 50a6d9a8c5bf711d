//! Why there is no map.

/// Why a text is not a usable map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {reason}")]
pub struct BakeError {
    /// Where in the file: a line, a road, or the whole document.
    pub place: String,
    /// What is wrong, and what was expected.
    pub reason: String,
}
