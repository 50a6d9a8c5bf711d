//! Dusk and night: how much light is left, and how bright lamps are beside it.

use glam::Vec3;
use kernel::ops;
use kernel::scene::Weather;

use crate::light::{DUSK_DEG, Lamps, Light, smooth};

/// Altitude of the sun, degrees, and illuminance of the ground under a clear sky, decimal logarithm of lux (Bond and
/// Henderson 1963).
const SKY_LX: [(f32, f32); 5] = [(-18.0, -3.2), (-12.0, -2.08), (-6.0, 0.53), (-0.8, 2.66), (DUSK_DEG, 3.68)];
/// What moon and glow of the city add to it.
const MOON_LX: f32 = 0.5;
/// Right below a street lamp (EN 13201: a mean of 7.5 to 20 lx on streets of classes C4 to C2).
const STREET_LX: f32 = 13.0;
/// What a camera adapts to at least: a street at night.
const DARKEST_LX: f32 = 3.4;
/// Exposure follows light to this power: the dark stays darker than the day.
const ADAPTATION: f32 = 0.8;

/// Colours of light.
const SODIUM: Vec3 = Vec3::new(1.12, 0.94, 0.7);
const XENON: Vec3 = Vec3::new(0.98, 1.0, 1.02);
const MOON: Vec3 = Vec3::new(0.78, 0.9, 1.18);
const CITY: Vec3 = Vec3::new(1.1, 0.9, 0.72);

impl Light {
    /// That of a weather.
    pub(crate) fn new(weather: &Weather) -> Self {
        let day = Self::by_day(weather);
        if weather.sun_altitude_deg < DUSK_DEG { fallen(day, weather) } else { day }
    }
}

/// Illuminance of the ground under a clear sky without moon, lux.
fn sky_lx(altitude_deg: f32) -> f32 {
    let above = SKY_LX.iter().position(|(deg, _)| altitude_deg <= *deg).unwrap_or(SKY_LX.len() - 1).max(1);
    let ((x0, y0), (x1, y1)) = (SKY_LX[above - 1], SKY_LX[above]);
    let log = y0 + (y1 - y0) * ((altitude_deg - x0) / (x1 - x0)).clamp(0.0, 1.0);
    ops::pow(10.0, log)
}

/// What dusk and night leave of the light of a low sun, to a camera that has adapted.
pub(crate) fn fallen(day: Light, weather: &Weather) -> Light {
    let altitude_deg = weather.sun_altitude_deg;
    let (lx, most_lx) = (sky_lx(altitude_deg), sky_lx(DUSK_DEG));
    let gain = ops::pow((most_lx + DARKEST_LX) / (lx + DARKEST_LX), ADAPTATION);
    // Shades of the last light, and of what stays when it is gone.
    let blue = Vec3::ONE.lerp(Vec3::new(0.74, 0.9, 1.2), smooth(-4.0, 3.0, -altitude_deg));
    let left = gain * lx / most_lx;
    let base = 0.56 * gain / most_lx;
    let moon = base * MOON_LX;
    let cover = smooth(0.35, 1.0, 0.01 * weather.cloudiness_pct);
    let glow = (1.0 - 0.9 * cover) * (1.0 - 0.008 * weather.fog_density_pct) * smooth(-4.0, 1.0, -altitude_deg);
    let horizon = day.horizon * (left * (1.0 - 0.35 * glow)) * blue;
    let fog = day.fog * left + (MOON + CITY) * (0.7 * moon);
    Light {
        sun_light: day.sun_light * gain,
        sky_light: day.sky_light * left * blue + MOON * moon,
        ground_light: day.ground_light * left * blue + MOON * (0.6 * moon),
        horizon: horizon + (CITY + MOON) * (0.22 * moon),
        zenith: day.zenith * (0.8 * left) * blue + MOON * MOON * MOON * (0.2 * moon),
        fog,
        lamps: Some(Lamps {
            street: SODIUM * (base * STREET_LX),
            head: XENON * (base * STREET_LX),
            window: 1.5 * base * STREET_LX,
            windows_lit: 0.45 - 0.2 * smooth(8.0, 25.0, -altitude_deg),
            shine: smooth(-3.0, 6.0, -altitude_deg),
            afterglow: Vec3::new(1.0, 0.46, 0.16) * (1.1 * left * glow),
        }),
        ..day
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(altitude_deg: f32) -> Light {
        Light::new(&Weather::dry(10.0, 0.0, altitude_deg, 0.0))
    }

    #[test]
    fn the_sky_gets_darker_without_a_step() {
        let brightness = |deg: f32| light(deg).sky_light.element_sum();
        let steps: Vec<f32> = (0..=1400).map(|i| brightness(8.0 - 0.02 * i as f32)).collect();
        assert!(steps.is_sorted_by(|a, b| a >= b), "{steps:?}");
        assert!(steps.windows(2).all(|pair| pair[0] < 1.03 * pair[1]));
        assert!((0.01..0.06).contains(&(steps[1400] / steps[0])), "{}", steps[1400] / steps[0]);
    }

    #[test]
    fn lamps_come_out_as_the_light_goes() {
        assert_eq!(light(DUSK_DEG).lamps, None);
        let lamps = |deg: f32| light(deg).lamps.expect("lamps");
        let street: Vec<f32> = [4.99, 0.0, -4.0, -8.0, -30.0].map(|deg| lamps(deg).street.element_sum()).to_vec();
        assert!(street.is_sorted() && street[0] < 0.01, "{street:?}");
        assert!(lamps(4.99).window < 0.01 && lamps(4.99).shine < 1e-3 && lamps(-12.0).shine == 1.0);
        let night = light(-30.0);
        let share = night.sky_light.element_sum() / lamps(-30.0).street.element_sum();
        assert!((0.01..0.1).contains(&share), "{share} of the light under a lamp");
    }

    #[test]
    fn the_light_of_twilight_is_that_of_the_table() {
        for (deg, log) in SKY_LX {
            assert!((sky_lx(deg).log10() - log).abs() < 1e-4);
        }
        assert_eq!(sky_lx(-90.0), sky_lx(-18.0));
    }
}
