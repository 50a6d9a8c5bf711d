//! What datasets are made from, as `dataset.json` says it; the same recipe gives the same files on the same adapter.

use base::files::{check_name, most};
use base::maps::Map;
use kernel::time::Tick;
use kernel::weather::WeatherPreset;
use render::{Imaging, ModelsId, Quality, Sensor};
use serde::{Deserialize, Serialize};

use super::provenance::Part;
use super::views;
use crate::cameras::Mounted;

/// Most scenes of a split, and frames of a scene: mixes number those of their parts apart by as many.
pub const MOST_IN_A_SPLIT: u32 = 100_000;
/// Most maps of a dataset.
pub const MOST_MAPS: usize = 1000;

/// What a dataset is made from; the same recipe gives the same files on the same adapter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", content = "recipe", rename_all = "kebab-case")]
pub enum Recipe {
    /// Frames of simulated drives.
    Natural(NaturalRecipe),
    /// Frames of corner cases.
    Cases(CasesRecipe),
    /// Frames of two other datasets.
    Mix(Box<MixRecipe>),
}

impl Recipe {
    /// Refuses what no dataset can be made from.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::Natural(recipe) => recipe.check(),
            Self::Cases(recipe) => recipe.check(),
            Self::Mix(recipe) => {
                recipe.natural.check()?;
                recipe.by.source().check()
            }
        }
    }

    /// The word that says which kind it is.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Natural(_) => "natural",
            Self::Cases(_) => "cases",
            Self::Mix(_) => "mix",
        }
    }

    /// Width and height of the pictures, pixels.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::Natural(recipe) => recipe.size,
            Self::Cases(recipe) => recipe.size,
            Self::Mix(recipe) => recipe.natural.size(),
        }
    }

    /// The cameras that take each frame; none where it is the drivers' alone.
    pub fn cameras(&self) -> &[Mounted] {
        match self {
            Self::Natural(recipe) => &recipe.cameras,
            Self::Cases(recipe) => &recipe.cameras,
            Self::Mix(recipe) => recipe.natural.cameras(),
        }
    }

    /// How the pictures are made.
    pub fn imaging(&self) -> Imaging {
        match self {
            Self::Natural(recipe) => recipe.imaging(),
            Self::Cases(recipe) => recipe.imaging(),
            Self::Mix(recipe) => recipe.natural.imaging(),
        }
    }
}

/// What a natural dataset is made from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NaturalRecipe {
    /// Seed of every scene's own.
    pub seed: u64,
    /// Scenes of the training split.
    pub scenes: u32,
    /// Scenes of the validation split.
    pub val_scenes: u32,
    /// Scenes of the test split.
    #[serde(default)]
    pub test_scenes: u32,
    /// Frames a scene of training and validation.
    pub frames: u32,
    /// Frames a scene of the test split.
    #[serde(default)]
    pub test_frames: u32,
    /// Width and height of the pictures, pixels.
    pub size: (u32, u32),
    /// How good the pictures are.
    #[serde(default = "Quality::unsaid")]
    pub quality: Quality,
    /// What lens and chip do to them; left out where they are ideal.
    #[serde(default, skip_serializing_if = "Sensor::is_ideal")]
    pub sensor: Sensor,
    /// The cameras that take each frame, where it is not the drivers' alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cameras: Vec<Mounted>,
    /// Digest of models of a user's own; left out where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub models: Option<ModelsId>,
    /// People on foot, where not as many as in the map's default scenario.
    pub pedestrians: Option<u16>,
    /// The scenes' weathers by name, in turn after each round of maps; drawn by each scene's seed where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub weather: Vec<String>,
    /// The scenes' maps, in turn.
    pub maps: Vec<MapUsed>,
}

impl NaturalRecipe {
    /// How the pictures are made.
    pub fn imaging(&self) -> Imaging {
        Imaging { quality: self.quality, sensor: self.sensor, models: self.models }
    }

    /// Refuses what no drives can be made from.
    pub fn check(&self) -> Result<(), String> {
        check_size(self.size)?;
        views::check(&self.cameras, self.size, self.imaging())?;
        let splits = [(self.scenes, self.frames), (self.val_scenes, self.frames), (self.test_scenes, self.test_frames)];
        let has_frames = |(scenes, frames): &(u32, u32)| *scenes == 0 || *frames > 0;
        if self.maps.is_empty() || splits.iter().all(|(scenes, _)| *scenes == 0) || !splits.iter().all(has_frames) {
            return Err("a dataset needs at least one map, one scene and one frame a scene".into());
        }
        let largest = splits.iter().flat_map(|(scenes, frames)| [*scenes, *frames]).fold(0, u32::max);
        if largest > MOST_IN_A_SPLIT || self.maps.len() > MOST_MAPS {
            return Err(format!(
                "a dataset takes at most {MOST_IN_A_SPLIT} scenes a split and frames a scene, and {MOST_MAPS} maps"
            ));
        }
        if let Some(none) = self.weather.iter().find(|name| WeatherPreset::find(name).is_none()) {
            return Err(format!(
                "a dataset of weather {none}; expected one of {}",
                WeatherPreset::names().collect::<Vec<_>>().join(", ")
            ));
        }
        self.maps.iter().try_for_each(|map| check_name(&map.name))
    }
}

/// Refuses pictures that are none, or larger than are read.
pub fn check_size((width, height): (u32, u32)) -> Result<(), String> {
    let pixels = u64::from(width) * u64::from(height);
    if (1..=most::PIXELS).contains(&pixels) {
        return Ok(());
    }
    Err(format!("pictures of {width}x{height}; expected 1 to {} pixels", most::PIXELS))
}

/// A map of a dataset.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MapUsed {
    /// Its name, as it stands in file names.
    pub name: String,
    /// Digest of the baked map.
    pub digest: String,
}

impl MapUsed {
    /// What a recipe says of a map.
    pub fn new(map: &Map) -> Self {
        Self { name: city(&map.network.name), digest: format!("{:032x}", map.network.digest) }
    }
}

/// The name of a map as it stands in file names, whose parts `_` separates.
pub fn city(map: &str) -> String {
    map.replace('_', "-")
}

/// What a dataset of corner cases is made from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CasesRecipe {
    /// Which split they are.
    pub split: String,
    /// Width and height of the pictures, pixels.
    pub size: (u32, u32),
    /// How good the pictures are.
    #[serde(default = "Quality::unsaid")]
    pub quality: Quality,
    /// What lens and chip do to them; left out where they are ideal.
    #[serde(default, skip_serializing_if = "Sensor::is_ideal")]
    pub sensor: Sensor,
    /// The cameras that take each frame, where it is not the drivers' alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cameras: Vec<Mounted>,
    /// Digest of models of a user's own; left out where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub models: Option<ModelsId>,
    /// The cases, in the order of their scenes' numbers.
    pub cases: Vec<CaseUsed>,
}

impl CasesRecipe {
    /// How the pictures are made.
    pub fn imaging(&self) -> Imaging {
        Imaging { quality: self.quality, sensor: self.sensor, models: self.models }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        check_size(self.size)?;
        views::check(&self.cameras, self.size, self.imaging())?;
        check_name(&self.split)?;
        if self.cases.len() > MOST_IN_A_SPLIT as usize {
            return Err(format!("a dataset takes at most {MOST_IN_A_SPLIT} cases"));
        }
        self.cases.iter().try_for_each(|case| check_name(&case.map))
    }
}

/// A case of a dataset.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseUsed {
    /// Name of its file, for people; it is found by its digest.
    pub name: String,
    /// BLAKE3 of its file.
    pub digest: String,
    /// BLAKE3 of the recording it was cut from.
    pub recording: String,
    /// The window's last tick.
    pub to: Tick,
    /// The map, as it stands in file names.
    pub map: String,
    /// The drive's seed.
    pub seed: u64,
    /// What the takeover was labelled as.
    pub label: Option<String>,
}

/// What an enriched training set is made from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MixRecipe {
    /// Seed of what is drawn.
    pub seed: u64,
    /// Training frames replaced.
    pub replace: u32,
    /// The set whose frames are replaced.
    pub natural: Recipe,
    /// What takes their place.
    #[serde(flatten)]
    pub by: Replacement,
}

/// What takes the place of natural frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "set", rename_all = "kebab-case")]
pub enum Replacement {
    /// Frames among more people.
    Pedestrian {
        /// The drives they come from.
        pool: Recipe,
        /// Pedestrian pixels that they show together, as closely as the pool has it.
        pixels: u64,
    },
    /// Frames of corner cases.
    CornerCase {
        /// The cases they come from.
        cases: Recipe,
    },
}

impl Replacement {
    /// What its frames are made from.
    pub fn source(&self) -> &Recipe {
        match self {
            Self::Pedestrian { pool: source, .. } | Self::CornerCase { cases: source } => source,
        }
    }

    /// What part of a mix they are.
    pub(super) fn part(&self) -> Part {
        match self {
            Self::Pedestrian { .. } => Part::Pool,
            Self::CornerCase { .. } => Part::Cases,
        }
    }
}
