//! A protocol's file.

use base::setting::Changes;
use drivers::checkpoint::CheckpointChoice;
use kernel::scenario::HazardLevel;
use kernel::weather::WeatherPreset;
use serde::{Deserialize, Serialize};

use crate::Pseudonym;

/// Longest link, and most conditions, so that what is shown fits on a screen.
const LONGEST_LINK: usize = 300;
const MOST_CONDITIONS: usize = 40;
/// Longest break, seconds, and longest drive, kilometres.
const LONGEST_BREAK_S: u32 = 24 * 3600;
const MOST_KM: f64 = 10_000.0;
/// Limits of `max_time_s`, as of `--max-time`.
const MAX_TIME_S: std::ops::RangeInclusive<u32> = 4..=86_400;

/// What a file holds, as it is written.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Text {
    pub participants: [String; 2],
    #[serde(default = "one")]
    pub row: u32,
    #[serde(default = "first_seed")]
    pub seed: u64,
    #[serde(default)]
    pub order: Order,
    #[serde(default = "yes")]
    pub swap: bool,
    #[serde(default)]
    pub blind: bool,
    #[serde(default)]
    pub break_s: u32,
    #[serde(default)]
    pub questions: Questions,
    pub link: Option<String>,
    pub conditions: Vec<Condition>,
}

/// In which order conditions are driven.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// By a row of a balanced square.
    #[default]
    Square,
    /// As they stand in the file.
    AsWritten,
}

/// When both drivers are asked how they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Questions {
    /// Not by this program.
    #[default]
    Never,
    /// After each half: before the seats are swapped, and at the end.
    EachHalf,
    /// After each trial.
    EachTrial,
}

/// What a trial is driven in, as it is written.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    pub map: Option<String>,
    pub scenario: Option<String>,
    pub weather: Option<String>,
    pub hazards: Option<String>,
    pub pedestrians: Option<u16>,
    pub max_time_s: Option<u32>,
    #[serde(default = "truth")]
    pub checkpoint: String,
    pub km: Option<f64>,
}

fn one() -> u32 {
    1
}

fn first_seed() -> u64 {
    1
}

fn yes() -> bool {
    true
}

fn truth() -> String {
    perception::TRUTH.into()
}

impl Text {
    /// What no drive could follow is said, with its key.
    pub fn check(&self) -> Result<[Pseudonym; 2], String> {
        let named = |name: &String| name.parse::<Pseudonym>().map_err(|reason| format!("participants: {reason}"));
        let [first, second] = &self.participants;
        let names = [named(first)?, named(second)?];
        let is_told = |what: bool, said: &str| if what { Ok(()) } else { Err(said.to_owned()) };
        is_told(first != second, "participants: expected two different pseudonyms")?;
        is_told(self.row > 0, "row: expected 1 or more")?;
        is_told(self.break_s <= LONGEST_BREAK_S, "break_s: expected at most a day")?;
        let count = self.conditions.len();
        let expected = format!("conditions: expected 1 to {MOST_CONDITIONS}, found {count}");
        is_told((1..=MOST_CONDITIONS).contains(&count), &expected)?;
        let link = self.link.as_deref().unwrap_or_default();
        let is_plain = link.chars().count() <= LONGEST_LINK && !link.chars().any(char::is_control);
        is_told(is_plain, &format!("link: expected a line of at most {LONGEST_LINK} characters"))?;
        Ok(names)
    }
}

impl Condition {
    /// What is otherwise than the map's default or the scenario says.
    pub fn changes(&self) -> Result<Changes, String> {
        let weather = |name: &String| {
            let known = || WeatherPreset::names().collect::<Vec<_>>().join(", ");
            WeatherPreset::find(name)
                .copied()
                .ok_or_else(|| format!("weather: unknown {name:?}, expected one of {}", known()))
        };
        let hazards = |name: &String| {
            let known = HazardLevel::ALL.map(HazardLevel::name).join(", ");
            HazardLevel::named(name).ok_or_else(|| format!("hazards: unknown {name:?}, expected one of {known}"))
        };
        if let Some(seconds) = self.max_time_s.filter(|seconds| !MAX_TIME_S.contains(seconds)) {
            return Err(format!("max_time_s is {seconds}, expected 4 to 86400"));
        }
        Ok(Changes {
            weather: self.weather.as_ref().map(weather).transpose()?,
            hazards: self.hazards.as_ref().map(hazards).transpose()?,
            pedestrians: self.pedestrians,
            max_seconds: self.max_time_s,
            ..Changes::default()
        })
    }

    /// What the semantic driver sees; files are named as seen from a folder.
    pub fn checkpoint(&self, folder: &std::path::Path) -> Result<CheckpointChoice, String> {
        let choice: CheckpointChoice = self.checkpoint.parse().map_err(|reason| format!("checkpoint: {reason}"))?;
        Ok(match choice {
            CheckpointChoice::File(path) => CheckpointChoice::File(folder.join(path)),
            choice => choice,
        })
    }

    /// Kilometres that are to be driven in it.
    pub fn km(&self) -> Result<Option<f64>, String> {
        match self.km {
            Some(km) if !(km > 0.0 && km <= MOST_KM) => {
                Err(format!("km is {km}, expected more than 0, at most {MOST_KM}"))
            }
            km => Ok(km),
        }
    }
}
