//! Weather in the classes of the standard.

use std::f64::consts::{FRAC_PI_2, TAU};

use kernel::ops;
use kernel::scene::Weather;

use super::messages::{CloudLayer, EnvironmentalConditions, Fog, Precipitation, Sun};

/// Rain of 100 %, mm an hour.
const CLOUDBURST_MMH: f32 = 50.0;
/// From how much rain on each class is, mm an hour.
const RAIN: [(f32, Precipitation); 6] = [
    (149.0, Precipitation::Extreme),
    (34.0, Precipitation::VeryHeavy),
    (8.1, Precipitation::Heavy),
    (1.9, Precipitation::Moderate),
    (0.5, Precipitation::Light),
    (0.1, Precipitation::VeryLight),
];
/// How much of the light is left at the end of what is seen: the standard's visibility, by which fog is classed.
const LEFT: f32 = 0.05;
/// From how far one sees on each class of fog is, metres.
const FOG: [(f32, Fog); 7] = [
    (40_000.0, Fog::ExcellentVisibility),
    (10_000.0, Fog::GoodVisibility),
    (4000.0, Fog::ModerateVisibility),
    (2000.0, Fog::PoorVisibility),
    (1000.0, Fog::Mist),
    (200.0, Fog::Light),
    (50.0, Fog::Thick),
];
/// From which height of the sun on each level of light is, degrees: where natural light under a clear sky passes 10,000,
/// 1000, 400, 20, 10, 3, 1 and 0.01 lx (RCA Electro-Optics Handbook 1974, natural illuminance).
const LEVELS: [f32; 8] = [8.0, 1.0, -0.8, -4.3, -5.0, -6.0, -6.8, -11.5];
/// The level of full daylight.
const BRIGHTEST: i32 = 9;
const OKTAS: f32 = 8.0;

/// What the standard says of a weather.
pub fn conditions(weather: &Weather) -> EnvironmentalConditions {
    EnvironmentalConditions {
        ambient_illumination: 1 + level(weather.sun_altitude_deg),
        precipitation: rain(0.01 * weather.precipitation_pct * CLOUDBURST_MMH) as i32,
        fog: fog(weather) as i32,
        clouds: CloudLayer { fractional_cloud_cover: 2 + oktas(weather.cloudiness_pct) },
        sun: Sun {
            azimuth: (f64::from(weather.sun_azimuth_deg).to_radians() - FRAC_PI_2).rem_euclid(TAU),
            elevation: f64::from(weather.sun_altitude_deg).to_radians(),
        },
    }
}

/// Level of ambient light, [1, 9].
fn level(sun_altitude_deg: f32) -> i32 {
    BRIGHTEST - LEVELS.iter().take_while(|from_deg| sun_altitude_deg < **from_deg).count() as i32
}

fn rain(mmh: f32) -> Precipitation {
    RAIN.iter().find(|(from, _)| mmh >= *from).map_or(Precipitation::None, |(_, class)| *class)
}

fn fog(weather: &Weather) -> Fog {
    let extinction_per_m = weather.fog_extinction_per_m();
    let sight_m =
        if extinction_per_m > 0.0 { weather.fog_distance_m - ops::ln(LEFT) / extinction_per_m } else { f32::INFINITY };
    FOG.iter().find(|(from_m, _)| sight_m >= *from_m).map_or(Fog::Dense, |(_, class)| *class)
}

/// Eighths of the sky; what is not quite clear is one, and not quite covered seven.
fn oktas(cloudiness_pct: f32) -> i32 {
    match cloudiness_pct {
        none if none <= 0.0 => 0,
        all if all >= 100.0 => 8,
        some => (ops::round(0.01 * some * OKTAS) as i32).clamp(1, 7),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clear_noon_and_a_rainy_night_are_told_apart() {
        let noon = conditions(&Weather::dry(0.0, 10.0, 60.0, 90.0));
        assert_eq!((noon.ambient_illumination, noon.clouds.fractional_cloud_cover), (10, 2));
        assert_eq!((noon.precipitation, noon.fog), (Precipitation::None as i32, Fog::ExcellentVisibility as i32));
        assert!(noon.sun.azimuth.abs() < 1e-9, "the sun is in the north: {}", noon.sun.azimuth);
        assert!((noon.sun.elevation - 60f64.to_radians()).abs() < 1e-9);
        let storm =
            Weather { precipitation_pct: 100.0, fog_density_pct: 100.0, ..Weather::dry(100.0, 0.0, -90.0, 0.0) };
        let night = conditions(&storm);
        assert_eq!((night.ambient_illumination, night.clouds.fractional_cloud_cover), (2, 10));
        assert_eq!((night.precipitation, night.fog), (Precipitation::VeryHeavy as i32, Fog::Dense as i32));
        assert!((night.sun.azimuth - 1.5 * std::f64::consts::PI).abs() < 1e-9, "east");
    }

    #[test]
    fn classes_change_where_the_standard_says() {
        assert_eq!((rain(0.09), rain(0.1)), (Precipitation::None, Precipitation::VeryLight));
        assert_eq!((rain(8.0), rain(8.1)), (Precipitation::Moderate, Precipitation::Heavy));
        assert_eq!([90.0, 8.0, 7.9, 0.0, -0.9, -20.0].map(level), [9, 9, 8, 7, 6, 1]);
        assert_eq!([0.0, 1.0, 50.0, 99.0, 100.0].map(oktas), [0, 1, 4, 7, 8]);
        // 50 m to 2 % of the contrast are 38 m to 5 %.
        let fog_of = |density| fog(&Weather { fog_density_pct: density, ..Weather::dry(0.0, 0.0, 45.0, 0.0) });
        assert_eq!(
            (fog_of(0.0), fog_of(5.0), fog_of(60.0), fog_of(100.0)),
            (Fog::ExcellentVisibility, Fog::Light, Fog::Thick, Fog::Dense)
        );
    }
}
