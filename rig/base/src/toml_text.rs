//! Reads TOML; what is wrong with it is one sentence that names the line.

use serde::de::DeserializeOwned;

/// What a text holds.
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    toml::from_str(text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start);
        let line = 1 + text.bytes().take(at).filter(|&byte| byte == b'\n').count();
        format!("line {line}: {}", error.message().replace('\n', " "))
    })
}
