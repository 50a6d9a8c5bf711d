//! Weather and light in a few words, by which cases are chosen.

use std::str::FromStr;

use kernel::weather::{Weather, WeatherPreset};

/// Fog of so many percent is one of 1,000 m, from which on meteorologists call it fog.
const FOG_PCT: f32 = 5.0;

/// What may be said of the weather at a takeover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Condition {
    /// It rains.
    Rain = 1,
    /// The road is wet, or water stands on it.
    Wet = 2,
    /// One sees 1,000 m or less.
    Fog = 4,
    /// The sun is below the horizon.
    Night = 8,
}

impl Condition {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::Rain, Self::Wet, Self::Fog, Self::Night];

    /// As commands and JSON have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rain => "rain",
            Self::Wet => "wet",
            Self::Fog => "fog",
            Self::Night => "night",
        }
    }

    fn holds(self, weather: &Weather) -> bool {
        match self {
            Self::Rain => weather.precipitation_pct > 0.0,
            Self::Wet => {
                [weather.precipitation_pct, weather.puddles_pct, weather.wetness_pct].iter().any(|pct| *pct > 0.0)
            }
            Self::Fog => weather.fog_density_pct >= FOG_PCT,
            Self::Night => weather.sun_altitude_deg < 0.0,
        }
    }
}

/// Those that hold, as a set of bits.
pub fn bits(weather: &Weather) -> i64 {
    Condition::ALL.into_iter().filter(|condition| condition.holds(weather)).map(|condition| condition as i64).sum()
}

/// Their names.
pub fn names(bits: i64) -> Vec<&'static str> {
    Condition::ALL.into_iter().filter(|condition| bits & *condition as i64 != 0).map(Condition::name).collect()
}

/// The name of a weather, wherever the sun stands.
pub fn preset(weather: &Weather) -> Option<&'static str> {
    let is_it = |name: &&str| WeatherPreset::find(name).is_some_and(|p| p.weather(weather.sun_azimuth_deg) == *weather);
    WeatherPreset::names().find(is_it)
}

/// A weather that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeatherChoice {
    /// One of CARLA's.
    Preset(&'static str),
    /// One of which this holds ...
    With(Condition),
    /// ... or does not: `dry` is not wet, `day` not night.
    Without(Condition),
}

impl WeatherChoice {
    /// What may be asked for beside names.
    pub const WORDS: [&str; 6] = ["rain", "wet", "dry", "fog", "night", "day"];
}

impl FromStr for WeatherChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "dry" => return Ok(Self::Without(Condition::Wet)),
            "day" => return Ok(Self::Without(Condition::Night)),
            _ => {}
        }
        let condition = Condition::ALL.into_iter().find(|condition| condition.name() == text).map(Self::With);
        let preset = || WeatherPreset::find(text).map(|preset| Self::Preset(preset.name));
        let expected = || format!("expected {}, or a name as in HardRainNoon", Self::WORDS.join(", "));
        condition.or_else(preset).ok_or_else(expected)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weather_has_words_and_a_name() {
        let of = |name: &str| WeatherPreset::find(name).expect("a preset").weather(77.0);
        assert_eq!(names(bits(&of("ClearNoon"))), Vec::<&str>::new());
        assert_eq!(names(bits(&of("HardRainNight"))), ["rain", "wet", "fog", "night"]);
        assert_eq!(names(bits(&of("WetNoon"))), ["wet"]);
        assert!(WeatherPreset::names().all(|name| preset(&of(name)) == Some(name)));
        assert_eq!(preset(&Weather::dry(1.0, 2.0, 3.0, 4.0)), None);
    }

    #[test]
    fn words_and_names_are_asked_for() {
        assert!(WeatherChoice::WORDS.iter().all(|word| word.parse::<WeatherChoice>().is_ok()));
        assert_eq!("dry".parse(), Ok(WeatherChoice::Without(Condition::Wet)));
        assert_eq!("WetNoon".parse(), Ok(WeatherChoice::Preset("WetNoon")));
        assert!("snow".parse::<WeatherChoice>().unwrap_err().contains("expected rain, wet, dry"));
    }
}
