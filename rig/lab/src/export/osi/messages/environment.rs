//! `osi_environment.proto`.

use prost::{Enumeration, Message};

/// Weather and light.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct EnvironmentalConditions {
    /// Level of ambient light plus 1, [2, 10].
    #[prost(int32, required, tag = "1")]
    pub ambient_illumination: i32,
    #[prost(enumeration = "Precipitation", required, tag = "6")]
    pub precipitation: i32,
    #[prost(enumeration = "Fog", required, tag = "7")]
    pub fog: i32,
    #[prost(message, required, tag = "10")]
    pub clouds: CloudLayer,
    #[prost(message, required, tag = "12")]
    pub sun: Sun,
}

/// How much of the sky is under clouds.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct CloudLayer {
    /// Oktas plus 2, [2, 10].
    #[prost(int32, required, tag = "1")]
    pub fractional_cloud_cover: i32,
}

/// Where the sun is.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Sun {
    /// Counter-clockwise from north (y), radians, [0, 2 pi).
    #[prost(double, required, tag = "1")]
    pub azimuth: f64,
    /// Above the horizon, radians.
    #[prost(double, required, tag = "2")]
    pub elevation: f64,
}

/// Rain by its intensity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Precipitation {
    Unknown = 0,
    None = 2,
    VeryLight = 3,
    Light = 4,
    Moderate = 5,
    Heavy = 6,
    VeryHeavy = 7,
    Extreme = 8,
}

/// Fog by how far one sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Fog {
    Unknown = 0,
    ExcellentVisibility = 2,
    GoodVisibility = 3,
    ModerateVisibility = 4,
    PoorVisibility = 5,
    Mist = 6,
    Light = 7,
    Thick = 8,
    Dense = 9,
}
