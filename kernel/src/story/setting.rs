//! What a story says of the world around those who play: lights and weather.

use crate::map_data::LightGroupId;
use crate::signals::LightPhase;
use crate::time::Tick;
use crate::weather::Weather;

/// A traffic light at a phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// OpenDRIVE id of its signal.
    pub signal: String,
    /// What it shows.
    pub phase: LightPhase,
    /// Where the text says so, bytes from its beginning.
    pub at: usize,
    /// The lights of that signal, once they are found on a map.
    pub groups: Vec<LightGroupId>,
}

/// A programme of lights, which begins again at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Programme {
    /// Its name.
    pub name: String,
    /// It begins so long after the run, and with its last phase before that.
    pub delay_ticks: Tick,
    /// Its phases: names, how long they last, and what lights show in them.
    pub phases: Vec<(String, Tick, Vec<Light>)>,
}

/// What a text says of the weather.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Environment {
    /// Share of the sky under clouds, percent.
    pub cloudiness_pct: Option<f32>,
    /// Wind, percent of a storm.
    pub wind_pct: Option<f32>,
    /// Height of the sun and direction to it, counter-clockwise from east, degrees.
    pub sun_deg: Option<[f32; 2]>,
    /// Rain, percent of a cloudburst.
    pub precipitation_pct: Option<f32>,
    /// How wet surfaces are, and water that stands on them, percent.
    pub water_pct: Option<[f32; 2]>,
    /// How dense the fog is, percent.
    pub fog_density_pct: Option<f32>,
}

impl Environment {
    /// Of another text in its place what that says of a weather, where this text's own words count in it: others may have changed it
    /// since.
    pub fn replaced(&self, by: &Self, weather: &Weather) -> Self {
        let one = |told: Option<f32>, is: f32| told.is_none_or(|told| told == is);
        let two = |told: Option<[f32; 2]>, is: [f32; 2]| told.is_none_or(|told| told == is);
        let sun = [weather.sun_altitude_deg, weather.sun_azimuth_deg];
        let water = [weather.wetness_pct, weather.puddles_pct];
        Self {
            cloudiness_pct: by.cloudiness_pct.filter(|_| one(self.cloudiness_pct, weather.cloudiness_pct)),
            wind_pct: by.wind_pct.filter(|_| one(self.wind_pct, weather.wind_pct)),
            sun_deg: by.sun_deg.filter(|_| two(self.sun_deg, sun)),
            precipitation_pct: by.precipitation_pct.filter(|_| one(self.precipitation_pct, weather.precipitation_pct)),
            water_pct: by.water_pct.filter(|_| two(self.water_pct, water)),
            fog_density_pct: by.fog_density_pct.filter(|_| one(self.fog_density_pct, weather.fog_density_pct)),
        }
    }

    /// Changes what the text says of a weather.
    pub fn change(&self, weather: &mut Weather) {
        let set = |to: &mut f32, value: Option<f32>| *to = value.unwrap_or(*to);
        set(&mut weather.cloudiness_pct, self.cloudiness_pct);
        set(&mut weather.wind_pct, self.wind_pct);
        set(&mut weather.sun_altitude_deg, self.sun_deg.map(|[altitude, _]| altitude));
        set(&mut weather.sun_azimuth_deg, self.sun_deg.map(|[_, azimuth]| azimuth));
        set(&mut weather.precipitation_pct, self.precipitation_pct);
        set(&mut weather.wetness_pct, self.water_pct.map(|[wet, _]| wet));
        set(&mut weather.puddles_pct, self.water_pct.map(|[_, puddles]| puddles));
        set(&mut weather.fog_density_pct, self.fog_density_pct);
        if self.fog_density_pct.is_some() {
            weather.fog_distance_m = 0.0;
        }
    }
}
