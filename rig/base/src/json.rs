//! Results as JSON, each with its type and version.

use serde::Serialize;

/// Version of everything that `--json` prints; raised when a field changes its meaning or goes.
pub const JSON_VERSION: u32 = 2;

/// What is written as JSON, under a name that stays. docs/json.md lists all of them.
pub trait Typed: Serialize {
    /// `aeye.` and the command, with what more tells it from others.
    const TYPE: &'static str;
}

/// Every JSON begins with what it is.
#[derive(Serialize)]
struct Envelope<'a, T> {
    r#type: &'static str,
    version: u32,
    #[serde(flatten)]
    value: &'a T,
}

impl<'a, T: Typed> Envelope<'a, T> {
    fn of(value: &'a T) -> Self {
        Self { r#type: T::TYPE, version: JSON_VERSION, value }
    }
}

/// One line of JSON with its `type` and `version`.
pub fn json_line<T: Typed>(value: &T) -> anyhow::Result<String> {
    Ok(serde_json::to_string(&Envelope::of(value))?)
}

/// Indented JSON with its `type` and `version`, for files.
pub fn json_file<T: Typed>(value: &T) -> anyhow::Result<String> {
    let mut text = serde_json::to_string_pretty(&Envelope::of(value))?;
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_says_what_it_is() {
        #[derive(Serialize)]
        struct Ticks {
            ticks: u64,
        }
        impl Typed for Ticks {
            const TYPE: &'static str = "aeye.ticks";
        }
        let line = json_line(&Ticks { ticks: 3 }).expect("serialises");
        assert_eq!(line, r#"{"type":"aeye.ticks","version":2,"ticks":3}"#);
    }
}
