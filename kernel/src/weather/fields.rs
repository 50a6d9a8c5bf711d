//! Weather as numbers, in CARLA's ranges.

use crate::state;

state! {
    /// Weather at a moment.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Weather {
        /// Share of the sky under clouds in percent, 0 to 100 (paper: 0 to 30).
        pub cloudiness_pct: f32,
        /// Wind in percent of a storm, 0 to 100 (paper: 0 to 50); moves branches, clouds and rain.
        pub wind_pct: f32,
        /// Height of the sun above the horizon in degrees, -90 to 90 (paper: 20 to 90).
        pub sun_altitude_deg: f32,
        /// Direction to the sun in degrees counter-clockwise from east, 0 to 360.
        pub sun_azimuth_deg: f32,
        /// Rain in percent of a cloudburst (50 mm an hour), 0 to 100 (paper: 0).
        pub precipitation_pct: f32,
        /// Water that stands on the road, 0 (none) to 100 (all of it is under water); CARLA's precipitation deposits.
        pub puddles_pct: f32,
        /// How wet surfaces are, 0 to 100. Where it rains or water stands they are wet though this is 0.
        pub wetness_pct: f32,
        /// Fog in percent of one in which one sees 50 m, 0 to 100.
        pub fog_density_pct: f32,
        /// Where the fog begins, metres from the eye, 0 and above.
        pub fog_distance_m: f32,
    }
}

/// Share of the contrast that is left of what can just be seen (Koschmieder 1924).
const LEAST_CONTRAST_LN: f32 = 3.912;
/// How far one sees in fog of 100 %, metres: dense fog. Fog of 5 % is then the one of 1,000 m that meteorologists
/// begin to call fog.
const DENSEST_FOG_M: f32 = 50.0;

/// Headlights are on while the sun is lower than this, where one sees less far than this, and from so much rain on.
const DUSK_DEG: f32 = 5.0;
const LIT_FOG_M: f32 = 300.0;
const LIT_RAIN_PCT: f32 = 30.0;

impl Weather {
    /// Weather without rain, wetness and fog.
    pub const fn dry(cloudiness_pct: f32, wind_pct: f32, sun_altitude_deg: f32, sun_azimuth_deg: f32) -> Self {
        Self {
            cloudiness_pct,
            wind_pct,
            sun_altitude_deg,
            sun_azimuth_deg,
            precipitation_pct: 0.0,
            puddles_pct: 0.0,
            wetness_pct: 0.0,
            fog_density_pct: 0.0,
            fog_distance_m: 0.0,
        }
    }

    /// Whether one drives with headlights: at dusk, in the dark, and where fog or rain hinder sight much (StVO section 17; the
    /// limits are assumptions).
    pub fn calls_for_headlights(&self) -> bool {
        let hinders = self.visibility_m() < LIT_FOG_M || self.precipitation_pct >= LIT_RAIN_PCT;
        self.sun_altitude_deg < DUSK_DEG || hinders
    }

    /// Extinction of light by the fog, 1/m.
    pub fn fog_extinction_per_m(&self) -> f32 {
        LEAST_CONTRAST_LN / DENSEST_FOG_M * 0.01 * self.fog_density_pct
    }

    /// How far one sees, metres, by Koschmieder's law; infinite without fog.
    pub fn visibility_m(&self) -> f32 {
        if self.fog_density_pct > 0.0 {
            self.fog_distance_m + LEAST_CONTRAST_LN / self.fog_extinction_per_m()
        } else {
            f32::INFINITY
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headlights_are_on_in_the_dark_in_fog_and_in_rain() {
        let day = Weather::dry(50.0, 0.0, 45.0, 0.0);
        let fog = Weather { fog_density_pct: 60.0, ..day };
        let drizzle = Weather { precipitation_pct: 15.0, fog_density_pct: 5.0, ..day };
        assert!(![day, drizzle].iter().any(Weather::calls_for_headlights));
        let rain = Weather { precipitation_pct: 60.0, ..day };
        let dusk = Weather { sun_altitude_deg: 1.0, ..day };
        assert!([fog, rain, dusk].iter().all(Weather::calls_for_headlights));
    }

    #[test]
    fn one_sees_as_far_as_fog_lets_two_percent_of_the_contrast_through() {
        for (density, from_m) in [(5.0, 0.0), (40.0, 0.0), (100.0, 30.0)] {
            let fog = Weather { fog_density_pct: density, fog_distance_m: from_m, ..Weather::dry(0.0, 0.0, 45.0, 0.0) };
            let left = crate::ops::exp(-fog.fog_extinction_per_m() * (fog.visibility_m() - from_m));
            assert!((left - 0.02).abs() < 1e-4, "{left}");
        }
        let thin = Weather { fog_density_pct: 5.0, ..Weather::dry(0.0, 0.0, 45.0, 0.0) };
        assert!((thin.visibility_m() - 1000.0).abs() < 0.1);
        assert_eq!(Weather::dry(100.0, 0.0, 45.0, 0.0).visibility_m(), f32::INFINITY);
    }
}
