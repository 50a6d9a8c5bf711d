//! Keys of the operators.

/// A key went down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Press {
    /// Enter.
    Enter,
    /// Escape.
    Escape,
    /// Backspace.
    Backspace,
    /// Any other key.
    Text {
        /// What it types into a comment.
        text: String,
        /// The operators' letter or digit that it stands for; none of a seat's key, whatever that types.
        command: Option<char>,
    },
}
