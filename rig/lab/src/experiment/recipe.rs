//! The numbers of an experiment.

use std::path::Path;

use anyhow::{Context, anyhow, bail};
use base::files::{self, most};
use base::json::Typed;
use base::toml_text;
use kernel::scenario::MOST_OF_A_KIND;
use kernel::time::CLIP_FRAMES;
use perception::training::TrainOptions;
use render::{Imaging, ModelsId, Quality, Sensor};
use serde::{Deserialize, Serialize};

use crate::dataset::recipe::{MOST_IN_A_SPLIT, MOST_MAPS, check_size};

/// Everything that decides an experiment's results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Seed of everything random.
    pub seed: u64,
    /// Width and height of all pictures, pixels.
    pub size: (u32, u32),
    /// How good the pictures are.
    #[serde(default = "Quality::unsaid")]
    pub quality: Quality,
    /// What lens and chip do to them, as in `noise=4`; left out where they are ideal.
    #[serde(default, skip_serializing_if = "Sensor::is_ideal")]
    pub sensor: Sensor,
    /// Digest of models of a user's own; left out where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub models: Option<ModelsId>,
    /// Maps, in turn.
    pub maps: Vec<String>,
    /// The initial data.
    pub natural: Natural,
    /// More natural scenes, from which the pedestrian enriched set takes.
    pub pool: Pool,
    /// The network that the first campaign drives with, stopped early on purpose.
    pub driving: Driving,
    /// The campaign that finds corner cases.
    pub first_campaign: FirstCampaign,
    /// The networks that are compared.
    pub training: Training,
    /// The campaign that compares them.
    pub second_campaign: SecondCampaign,
}

/// What `aeye experiment --print-recipe` prints.
impl Typed for Recipe {
    const TYPE: &'static str = "aeye.experiment.recipe";
}

/// The initial data: scenes of one frame a second.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Natural {
    /// Scenes to learn from.
    pub scenes: u32,
    /// Scenes to choose by.
    pub val_scenes: u32,
    /// Frames of each of these.
    pub frames: u32,
    /// Scenes of the natural test.
    pub test_scenes: u32,
    /// Frames of each of these.
    pub test_frames: u32,
}

/// Scenes that are rich in pedestrians.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pool {
    /// How many.
    pub scenes: u32,
    /// People on foot on the map.
    pub pedestrians: u16,
}

/// A training that is stopped early.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Driving {
    /// Epochs that are trained.
    pub epochs: u32,
    /// Epochs of the whole schedule.
    pub horizon: u32,
}

/// How corner cases are found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FirstCampaign {
    /// Corner cases with pedestrians to learn from.
    pub training_cases: u32,
    /// Corner cases with pedestrians of the safety-critical test, from later runs.
    pub test_cases: u32,
    /// People on foot on the map; absent: as many as it has by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pedestrians: Option<u16>,
    /// Longest simulated time of a run, seconds.
    pub run_seconds: u32,
}

/// How the three kinds of network are trained.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Training {
    /// Epochs.
    pub epochs: u32,
    /// Trainings on each dataset, which differ in their seeds.
    pub seeds: u32,
}

/// How long each of the three drives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondCampaign {
    /// Kilometres of each network.
    pub km: f64,
    /// People on foot on the map; absent: as many as it has by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pedestrians: Option<u16>,
    /// Longest simulated time of a run, seconds.
    pub run_seconds: u32,
}

/// Experiments with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// Twenty minutes on two cores: shows that everything works.
    Smoke,
    /// An hour on two cores: enough to see whether corner cases help.
    Small,
    /// A night on two cores.
    Desk,
    /// The paper's numbers of scenes, corner cases, epochs, seeds and kilometres.
    Paper,
}

impl Preset {
    /// All of them, from the shortest to the longest.
    pub const ALL: [Self; 4] = [Self::Smoke, Self::Small, Self::Desk, Self::Paper];

    /// As people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smoke => "smoke",
            Self::Small => "small",
            Self::Desk => "desk",
            Self::Paper => "paper",
        }
    }

    /// Its numbers.
    pub fn recipe(self) -> anyhow::Result<Recipe> {
        let text = match self {
            Self::Smoke => include_str!("presets/smoke.toml"),
            Self::Small => include_str!("presets/small.toml"),
            Self::Desk => include_str!("presets/desk.toml"),
            Self::Paper => include_str!("presets/paper.toml"),
        };
        Recipe::parse(text)
    }
}

impl Recipe {
    /// How the pictures are made.
    pub fn imaging(&self) -> Imaging {
        Imaging { quality: self.quality, sensor: self.sensor, models: self.models }
    }

    /// Reads a recipe's file.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        Self::parse(&files::read_text(path, most::TEXT)?).with_context(|| path.display().to_string())
    }

    fn parse(text: &str) -> anyhow::Result<Self> {
        let recipe: Self = toml_text::read(text).map_err(|problem| anyhow!(problem))?;
        recipe.check()?;
        Ok(recipe)
    }

    /// As a file has it.
    pub fn to_toml(&self) -> anyhow::Result<String> {
        Ok(toml::to_string(self)?)
    }

    fn check(&self) -> anyhow::Result<()> {
        self.check_counts()?;
        let (natural, pool) = (&self.natural, &self.pool);
        let frames_of = |scenes: u32| u64::from(scenes) * u64::from(natural.frames);
        let frames = u64::from(CLIP_FRAMES) * u64::from(self.first_campaign.training_cases);
        let least = frames_of(natural.scenes.min(pool.scenes));
        if frames > least {
            bail!(
                "first_campaign.training_cases replace {frames} frames; expected natural and pool to have as many, not {least}"
            );
        }
        check_size(self.size).map_err(|reason| anyhow!(reason))?;
        if !self.size.0.is_multiple_of(32) || !self.size.1.is_multiple_of(32) {
            bail!("size is {}x{}; expected sides that are multiples of 32", self.size.0, self.size.1);
        }
        let batch = TrainOptions::default().batch as u64;
        if frames_of(natural.scenes) < batch {
            bail!("natural.scenes of natural.frames are too few to learn from; expected {batch} frames");
        }
        self.check_people()?;
        if self.driving.horizon < self.driving.epochs {
            bail!("driving.horizon is {}; expected at least driving.epochs", self.driving.horizon);
        }
        if !(self.second_campaign.km > 0.0 && self.second_campaign.km.is_finite()) {
            bail!("second_campaign.km is {}; expected more than 0", self.second_campaign.km);
        }
        let seconds = [self.first_campaign.run_seconds, self.second_campaign.run_seconds];
        if let Some(wrong) = seconds.iter().find(|s| !(10..=86_400).contains(*s)) {
            bail!("run_seconds is {wrong}; expected 10 to 86400");
        }
        Ok(())
    }

    fn check_counts(&self) -> anyhow::Result<()> {
        let counts = [
            ("natural.scenes", self.natural.scenes),
            ("natural.val_scenes", self.natural.val_scenes),
            ("natural.frames", self.natural.frames),
            ("natural.test_scenes", self.natural.test_scenes),
            ("natural.test_frames", self.natural.test_frames),
            ("pool.scenes", self.pool.scenes),
            ("driving.epochs", self.driving.epochs),
            ("driving.horizon", self.driving.horizon),
            ("first_campaign.training_cases", self.first_campaign.training_cases),
            ("first_campaign.test_cases", self.first_campaign.test_cases),
            ("training.epochs", self.training.epochs),
            ("training.seeds", self.training.seeds),
        ];
        if let Some((name, _)) = counts.iter().find(|(_, count)| *count == 0) {
            bail!("{name} is 0; expected at least 1");
        }
        if let Some((name, count)) = counts.iter().find(|(_, count)| *count > MOST_IN_A_SPLIT) {
            bail!("{name} is {count}; expected at most {MOST_IN_A_SPLIT}");
        }
        if !(1..=MOST_MAPS).contains(&self.maps.len()) {
            bail!("maps has {} names; expected 1 to {MOST_MAPS}", self.maps.len());
        }
        Ok(())
    }

    fn check_people(&self) -> anyhow::Result<()> {
        let people = [
            ("pool", Some(self.pool.pedestrians)),
            ("first_campaign", self.first_campaign.pedestrians),
            ("second_campaign", self.second_campaign.pedestrians),
        ];
        if let Some((name, _)) = people.iter().find(|(_, people)| people.is_some_and(|n| n > MOST_OF_A_KIND)) {
            bail!("{name}.pedestrians are too many; expected up to {MOST_OF_A_KIND}");
        }
        if self.first_campaign.pedestrians == Some(0) {
            bail!("first_campaign.pedestrians is 0; expected people on foot, for cases with them");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_valid_and_come_back_from_their_text() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("recipe.toml");
        for preset in Preset::ALL {
            let recipe = preset.recipe().expect("valid");
            std::fs::write(&path, recipe.to_toml().expect("text")).expect("written");
            assert_eq!(Recipe::read(&path).expect("valid"), recipe, "{preset:?}");
        }
    }

    #[test]
    fn nonsense_is_refused_by_its_place() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("recipe.toml");
        let refused = |text: &str| {
            std::fs::write(&path, text).expect("written");
            format!("{:#}", Recipe::read(&path).expect_err("refused"))
        };
        let good = Preset::Smoke.recipe().expect("valid").to_toml().expect("text");
        for (from, to, said) in [
            ("seeds = 2", "seeds = 0", "training.seeds is 0"),
            ("training_cases = 3", "training_cases = 30", "replace 900 frames"),
            ("size = [256, 128]", "size = [256, 100]", "multiples of 32"),
            ("size = [256, 128]", "size = [60000, 60000]", "expected 1 to"),
            ("km = 2.0", "km = -1.0", "more than 0"),
            ("seeds = 2", "seeds = 4000000000", "at most 100000"),
            ("epochs = 3", "epochs = 30", "at least driving.epochs"),
            ("pedestrians = 400", "pedestrians = 501", "pool.pedestrians are too many"),
            ("run_seconds = 90", "run_seconds = 1", "10 to 86400"),
            ("seed = 1", "sead = 1", "line 1: unknown field"),
        ] {
            let message = refused(&good.replacen(from, to, 1));
            assert!(message.contains(said) && message.contains("recipe.toml"), "{message}");
        }
    }
}
