//! Weather as text: at the start, and what it becomes.

use serde::Deserialize;

use super::fields::{Scenario, ScenarioError};
use super::reader::{Given, Reader};
use crate::weather::{Weather, WeatherChange, WeatherPreset};

/// How long the weather takes to change where a text does not say, seconds.
const CHANGE_S: f32 = 300.0;

/// A section with the keys of weather and one of its own.
macro_rules! section {
    ($name:ident, $own:ident: $type:ty) => {
        #[derive(Default, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $name {
            preset: Given<String>,
            cloudiness_pct: Given<f32>,
            wind_pct: Given<f32>,
            sun_altitude_deg: Given<f32>,
            sun_azimuth_deg: Given<f32>,
            precipitation_pct: Given<f32>,
            puddles_pct: Given<f32>,
            wetness_pct: Given<f32>,
            fog_density_pct: Given<f32>,
            fog_distance_m: Given<f32>,
            $own: $type,
        }

        impl $name {
            /// Takes the preset over, and then single values.
            fn take(self, reader: &Reader<'_>, section: &str, to: &mut Weather) -> Result<(), ScenarioError> {
                if let Some(name) = self.preset {
                    let known = WeatherPreset::find(name.get_ref());
                    let preset = known.ok_or_else(|| unknown(reader, section, &name))?;
                    *to = preset.weather(to.sun_azimuth_deg);
                }
                let take = |key: &str, given, range, to| reader.take(&format!("{section}.{key}"), given, range, to);
                let percent = || 0.0..=100.0;
                take("cloudiness_pct", self.cloudiness_pct, percent(), &mut to.cloudiness_pct)?;
                take("wind_pct", self.wind_pct, percent(), &mut to.wind_pct)?;
                take("sun_altitude_deg", self.sun_altitude_deg, -90.0..=90.0, &mut to.sun_altitude_deg)?;
                take("sun_azimuth_deg", self.sun_azimuth_deg, 0.0..=360.0, &mut to.sun_azimuth_deg)?;
                take("precipitation_pct", self.precipitation_pct, percent(), &mut to.precipitation_pct)?;
                take("puddles_pct", self.puddles_pct, percent(), &mut to.puddles_pct)?;
                take("wetness_pct", self.wetness_pct, percent(), &mut to.wetness_pct)?;
                take("fog_density_pct", self.fog_density_pct, percent(), &mut to.fog_density_pct)?;
                take("fog_distance_m", self.fog_distance_m, 0.0..=1e5, &mut to.fog_distance_m)
            }
        }
    };
}

section!(AtStart, later: Option<Later>);
section!(Later, over_s: Given<f32>);

fn unknown(reader: &Reader<'_>, section: &str, name: &toml::Spanned<String>) -> ScenarioError {
    let (line, names) = (reader.line(name.span().start), WeatherPreset::names().collect::<Vec<_>>().join(", "));
    ScenarioError(format!("line {line}: {section}.preset is {:?}, expected one of {names}", name.get_ref()))
}

/// Takes over what a text says of the weather. What it becomes is, where nothing else is said, as at the start.
pub(super) fn take(reader: &Reader<'_>, mut given: AtStart, scenario: &mut Scenario) -> Result<(), ScenarioError> {
    let later = given.later.take();
    given.take(reader, "weather", &mut scenario.weather)?;
    let Some(mut later) = later else { return Ok(()) };
    let (mut to, mut over_s) = (scenario.weather, CHANGE_S);
    reader.take("weather.later.over_s", later.over_s.take(), 1.0..=86_400.0, &mut over_s)?;
    later.take(reader, "weather.later", &mut to)?;
    scenario.later = Some(WeatherChange { to, over_s });
    Ok(())
}

/// The sections of a weather, with every key.
pub(super) fn print(weather: &Weather, later: Option<&WeatherChange>) -> String {
    let start = format!("[weather]\n{}", keys(weather));
    let change = |later: &WeatherChange| format!("\n[weather.later]\nover_s = {:?}\n{}", later.over_s, keys(&later.to));
    start + &later.map_or(String::new(), change)
}

fn keys(weather: &Weather) -> String {
    format!(
        "cloudiness_pct = {:?}\nwind_pct = {:?}\nsun_altitude_deg = {:?}\nsun_azimuth_deg = {:?}\n\
         precipitation_pct = {:?}\npuddles_pct = {:?}\nwetness_pct = {:?}\nfog_density_pct = {:?}\n\
         fog_distance_m = {:?}\n",
        weather.cloudiness_pct,
        weather.wind_pct,
        weather.sun_altitude_deg,
        weather.sun_azimuth_deg,
        weather.precipitation_pct,
        weather.puddles_pct,
        weather.wetness_pct,
        weather.fog_density_pct,
        weather.fog_distance_m,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(weather: &str) -> Result<Scenario, String> {
        Scenario::from_toml(&format!("map = \"field\"\nseed = 7\n{weather}")).map_err(|error| error.0)
    }

    #[test]
    fn a_preset_is_carlas_and_single_keys_override_it() {
        let scenario = read("[weather]\nwind_pct = 12\npreset = \"HardRainNoon\"\nfog_density_pct = 20\n");
        let weather = scenario.expect("a scenario").weather;
        let expected = Weather {
            precipitation_pct: 100.0,
            puddles_pct: 90.0,
            fog_density_pct: 20.0,
            fog_distance_m: 0.75,
            ..Weather::dry(100.0, 12.0, 45.0, Scenario::default_for("field", 7).weather.sun_azimuth_deg)
        };
        assert_eq!(weather, expected);
    }

    #[test]
    fn every_preset_is_in_range_and_comes_back() {
        for name in WeatherPreset::names() {
            let scenario = read(&format!("[weather]\npreset = {name:?}\n")).expect(name);
            assert_eq!(Scenario::from_toml(&scenario.to_toml()).as_ref(), Ok(&scenario), "{name}");
        }
    }

    #[test]
    fn weather_becomes_what_is_said_and_else_stays() {
        let text = "[weather]\nsun_azimuth_deg = 10\n[weather.later]\npreset = \"WetCloudySunset\"\nwetness_pct = 30\n";
        let scenario = read(text).expect("a scenario");
        let later = scenario.later.expect("a change");
        assert_eq!((later.over_s, later.to.sun_azimuth_deg, later.to.wetness_pct), (300.0, 10.0, 30.0));
        assert_eq!((later.to.puddles_pct, later.to.sun_altitude_deg), (50.0, 15.0));
        assert_eq!(scenario.weather_at(0), scenario.weather);
        assert_eq!(scenario.weather_at(300 * 60), later.to);
        let steady = read("[weather.later]\nover_s = 60\nwetness_pct = 50").expect("a scenario");
        let expected = Weather { wetness_pct: 50.0, ..steady.weather };
        assert_eq!(steady.later, Some(WeatherChange { to: expected, over_s: 60.0 }));
    }

    #[test]
    fn mistakes_are_named_by_line_and_key() {
        let said = |text: &str| read(text).expect_err(text);
        let preset = said("[weather]\npreset = \"HardRian\"");
        assert!(
            preset.starts_with("line 4: weather.preset is \"HardRian\", expected one of ClearNoon, Cl"),
            "{preset}"
        );
        assert!(preset.ends_with(", HardRainNight"), "{preset}");
        let later = said("[weather.later]\npreset = \"clearnoon\"");
        assert!(later.starts_with("line 4: weather.later.preset is \"clearnoon\""), "{later}");
        let range = said("[weather]\nfog_distance_m = -1");
        assert_eq!(range, "line 4: weather.fog_distance_m is -1, expected at least 0 and at most 100000");
        for key in ["cloudiness", "wind", "precipitation", "puddles", "wetness", "fog_density"] {
            let range = said(&format!("[weather.later]\nover_s = 9\n{key}_pct = 100.5"));
            let expected = format!("line 5: weather.later.{key}_pct is 100.5, expected at least 0 and at most 100");
            assert_eq!(range, expected);
        }
        let time = said("[weather.later]\nover_s = 0");
        assert_eq!(time, "line 4: weather.later.over_s is 0, expected at least 1 and at most 86400");
        assert!(said("[weather]\nover_s = 9").contains("unknown field `over_s`"));
        assert!(said("[weather.later.later]\nover_s = 9").contains("unknown field `later`"));
    }

    fn weather() -> impl Strategy<Value = Weather> {
        let percent = || 0.0f32..=100.0;
        let dry = (percent(), percent(), -90.0f32..=90.0, 0.0f32..=360.0);
        (dry, percent(), percent(), percent(), percent(), 0.0f32..=1e5).prop_map(
            |(dry, rain, puddles, wet, fog, from)| Weather {
                precipitation_pct: rain,
                puddles_pct: puddles,
                wetness_pct: wet,
                fog_density_pct: fog,
                fog_distance_m: from,
                ..Weather::dry(dry.0, dry.1, dry.2, dry.3)
            },
        )
    }

    proptest! {
        #[test]
        fn any_weather_comes_back_from_its_text(
            from in weather(),
            later in prop::option::of((weather(), 1.0f32..=86_400.0)),
        ) {
            let later = later.map(|(to, over_s)| WeatherChange { to, over_s });
            let scenario = Scenario { weather: from, later, ..Scenario::default_for("field", 1) };
            prop_assert_eq!(Scenario::from_toml(&scenario.to_toml()), Ok(scenario));
        }

        #[test]
        fn weather_stays_in_its_ranges_while_it_changes(from in weather(), to in weather(), tick in 0u64..20_000) {
            let scenario = Scenario {
                weather: from,
                later: Some(WeatherChange { to, over_s: 250.0 }),
                ..Scenario::default_for("field", 1)
            };
            let now = Scenario { weather: scenario.weather_at(tick), later: None, ..scenario };
            prop_assert!(Scenario::from_toml(&now.to_toml()).is_ok(), "{}", now.to_toml());
        }
    }
}
