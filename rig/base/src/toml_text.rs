//! Reads TOML; what is wrong with it is one sentence that names the line.

use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue};

/// What a text holds.
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    toml::from_str(text).map_err(|error| {
        let line = line_at(text, error.span().map_or(0, |span| span.start));
        format!("line {line}: {}", error.message().replace('\n', " "))
    })
}

/// The line where a key such as `ego.lane` has its value, if it has one.
pub fn line_of(text: &str, key: &str) -> Option<usize> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut at = None;
    for part in key.split('.') {
        let (_, value) = table.iter().find(|(name, _)| name.get_ref() == part)?;
        at = Some(value.span().start);
        if let DeValue::Table(inner) = value.get_ref() {
            table = inner;
        }
    }
    at.map(|at| line_at(text, at))
}

fn line_at(text: &str, at: usize) -> usize {
    1 + text.bytes().take(at).filter(|&byte| byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_found_however_it_is_written() {
        assert_eq!(line_of("map = \"m\"\n\n[ego]\ns_m = 1\nlane = 3\n", "ego.lane"), Some(5));
        assert_eq!(line_of("ego.s_m = 1\nego.lane = 3\n", "ego.lane"), Some(2));
        assert_eq!(line_of("ego = { lane = 3 }\n", "ego.lane"), Some(1));
        assert_eq!(line_of("map = \"ego\"\n", "ego.lane"), None);
    }
}
