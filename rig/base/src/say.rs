//! What is said on stderr, and how text of files and of other programs is printed anywhere.

use std::borrow::Cow;
use std::fmt::{Display, Write as _};
use std::io::Write as _;

/// Says a line to whoever listens on stderr. Who does not listen, or cannot, ends nothing.
pub fn say(line: impl Display) {
    let line = line.to_string();
    let _ = writeln!(std::io::stderr(), "{}", printable(&line));
}

/// A text as one line that does nothing to a terminal: what would steer it, break the line or turn its direction is
/// told by its escape.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let escaped = |mut line: String, c: char| {
        // Writing to a string cannot fail.
        let _ = if steers(c) { write!(line, "{}", c.escape_default()) } else { line.write_char(c) };
        line
    };
    Cow::Owned(text.chars().fold(String::new(), escaped))
}

/// As [`printable`], of a text of several lines.
pub fn printable_lines(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

fn steers(c: char) -> bool {
    c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_told_by_its_escape() {
        assert_eq!(printable("a\u{1b}[2J\nb\tc\u{9b}\u{202e}"), "a\\u{1b}[2J\\nb\\tc\\u{9b}\\u{202e}");
        assert_eq!(printable("Fußgänger 'n' \"m\" \\ 3"), "Fußgänger 'n' \"m\" \\ 3");
        assert_eq!(printable_lines("a\r\nb"), "a\\r\nb");
    }
}
