//! Scenarios from files: texts of our own, and stories in OpenSCENARIO XML with their catalogs.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use kernel::Scenario;
use kernel::map::bundled_text;
use kernel::scenario::{HazardRates, TrafficCounts};
use kernel::story::{self, Story};

use crate::failure::{Usage, sentence};
use crate::files::{self, most};
use crate::maps::Map;
use crate::say::say;
use crate::{toml_text, words};

/// Most files of catalogs of a story.
const CATALOGS: usize = 200;
/// Longest name in a note, characters.
const LONGEST_NAME: usize = 40;

/// An ego car that begins faster is slowed down by its drivers where the map tells no limit, km/h.
const SOON_SLOWER_KMH: f32 = 51.0;

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
    /// Reads one, or takes the story that comes with A-Eye under that name; a map file is looked for beside it.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let bundled = path.to_str().filter(|_| !path.exists()).and_then(story::bundled_text);
        let is_story = bundled.is_some() || path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xosc"));
        let text = match bundled {
            Some(text) => text.to_owned(),
            None if !path.exists() && path.extension().is_none() => return Err(no_story(path)),
            None => files::read_text(path, if is_story { most::STORY } else { most::TEXT })?,
        };
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
    // CARLA's tell no ending, and some the variant of the map that is drawn in layers.
    let with_ending = plain.filter(|name| Path::new(name).extension().is_none()).map(|name| name.to_string_lossy());
    let with_ending = with_ending.map(|name| folder.join(format!("{}.xodr", name.trim_end_matches("_Opt"))));
    let beside = [Some(folder.join(&scenario.map)), plain.map(|name| folder.join(name)), with_ending];
    // A story that comes with A-Eye has no folder.
    let found = beside.into_iter().flatten().filter(|_| file.exists()).find(|path| path.is_file());
    // Maps that come with A-Eye need no file.
    let stem = plain.map(|name| Path::new(name).with_extension("").to_string_lossy().into_owned());
    let bundled = stem.filter(|stem| bundled_text(stem).is_some());
    let found = found.map(|path| path.to_string_lossy().into_owned()).or(bundled);
    Map::find(&found.unwrap_or_else(|| scenario.map.clone()))
}

/// What a story in OpenSCENARIO XML begins with: nobody but those who play, who make no mistakes of their own.
fn of_story(path: &Path, text: &str) -> Result<Scenario, String> {
    let text = Story::with_catalogs(text, &catalogs(path, text)?).map_err(|error| error.to_string())?;
    let story = Story::read(&text).map_err(|error| error.to_string())?;
    // Of those that come with A-Eye there is nothing to mend.
    if path.exists() {
        notes(&story).into_iter().for_each(|note| say(format!("{}: {note}", path.display())));
    }
    let map = story.map_file().to_owned();
    let (traffic, hazards) = (TrafficCounts::NONE, HazardRates::NONE);
    let mut scenario = Scenario { traffic, hazards, ..Scenario::default_for(&map, 1) };
    scenario.play(story);
    Ok(scenario)
}

/// What is otherwise with a story than its text has it.
fn notes(story: &Story) -> Vec<String> {
    let mut notes = Vec::new();
    let list = |all: Vec<String>| Some(all.join(", ")).filter(|all| !all.is_empty());
    let passed = story.passed_over().iter().map(|(line, element)| format!("<{element}> (line {line})"));
    notes.extend(list(passed.collect()).map(|passed| format!("passed over: {passed}")));
    let short = |name: &str| name.chars().filter(|c| !c.is_control()).take(LONGEST_NAME).collect::<String>();
    let guessed = story.guessed().map(|(name, kind)| format!("{} a {}", short(name), words::road_user(kind)));
    notes.extend(
        list(guessed.collect()).map(|them| format!("of a catalog that is not there, taken by their names: {them}")),
    );
    let ego = &story.script().cast[story.script().ego()].name;
    if !ego.to_lowercase().starts_with("ego") && !ego.eq_ignore_ascii_case("hero") {
        notes.push(format!("{} is taken for the ego car", short(ego)));
    }
    let ego_kmh = story.ego_mps() * 3.6;
    if ego_kmh > SOON_SLOWER_KMH {
        notes.push(format!(
            "the ego car begins at {ego_kmh:.0} km/h; its drivers keep to the limits of the map, 50 km/h where it tells none, and bots to 69 km/h"
        ));
    }
    match story.left_to_drivers() {
        0 => {}
        count => notes.push(format!("{} of the ego car left to its drivers", words::count(count, "action"))),
    }
    notes
}

/// The files of a story's catalogs that are there, and their texts. Those that cannot be read are passed over: no reference may
/// need them.
fn catalogs(path: &Path, text: &str) -> Result<Vec<(String, String)>, String> {
    let mut files = Vec::new();
    for folder in Story::catalog_folders(text) {
        let folder = path.parent().unwrap_or(Path::new("")).join(folder);
        let there = fs::read_dir(&folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
        let there = there.filter(|file| file.extension().is_some_and(|e| e.eq_ignore_ascii_case("xosc")));
        files.extend(there.filter_map(|file| fs::canonicalize(file).ok()));
    }
    files.sort();
    files.dedup();
    if files.len() > CATALOGS {
        return Err(format!("expected at most {CATALOGS} files of catalogs, but there are {}", files.len()));
    }
    let mut texts = Vec::new();
    for file in files {
        match files::read_text(&file, most::TEXT) {
            Ok(text) => texts.push((file.display().to_string(), text)),
            Err(error) => say(format!("{}; passed over", sentence(&error))),
        }
        if texts.iter().map(|(_, text)| text.len() as u64).sum::<u64>() > most::STORY {
            return Err(format!("expected catalogs of at most {} MiB in all", most::STORY >> 20));
        }
    }
    Ok(texts)
}

/// The refusal of a name that is none of a story.
fn no_story(path: &Path) -> anyhow::Error {
    let known = story::BUNDLED.map(|(name, _)| name).join(", ");
    usage_in(path, &format!("expected a file .toml or .xosc, or one of the stories {known}"))
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
