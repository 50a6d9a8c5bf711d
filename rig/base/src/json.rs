//! Results as JSON, each with its type and version.

use anyhow::ensure;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Version of everything that `--json` prints; raised when a field changes its meaning or goes.
pub const JSON_VERSION: u32 = 3;

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

/// What a text of [`json_file`] holds. One that says that it is something else, or of a later version, is refused.
pub fn read_json<T: Typed + DeserializeOwned>(text: &str) -> anyhow::Result<T> {
    #[derive(Deserialize)]
    struct Header {
        r#type: Option<String>,
        version: Option<u64>,
    }
    let Header { r#type, version } = serde_json::from_str(text)?;
    if let Some(found) = r#type {
        ensure!(found == T::TYPE, "its type is {found:?}, expected {:?}", T::TYPE);
    }
    if let Some(found) = version {
        ensure!(found <= u64::from(JSON_VERSION), "its version is {found}, expected at most {JSON_VERSION}");
    }
    Ok(serde_json::from_str(text)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_says_what_it_is() {
        #[derive(Debug, PartialEq, Serialize, Deserialize)]
        struct Ticks {
            ticks: u64,
        }
        impl Typed for Ticks {
            const TYPE: &'static str = "aeye.ticks";
        }
        let line = json_line(&Ticks { ticks: 3 }).expect("serialises");
        assert_eq!(line, r#"{"type":"aeye.ticks","version":3,"ticks":3}"#);
        assert_eq!(read_json::<Ticks>(&line).expect("as written"), Ticks { ticks: 3 });
        let refused = |from: &str, to: &str| {
            let said = read_json::<Ticks>(&line.replace(from, to)).expect_err("another").to_string();
            assert!(said.contains("expected"), "{said}");
        };
        refused("aeye.ticks", "aeye.clocks");
        refused("\"version\":3", "\"version\":99999999999");
    }
}
