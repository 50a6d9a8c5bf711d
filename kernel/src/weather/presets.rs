//! Weather by its name: CARLA's and ours.

use super::fields::Weather;

/// A weather with a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeatherPreset {
    /// Its name there.
    pub name: &'static str,
    /// Its values; the sun's azimuth is left open, as there.
    weather: Weather,
}

impl WeatherPreset {
    /// The preset of a name.
    pub fn find(name: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.name == name)
    }

    /// Every name, CARLA's in its order and then ours.
    pub fn names() -> impl Iterator<Item = &'static str> {
        PRESETS.iter().map(|preset| preset.name)
    }

    /// Its weather with the sun in a direction, degrees.
    pub fn weather(&self, sun_azimuth_deg: f32) -> Weather {
        Weather { sun_azimuth_deg, ..self.weather }
    }
}

/// Cloudiness, rain, puddles, wind, the sun's altitude, density and distance of the fog, wetness.
const fn preset(name: &'static str, values: [f32; 8]) -> WeatherPreset {
    let [clouds, rain, puddles, wind, sun, fog, fog_from, wetness] = values;
    let weather = Weather {
        precipitation_pct: rain,
        puddles_pct: puddles,
        wetness_pct: wetness,
        fog_density_pct: fog,
        fog_distance_m: fog_from,
        ..Weather::dry(clouds, wind, sun, 0.0)
    };
    WeatherPreset { name, weather }
}

/// First those of CARLA 0.9.14 and 0.9.15, `WeatherParameters.cpp`, whose nights are foggy, then ours. Fall-off of the fog and scattering have no counterpart here; the
/// dust storm says nothing but that it is one.
pub static PRESETS: [WeatherPreset; 24] = [
    preset("ClearNoon", [5.0, 0.0, 0.0, 10.0, 45.0, 2.0, 0.75, 0.0]),
    preset("CloudyNoon", [60.0, 0.0, 0.0, 10.0, 45.0, 3.0, 0.75, 0.0]),
    preset("WetNoon", [5.0, 0.0, 50.0, 10.0, 45.0, 3.0, 0.75, 0.0]),
    preset("WetCloudyNoon", [60.0, 0.0, 50.0, 10.0, 45.0, 3.0, 0.75, 0.0]),
    preset("MidRainyNoon", [60.0, 60.0, 60.0, 60.0, 45.0, 3.0, 0.75, 0.0]),
    preset("HardRainNoon", [100.0, 100.0, 90.0, 100.0, 45.0, 7.0, 0.75, 0.0]),
    preset("SoftRainNoon", [20.0, 30.0, 50.0, 30.0, 45.0, 3.0, 0.75, 0.0]),
    preset("ClearSunset", [5.0, 0.0, 0.0, 10.0, 15.0, 2.0, 0.75, 0.0]),
    preset("CloudySunset", [60.0, 0.0, 0.0, 10.0, 15.0, 3.0, 0.75, 0.0]),
    preset("WetSunset", [5.0, 0.0, 50.0, 10.0, 15.0, 2.0, 0.75, 0.0]),
    preset("WetCloudySunset", [60.0, 0.0, 50.0, 10.0, 15.0, 2.0, 0.75, 0.0]),
    preset("MidRainSunset", [60.0, 60.0, 60.0, 60.0, 15.0, 3.0, 0.75, 0.0]),
    preset("HardRainSunset", [100.0, 100.0, 90.0, 100.0, 15.0, 7.0, 0.75, 0.0]),
    preset("SoftRainSunset", [20.0, 30.0, 50.0, 30.0, 15.0, 2.0, 0.75, 0.0]),
    preset("ClearNight", [5.0, 0.0, 0.0, 10.0, -90.0, 60.0, 75.0, 0.0]),
    preset("CloudyNight", [60.0, 0.0, 0.0, 10.0, -90.0, 60.0, 0.75, 0.0]),
    preset("WetNight", [5.0, 0.0, 50.0, 10.0, -90.0, 60.0, 75.0, 60.0]),
    preset("WetCloudyNight", [60.0, 0.0, 50.0, 10.0, -90.0, 60.0, 0.75, 60.0]),
    preset("SoftRainNight", [60.0, 30.0, 50.0, 30.0, -90.0, 60.0, 0.75, 60.0]),
    preset("MidRainyNight", [80.0, 60.0, 60.0, 60.0, -90.0, 60.0, 0.75, 80.0]),
    preset("HardRainNight", [100.0, 100.0, 90.0, 100.0, -90.0, 100.0, 0.75, 100.0]),
    preset("ClearDusk", [30.0, 0.0, 0.0, 10.0, -2.0, 0.0, 0.0, 0.0]),
    preset("FoggyNoon", [80.0, 0.0, 0.0, 10.0, 45.0, 50.0, 0.75, 0.0]),
    preset("DryNight", [30.0, 0.0, 0.0, 10.0, -30.0, 0.0, 0.0, 0.0]),
];
