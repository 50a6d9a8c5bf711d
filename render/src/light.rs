//! Sun and sky from the weather, and the matrix that the shadow map is drawn with.

use glam::{Mat4, Vec3};
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
        // Broken clouds let the sun through, a closed cover does not: its light comes from all of the sky then.
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

/// The square of the world that a shadow map covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShadowBox {
    pub(crate) centre: Vec3,
    pub(crate) sun: Vec3,
    pub(crate) reach_m: f32,
}

/// Depth of the shadow map before and behind its centre, metres.
const SHADOW_DEPTH_M: f32 = 400.0;

/// A shadow map shows what is so far above or below its centre at least, as a share of its reach: walls and slopes.
const HIGH: f32 = 0.5;

/// Shadows of what moves are not looked for any farther from it, metres.
const LONGEST_SHADOW_M: f32 = 60.0;

impl ShadowBox {
    /// A box on the ground ahead of a camera, on a grid so that it seldom changes. The ego car stands on the ground, and cameras are
    /// mostly near it.
    pub(crate) fn ahead_of(eye: Vec3, ahead: Vec3, ego: Vec3, sun: Vec3, reach_m: f32) -> Self {
        let is_near = eye.truncate().distance(ego.truncate()) < reach_m;
        let eye = eye.truncate().extend(if is_near { ego.z } else { eye.z });
        let step = 0.25 * reach_m;
        let flat = Vec3::new(ahead.x, ahead.y, 0.0).normalize_or_zero();
        let wanted = (eye + flat * (0.7 * reach_m)) / step;
        let centre = Vec3::new(ops::round(wanted.x), ops::round(wanted.y), ops::round(wanted.z)) * step;
        Self { centre, sun, reach_m }
    }

    /// Whether anything in a sphere may cast a shadow on the map.
    pub(crate) fn reaches(&self, centre: Vec3, radius_m: f32) -> bool {
        let (rel, [right, up]) = (centre - self.centre, self.axes());
        rel.dot(right).abs() < self.reach_m + radius_m && rel.dot(up).abs() < self.rise_m() + radius_m
    }

    /// Axes of the map, to the right and up as the sun sees it; to the right is level, so that shadows of what is upright lie
    /// along columns of texels.
    fn axes(&self) -> [Vec3; 2] {
        let side = if self.sun.z.abs() > 0.95 { Vec3::X } else { Vec3::Z };
        let right = side.cross(self.sun).normalize();
        [right, self.sun.cross(right)]
    }

    /// How far the map reaches up and down as the sun sees it, metres. A low sun sees the ground foreshortened: the less of the
    /// map it takes, the finer are the texels, whose traces on the ground it stretches.
    fn rise_m(&self) -> f32 {
        let sine = self.sun.z.clamp(0.0, 1.0);
        let cosine = ops::sqrt(1.0 - sine * sine);
        (self.reach_m * (sine + HIGH * cosine)).min(self.reach_m)
    }

    /// A sphere around what stands on the ground in another one, and its shadow.
    pub(crate) fn around_shadow(&self, centre: Vec3, radius_m: f32) -> (Vec3, f32) {
        let length_m = if self.sun.z > 0.0 { (2.0 * radius_m / self.sun.z).min(LONGEST_SHADOW_M) } else { 0.0 };
        (centre - self.sun * (0.5 * length_m), radius_m + 0.5 * length_m)
    }

    /// From the world to uv (v down) and depth (0 nearest to the sun) of the map.
    pub(crate) fn matrix(&self) -> Mat4 {
        let [right, up] = self.axes();
        let (u, v, w) = (right / (2.0 * self.reach_m), -up / (2.0 * self.rise_m()), -self.sun / (2.0 * SHADOW_DEPTH_M));
        let rows = Mat4::from_cols(u.extend(0.0), v.extend(0.0), w.extend(0.0), Vec3::ZERO.extend(1.0)).transpose();
        Mat4::from_translation(Vec3::splat(0.5)) * rows * Mat4::from_translation(-self.centre)
    }
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
    fn a_closed_cover_of_clouds_casts_no_shadows_and_is_not_dark() {
        let light = |clouds: f32| Light::new(&Weather::dry(clouds, 0.0, 60.0, 0.0));
        let (clear, closed) = (light(0.0), light(100.0));
        assert!(closed.sun_light.length() < 0.03 * clear.sun_light.length());
        let on_the_ground = |light: &Light| (light.sun_light * light.sun.z + light.sky_light).element_sum();
        let share = on_the_ground(&closed) / on_the_ground(&clear);
        assert!((0.5..0.9).contains(&share), "{share}");
        let lights: Vec<f32> = (0..=10).map(|i| on_the_ground(&light(10.0 * i as f32))).collect();
        assert!(lights.is_sorted_by(|a, b| a >= b), "{lights:?}");
    }

    #[test]
    fn a_shadow_lies_in_the_sphere_around_it() {
        for altitude_deg in [10.0, 30.0, 75.0] {
            let sun = Light::new(&Weather::dry(0.0, 0.0, altitude_deg, 40.0)).sun;
            let shadow = ShadowBox { centre: Vec3::ZERO, sun, reach_m: 64.0 };
            let top = Vec3::new(5.0, 2.0, 1.8);
            let (centre, radius_m) = shadow.around_shadow(top * Vec3::new(1.0, 1.0, 0.5), 1.0);
            let tip = top - sun * (top.z / sun.z);
            assert!(centre.distance(tip) < radius_m && centre.distance(top) < radius_m, "{altitude_deg}");
        }
    }

    #[test]
    fn the_ground_below_a_high_camera_has_shadows_too() {
        let sun = Light::new(&Weather::dry(0.0, 0.0, 10.0, 40.0)).sun;
        let ego = Vec3::new(300.0, 40.0, 12.0);
        for eye_m in [1.5, 20.0, 50.0, 300.0] {
            let shadow = ShadowBox::ahead_of(ego + Vec3::Z * eye_m, Vec3::X, ego, sun, 64.0);
            assert!(shadow.reaches(ego + Vec3::X * 40.0, 0.0) && shadow.reaches(ego, 0.0), "{eye_m} m");
        }
    }

    #[test]
    fn a_low_sun_has_finer_texels_and_loses_neither_ground_nor_walls() {
        let shadow = |altitude_deg: f32| {
            let sun = Light::new(&Weather::dry(0.0, 0.0, altitude_deg, 40.0)).sun;
            ShadowBox { centre: Vec3::new(7.0, -3.0, 2.0), sun, reach_m: 64.0 }
        };
        for altitude_deg in [6.0, 15.0, 30.0, 60.0, 85.0] {
            let shadow = shadow(altitude_deg);
            for aside in [Vec3::new(0.766, 0.643, 0.0), Vec3::new(0.643, -0.766, 0.0)] {
                for (along_m, high_m) in [(-60.0, 0.0), (60.0, 0.0), (20.0, 30.0), (20.0, -20.0)] {
                    let at = shadow.centre + aside * along_m + Vec3::Z * high_m;
                    let place = shadow.matrix().project_point3(at) - 0.5;
                    assert!(place.truncate().abs().max_element() < 0.495, "{altitude_deg}, {at}: {place}");
                    assert!(shadow.reaches(at + shadow.sun * 100.0, 0.0));
                }
            }
        }
        let per_m = |shadow: ShadowBox| shadow.matrix().transform_vector3(Vec3::Z).y.abs();
        assert!(per_m(shadow(8.0)) > 1.5 / 128.0, "of height");
    }

    #[test]
    fn the_shadow_map_has_its_centre_in_the_middle_and_the_sun_side_first() {
        for sun in [Vec3::new(0.0, 0.6, 0.8), Vec3::Z] {
            let shadow = ShadowBox { centre: Vec3::new(10.0, 20.0, 0.0), sun, reach_m: 50.0 };
            let at = |p: Vec3| shadow.matrix().project_point3(p);
            assert!((at(shadow.centre) - 0.5).length() < 1e-6);
            assert!(at(shadow.centre + sun * 10.0).z < 0.5);
            assert!((at(shadow.centre + sun * 10.0) - at(shadow.centre)).truncate().length() < 1e-6);
        }
    }
}
