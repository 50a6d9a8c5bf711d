//! Weather that becomes other weather.

use super::fields::Weather;
use crate::state;
use crate::time::{TICK_HZ, Tick};

state! {
    /// What the weather becomes in the course of a run.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct WeatherChange {
        /// The weather at the end of the change, which stays.
        pub to: Weather,
        /// How long it takes from the start of the run, seconds, more than 0.
        pub over_s: f32,
    }
}

impl WeatherChange {
    /// The weather at a tick of a run that began with `from`: every value changes steadily, the sun's azimuth the
    /// short way round.
    pub fn at(&self, from: &Weather, tick: Tick) -> Weather {
        let share = tick as f32 / (self.over_s * TICK_HZ as f32);
        if share >= 1.0 { self.to } else { between(from, &self.to, share) }
    }
}

fn between(a: &Weather, b: &Weather, share: f32) -> Weather {
    let mix = |a: f32, b: f32| (a + (b - a) * share).clamp(a.min(b), a.max(b));
    Weather {
        cloudiness_pct: mix(a.cloudiness_pct, b.cloudiness_pct),
        wind_pct: mix(a.wind_pct, b.wind_pct),
        sun_altitude_deg: mix(a.sun_altitude_deg, b.sun_altitude_deg),
        sun_azimuth_deg: turned_deg(a.sun_azimuth_deg, b.sun_azimuth_deg, share),
        precipitation_pct: mix(a.precipitation_pct, b.precipitation_pct),
        puddles_pct: mix(a.puddles_pct, b.puddles_pct),
        wetness_pct: mix(a.wetness_pct, b.wetness_pct),
        fog_density_pct: mix(a.fog_density_pct, b.fog_density_pct),
        fog_distance_m: mix(a.fog_distance_m, b.fog_distance_m),
    }
}

/// A direction on the short way from one to another, 0 to 360 degrees.
fn turned_deg(from: f32, to: f32, share: f32) -> f32 {
    let way = (to - from + 180.0).rem_euclid(360.0) - 180.0;
    let turned = from + way * share;
    if (0.0..=360.0).contains(&turned) { turned } else { turned.rem_euclid(360.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::seconds;

    #[test]
    fn weather_changes_steadily_and_then_stays() {
        let from = Weather::dry(10.0, 20.0, 40.0, 350.0);
        let to = Weather { precipitation_pct: 80.0, fog_density_pct: 10.0, ..Weather::dry(90.0, 20.0, 10.0, 20.0) };
        let change = WeatherChange { to, over_s: 100.0 };
        assert_eq!(change.at(&from, 0), from);
        let half = change.at(&from, seconds(50));
        let expected = Weather { precipitation_pct: 40.0, fog_density_pct: 5.0, ..Weather::dry(50.0, 20.0, 25.0, 5.0) };
        assert_eq!(half, expected);
        assert_eq!(change.at(&from, seconds(100)), to);
        assert_eq!(change.at(&from, seconds(10_000)), to);
    }

    #[test]
    fn the_sun_takes_the_short_way_and_stays_in_its_range() {
        for (from, to, quarter) in [(10.0, 50.0, 20.0), (350.0, 30.0, 0.0), (20.0, 300.0, 0.0), (20.0, 280.0, 355.0)] {
            let turned = turned_deg(from, to, 0.25);
            assert!((turned - quarter).abs() < 1e-3 || (turned - quarter - 360.0).abs() < 1e-3, "{from} {to} {turned}");
        }
        for k in 0..3600 {
            let turned = turned_deg(360.0 - (k % 7) as f32 * 51.0, k as f32 * 0.1, 0.37);
            assert!((0.0..=360.0).contains(&turned), "{turned}");
        }
    }
}
