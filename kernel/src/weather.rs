//! Weather of a run.

use crate::state;

state! {
    /// Weather of a run. Rain, wetness, puddles and fog are 0, as in the paper.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Weather {
        /// Share of the sky under clouds in percent, 0 to 100 (paper: 0 to 30).
        pub cloudiness_pct: f32,
        /// Wind in percent of a storm, 0 to 100 (paper: 0 to 50); moves branches and clouds.
        pub wind_pct: f32,
        /// Height of the sun above the horizon in degrees, -90 to 90 (paper: 20 to 90).
        pub sun_altitude_deg: f32,
        /// Direction to the sun in degrees counter-clockwise from east, 0 to 360.
        pub sun_azimuth_deg: f32,
    }
}
