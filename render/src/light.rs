//! Sun and sky from the weather.

use glam::Vec3;
use kernel::ops;
use kernel::scene::Weather;

/// Lamps are drawn while the sun is lower than this, degrees; above it pictures are as if there were none.
pub(crate) const DUSK_DEG: f32 = 5.0;

/// Light that people make, as [`Light`] has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lamps {
    /// On the ground under a street lamp.
    pub(crate) street: Vec3,
    /// Of headlights where it is as bright as that.
    pub(crate) head: Vec3,
    /// Of a lit window.
    pub(crate) window: f32,
    /// Share of the windows that are lit.
    pub(crate) windows_lit: f32,
    /// How much of their brightness lamps show that is drawn as shining, 0 to 1.
    pub(crate) shine: f32,
    /// Of the sky where the sun went down.
    pub(crate) afterglow: Vec3,
}

/// Light of a scene, linear, as a camera shows it that has adapted to how much of it there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Light {
    /// Towards the sun.
    pub(crate) sun: Vec3,
    pub(crate) sun_light: Vec3,
    pub(crate) sky_light: Vec3,
    pub(crate) ground_light: Vec3,
    pub(crate) horizon: Vec3,
    pub(crate) zenith: Vec3,
    /// Of fog that hides all behind it.
    pub(crate) fog: Vec3,
    pub(crate) exposure: f32,
    /// Light that people make; none by day, when nobody sees it.
    pub(crate) lamps: Option<Lamps>,
}

/// Sine of [`DUSK_DEG`].
pub(crate) fn dusk_height() -> f32 {
    ops::sin(DUSK_DEG.to_radians())
}

impl Light {
    /// As it is by day, and where the sun is low as if its sky were still that of [`DUSK_DEG`].
    pub(crate) fn by_day(weather: &Weather) -> Self {
        let (altitude, azimuth) = (weather.sun_altitude_deg.to_radians(), weather.sun_azimuth_deg.to_radians());
        let flat = ops::cos(altitude);
        let sun = Vec3::new(flat * ops::cos(azimuth), flat * ops::sin(azimuth), ops::sin(altitude));
        let lit_up = if weather.sun_altitude_deg < DUSK_DEG { dusk_height() } else { sun.z };
        let day = smooth(-0.12, 0.25, lit_up);
        let warm = 1.0 - smooth(0.05, 0.55, lit_up);
        let clouds = 0.01 * weather.cloudiness_pct;
        let white = Vec3::new(1.0, 0.95, 0.87).lerp(Vec3::new(1.0, 0.68, 0.4), warm);
        let grey = Vec3::new(0.62, 0.66, 0.72);
        let (rain, mist) = (0.01 * weather.precipitation_pct, 0.01 * weather.fog_density_pct);
        // Broken clouds let the sun through, a closed cover hardly does: its light comes from all of the sky then.
        let cover = smooth(0.35, 1.0, clouds);
        // What comes through rain clouds and fog; all of it without them.
        let (beam, dim) = ((1.0 - 0.9 * rain) * (1.0 - 0.8 * mist), 1.0 - 0.3 * rain);
        let zenith = Vec3::new(0.14, 0.32, 0.72).lerp(grey, 0.35 * clouds) * day + Vec3::new(0.006, 0.008, 0.018);
        let haze = Vec3::new(0.62, 0.78, 0.98).lerp(Vec3::new(0.95, 0.72, 0.5), 0.6 * warm);
        let horizon = haze.lerp(grey, 0.3 * clouds) * (0.95 * day) + Vec3::splat(0.015);
        Self {
            sun,
            sun_light: white * (2.5 * smooth(-0.02, 0.2, sun.z) * (1.0 - 0.2 * clouds) * (1.0 - 0.97 * cover) * beam),
            sky_light: Vec3::new(0.5, 0.6, 0.78).lerp(grey, 0.5 * clouds)
                * (day * (0.95 + 0.3 * clouds + 0.75 * cover) * dim)
                + Vec3::splat(0.02),
            ground_light: Vec3::new(0.36, 0.34, 0.31) * day + Vec3::splat(0.015),
            horizon: horizon.lerp(grey * (0.7 * day), 0.8 * rain),
            zenith: zenith.lerp(grey * (0.6 * day), 0.8 * rain),
            fog: horizon.lerp(grey * day, 0.6) * (0.9 * dim) + Vec3::splat(0.01),
            exposure: 0.62,
            lamps: None,
        }
    }
}

/// 0 up to `low`, 1 from `high` on, smooth between.
pub(crate) fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_stands_where_the_weather_says() {
        let weather = Weather::dry(0.0, 0.0, 30.0, 90.0);
        let light = Light::new(&weather);
        assert!((light.sun - Vec3::new(0.0, 0.866, 0.5)).length() < 1e-3);
        let night = Light::new(&Weather { sun_altitude_deg: -30.0, ..weather });
        assert!(night.sun_light == Vec3::ZERO && night.sky_light.length() < 0.1);
    }

    #[test]
    fn a_closed_cover_of_clouds_leaves_hardly_any_sun_and_is_not_dark() {
        let light = |clouds: f32| Light::new(&Weather::dry(clouds, 0.0, 60.0, 0.0));
        let (clear, closed) = (light(0.0), light(100.0));
        // As docs/pictures.md has it.
        let left = |light: Light| light.sun_light.length() / clear.sun_light.length();
        assert!((left(closed) - 0.024).abs() < 5e-4 && (left(light(90.0)) - 0.075).abs() < 1e-3);
        let on_the_ground = |light: &Light| (light.sun_light * light.sun.z + light.sky_light).element_sum();
        let share = on_the_ground(&closed) / on_the_ground(&clear);
        assert!((0.5..0.9).contains(&share), "{share}");
        let lights: Vec<f32> = (0..=10).map(|i| on_the_ground(&light(10.0 * i as f32))).collect();
        assert!(lights.is_sorted_by(|a, b| a >= b), "{lights:?}");
    }
}
