//! Weather as text: at the start, and what it becomes.

use super::fields::{Scenario, ScenarioError};
use super::reader::Section;
use crate::weather::{Weather, WeatherChange, WeatherPreset};

/// How long the weather takes to change where a text does not say, seconds.
const CHANGE_S: f32 = 300.0;

/// Takes over what a text says of the weather. What it becomes is, where nothing else is said, as at the start.
pub(super) fn read_weather(root: &mut Section<'_>, scenario: &mut Scenario) -> Result<(), ScenarioError> {
    root.section("weather", "keys such as preset = \"ClearNoon\"", |section| {
        take(section, &mut scenario.weather)?;
        section.section("later", "keys such as over_s = 300.0", |section| {
            let mut later = WeatherChange { to: scenario.weather, over_s: CHANGE_S };
            section.number("over_s", 1.0..=86_400.0, &mut later.over_s)?;
            take(section, &mut later.to)?;
            scenario.later = Some(later);
            Ok(())
        })
    })
}

/// Takes the preset over, and then single values.
fn take(section: &mut Section<'_>, to: &mut Weather) -> Result<(), ScenarioError> {
    let presets = || format!("one of {}", WeatherPreset::names().collect::<Vec<_>>().join(", "));
    if let Some(preset) = section.named("preset", presets, WeatherPreset::find)? {
        *to = preset.weather(to.sun_azimuth_deg);
    }
    let percent = || 0.0..=100.0;
    section.number("cloudiness_pct", percent(), &mut to.cloudiness_pct)?;
    section.number("wind_pct", percent(), &mut to.wind_pct)?;
    section.number("sun_altitude_deg", -90.0..=90.0, &mut to.sun_altitude_deg)?;
    section.number("sun_azimuth_deg", 0.0..=360.0, &mut to.sun_azimuth_deg)?;
    section.number("precipitation_pct", percent(), &mut to.precipitation_pct)?;
    section.number("puddles_pct", percent(), &mut to.puddles_pct)?;
    section.number("wetness_pct", percent(), &mut to.wetness_pct)?;
    section.number("fog_density_pct", percent(), &mut to.fog_density_pct)?;
    section.number("fog_distance_m", 0.0..=1e5, &mut to.fog_distance_m)
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
        assert!(preset.ends_with(", DryNight"), "{preset}");
        let later = said("[weather.later]\npreset = \"clearnoon\"");
        assert!(later.starts_with("line 4: weather.later.preset is \"clearnoon\""), "{later}");
        let range = said("[weather]\nfog_distance_m = -1");
        assert_eq!(range, "line 4: weather.fog_distance_m is -1, expected a number from 0 to 100000");
        for key in ["cloudiness", "wind", "precipitation", "puddles", "wetness", "fog_density"] {
            let range = said(&format!("[weather.later]\nover_s = 9\n{key}_pct = 100.5"));
            let expected = format!("line 5: weather.later.{key}_pct is 100.5, expected a number from 0 to 100");
            assert_eq!(range, expected);
        }
        let time = said("[weather.later]\nover_s = 0");
        assert_eq!(time, "line 4: weather.later.over_s is 0, expected a number from 1 to 86400");
        assert!(said("[weather]\nover_s = 9").contains("unknown key weather.over_s,"));
        assert!(said("[weather.later.later]\nover_s = 9").contains("unknown key weather.later.later,"));
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
