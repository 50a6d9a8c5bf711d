//! Why a text is no story.

/// Longest reason, characters.
const MOST: usize = 400;

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
    /// Whatever a text has in it, a refusal is one sentence.
    pub(crate) fn at(line: u32, reason: String) -> Self {
        let mut short: String = reason.chars().filter(|c| !c.is_control()).take(MOST).collect();
        if reason.chars().nth(MOST).is_some() {
            short.push_str("...");
        }
        Self { line, reason: short }
    }
}
