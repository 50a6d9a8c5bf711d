//! Why a text is no story.

/// Why a text is no story that can be played: one sentence with its line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct StoryError {
    /// Line of the text, from 1 on.
    pub line: u32,
    /// What does not fit.
    pub reason: String,
}

impl StoryError {
    pub(crate) fn at(line: u32, reason: String) -> Self {
        Self { line, reason }
    }
}
