//! Maps by the names that people give on the command line.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, anyhow};
use kernel::map::{BUNDLED, bake, bundled, bundled_text};
use kernel::{RoadNetwork, Scenario};
use replay::ForeignMap;

use crate::failure::Usage;
use crate::files::{self, check_name, most};
use crate::output;

/// A map to drive on.
#[derive(Clone, Debug)]
pub struct Map {
    /// Its roads.
    pub network: Arc<RoadNetwork>,
    /// Its OpenDRIVE file, when it is not a bundled one.
    pub foreign: Option<ForeignMap>,
    /// Where that is, if it was found by its path.
    pub path: Option<PathBuf>,
}

impl Map {
    /// A bundled map by name, or an OpenDRIVE file by its path.
    pub fn find(name: &str) -> anyhow::Result<Self> {
        if let Some(network) = bundled(name) {
            return Ok(Self { network, foreign: None, path: None });
        }
        let (stem, text) = foreign(name)?;
        let network = bake(&stem, &text).with_context(|| name.to_owned())?;
        let foreign = Some(ForeignMap::new(text, false));
        Ok(Self { network: Arc::new(network), foreign, path: Some(name.into()) })
    }

    /// Several maps; `all` are the bundled ones.
    pub fn find_all(names: &[String]) -> anyhow::Result<Vec<Self>> {
        let all = || BUNDLED.map(str::to_owned).to_vec();
        let names = names.iter().flat_map(|n| if n == "all" { all() } else { vec![n.clone()] });
        names.map(|name| Self::find(&name)).collect()
    }

    /// The map, whose file is to stand in recordings instead of beside them, if it is a foreign one.
    pub fn embedded(mut self) -> Self {
        self.foreign.iter_mut().for_each(|map| map.embedded = true);
        self
    }

    /// The default scenario of the map for a seed.
    pub fn scenario(&self, seed: u64) -> Scenario {
        Scenario::default_for(&self.network.name, seed)
    }
}

/// What a map is called, and its OpenDRIVE text: of a bundled map by name, or of a file by its path.
pub fn text_of(name: &str) -> anyhow::Result<(String, Cow<'static, str>)> {
    match bundled_text(name) {
        Some(text) => Ok((name.to_owned(), text.into())),
        None => foreign(name).map(|(stem, text)| (stem, text.into())),
    }
}

/// The stem and the text of an OpenDRIVE file.
fn foreign(name: &str) -> anyhow::Result<(String, String)> {
    if !Path::new(name).extension().is_some_and(|e| e.eq_ignore_ascii_case("xodr")) {
        let known = BUNDLED.join(", ");
        return Err(Usage(format!("unknown map {name:?}: expected one of {known}, or an .xodr file")).into());
    }
    let text = files::read_text(Path::new(name), most::MAP)?;
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    check_name(&stem).map_err(|reason| anyhow!("{name}: {reason}"))?;
    Ok((stem.into_owned(), text))
}

/// Writes the file of a foreign map beside a recording, unless it is there, or in the recording itself.
pub fn put_beside(map: Option<&ForeignMap>, recording: &Path) -> anyhow::Result<()> {
    let Some(map) = map.filter(|map| !map.embedded) else { return Ok(()) };
    let path = recording.with_file_name(map.file_name());
    match &map.text {
        Some(text) if !path.exists() => output::write_file(&path, text.as_bytes()),
        _ => Ok(()),
    }
}
