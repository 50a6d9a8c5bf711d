//! Maps and scenarios by the names that people give on the command line.

use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, anyhow};
use kernel::map::{BUNDLED, bake, bundled, bundled_text};
use kernel::scenario::{HazardRates, TrafficCounts};
use kernel::story::Story;
use kernel::{RoadNetwork, Scenario};
use replay::ForeignMap;

use crate::failure::{Usage, sentence};
use crate::files::{self, check_name, most};
use crate::say::say;
use crate::{output, toml_text};

/// Most files of catalogs of a story.
const CATALOGS: usize = 200;

/// A map to drive on.
#[derive(Clone, Debug)]
pub struct Map {
    /// Its roads.
    pub network: Arc<RoadNetwork>,
    /// Its OpenDRIVE file, when it is not a bundled one.
    pub foreign: Option<ForeignMap>,
}

impl Map {
    /// A bundled map by name, or an OpenDRIVE file by its path.
    pub fn find(name: &str) -> anyhow::Result<Self> {
        if let Some(network) = bundled(name) {
            return Ok(Self { network, foreign: None });
        }
        let (stem, text) = foreign(name)?;
        let network = bake(&stem, &text).with_context(|| name.to_owned())?;
        Ok(Self { network: Arc::new(network), foreign: Some(ForeignMap::new(text, false)) })
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

/// A scenario that was read from a file, and its map.
#[derive(Clone, Debug)]
pub struct ScenarioFile {
    /// What it holds.
    pub scenario: Scenario,
    /// The map that it names.
    pub map: Map,
    path: PathBuf,
    text: String,
}

impl ScenarioFile {
    /// Reads one; a map file is looked for beside it.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let text = files::read_text(path, most::TEXT)?;
        let is_story = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xosc"));
        let read = if is_story { of_story(path, &text) } else { Scenario::from_toml(&text).map_err(|e| e.to_string()) };
        let mut scenario = read.map_err(|reason| usage_in(path, &reason))?;
        let map = map_of(&scenario, path).map_err(|error| {
            let line = if is_story { line_of_map(&text) } else { toml_text::line_of(&text, "map") };
            let place = line.map_or("map".into(), |line| format!("line {line}: map"));
            match error.downcast::<Usage>() {
                Ok(usage) => usage_in(path, &format!("{place}: {usage}")),
                Err(error) => error.context(format!("{}: {place}", path.display())),
            }
        })?;
        scenario.map = map.network.name.clone();
        Ok(Self { scenario, map, path: path.to_owned(), text })
    }

    /// A refusal of the file.
    pub fn refusal(&self, reason: &str) -> anyhow::Error {
        usage_in(&self.path, reason)
    }

    /// Refuses a map on which the ego car cannot start where the file says.
    pub fn check_start(&self, map: &Map) -> anyhow::Result<()> {
        self.scenario.start_on(&map.network).map(drop).map_err(|error| {
            let line = error.key.and_then(|key| toml_text::line_of(&self.text, key));
            let reason = line.map_or(error.reason.clone(), |line| format!("line {line}: {}", error.reason));
            usage_in(&self.path, &reason)
        })
    }
}

/// The map of a scenario in a file, beside which a map file is looked for, too.
fn map_of(scenario: &Scenario, file: &Path) -> anyhow::Result<Map> {
    let folder = file.parent().unwrap_or(Path::new(""));
    // Files of stories name maps in folders that nobody else has.
    let plain = Path::new(&scenario.map).file_name().filter(|_| scenario.story.is_some());
    let beside = [Some(folder.join(&scenario.map)), plain.map(|name| folder.join(name))];
    let found = beside.into_iter().flatten().find(|path| path.is_file());
    Map::find(&found.map_or(scenario.map.clone(), |path| path.to_string_lossy().into_owned()))
}

/// What a story in OpenSCENARIO XML begins with: nobody but those who play, who make no mistakes of their own.
fn of_story(path: &Path, text: &str) -> Result<Scenario, String> {
    let text = Story::with_catalogs(text, &catalogs(path, text)?).map_err(|error| error.to_string())?;
    let story = Story::read(&text).map_err(|error| error.to_string())?;
    for (line, element) in story.passed_over() {
        say(format!("{}: line {line}: <{element}> is passed over", path.display()));
    }
    let file = story.map_file().to_owned();
    // Maps that come with A-Eye need no file.
    let stem = Path::new(&file).file_stem().unwrap_or_default().to_string_lossy();
    let is_there = path.parent().unwrap_or(Path::new("")).join(&file).is_file();
    let map = if !is_there && bundled_text(&stem).is_some() { stem.into_owned() } else { file };
    let (traffic, hazards) = (TrafficCounts::NONE, HazardRates::NONE);
    let mut scenario = Scenario { traffic, hazards, ..Scenario::default_for(&map, 1) };
    scenario.play(story);
    Ok(scenario)
}

/// The files of a story's catalogs that are there, and their texts.
fn catalogs(path: &Path, text: &str) -> Result<Vec<(String, String)>, String> {
    let mut files = Vec::new();
    for folder in Story::catalog_folders(text) {
        let folder = path.parent().unwrap_or(Path::new("")).join(folder);
        let there = fs::read_dir(&folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
        files.extend(there.filter(|file| file.extension().is_some_and(|e| e.eq_ignore_ascii_case("xosc"))));
    }
    files.sort();
    files.dedup();
    if files.len() > CATALOGS {
        return Err(format!("expected at most {CATALOGS} files of catalogs, but there are {}", files.len()));
    }
    let text = |file: PathBuf| {
        let text = files::read_text(&file, most::TEXT).map_err(|error| sentence(&error))?;
        Ok((file.display().to_string(), text))
    };
    files.into_iter().map(text).collect()
}

/// The line on which a story names its map.
fn line_of_map(text: &str) -> Option<usize> {
    text.lines().position(|line| line.contains("<LogicFile")).map(|at| at + 1)
}

fn usage_in(path: &Path, reason: &str) -> anyhow::Error {
    anyhow!(Usage(format!("{}: {reason}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_that_cannot_be_had_is_told_with_the_place_of_its_name() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("run.toml");
        fs::write(dir.path().join("empty.xodr"), "").expect("writable");
        for (map, is_usage, said) in [
            ("atlantis", true, "unknown map \"atlantis\": expected one of city, rural, old_town, "),
            ("nowhere.xodr", false, "nowhere.xodr: "),
            ("empty.xodr", false, "empty.xodr: "),
        ] {
            fs::write(&path, format!("seed = 1\nmap = {map:?}\n")).expect("writable");
            let error = ScenarioFile::read(&path).expect_err(map);
            let (place, sentence) = (format!("{}: line 2: map: ", path.display()), sentence(&error));
            assert!(sentence.starts_with(&place) && sentence.contains(said), "{sentence}");
            assert_eq!((error.is::<Usage>(), sentence.matches("run.toml").count()), (is_usage, 1), "{sentence}");
        }
    }
}
