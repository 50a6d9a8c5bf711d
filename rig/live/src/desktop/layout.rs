//! Where the windows were last time. A convenience: whatever is wrong with it, the windows open.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::Context;
use base::files::{self, most};
use base::output;
use base::say::say;
use serde::{Deserialize, Serialize};

/// Places of windows by their titles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Layout(BTreeMap<String, Placement>);

/// Where a window is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// Left and upper edge, pixels.
    pub position: [i32; 2],
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Whether it fills the monitor on which it is.
    pub full_screen: bool,
}

impl Layout {
    /// What the user's file holds. When it cannot be read that is said, and the layout is empty.
    pub fn of_user() -> Self {
        let read = user_file().map_or_else(|| Ok(Self::default()), |path| Self::read(&path));
        read.unwrap_or_else(|error| {
            say(format_args!("{error:#}; the windows open where they would at first"));
            Self::default()
        })
    }

    /// Writes the user's file; that it cannot be written is said.
    pub fn keep(&self) {
        if let Some(Err(error)) = user_file().map(|path| self.write(&path)) {
            say(format_args!("{error:#}; the windows' places are not kept"));
        }
    }

    /// Where a window was.
    pub fn get(&self, title: &str) -> Option<Placement> {
        self.0.get(title).copied()
    }

    /// Where a window is.
    pub fn set(&mut self, title: &str, placement: Placement) {
        self.0.insert(title.to_owned(), placement);
    }

    fn read(path: &Path) -> anyhow::Result<Self> {
        let Some(text) = files::read_text_if_there(path, most::TEXT)? else { return Ok(Self::default()) };
        toml::from_str(&text).with_context(|| format!("{}: not a layout of windows", path.display()))
    }

    fn write(&self, path: &Path) -> anyhow::Result<()> {
        let text = toml::to_string(self).context("a layout as TOML")?;
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        }
        output::write_file(path, text.as_bytes())
    }
}

/// Below `XDG_CONFIG_HOME`, else below `.config` of `HOME`; none without both.
fn user_file() -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let config = folder("XDG_CONFIG_HOME").or_else(|| Some(folder("HOME")?.join(".config")))?;
    Some(config.join("aeye").join("layout.toml"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layout_comes_back_and_nonsense_is_said() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("config/aeye/layout.toml");
        assert_eq!(Layout::read(&path).expect("none yet"), Layout::default());
        let placement = Placement { position: [-1920, 12], size: [640, 360], full_screen: true };
        let mut layout = Layout::default();
        layout.set("A-Eye: safety driver", placement);
        layout.write(&path).expect("written");
        let read = Layout::read(&path).expect("there");
        assert_eq!((read.get("A-Eye: safety driver"), read.get("another")), (Some(placement), None));
        std::fs::write(&path, "safety = 3").expect("written");
        let said = format!("{:#}", Layout::read(&path).expect_err("nonsense"));
        assert!(said.contains("layout.toml: not a layout"), "{said}");
    }
}
